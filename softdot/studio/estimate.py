"""Force, charge and voltage of a design from those of a similar one that was pressed, to first order in logarithms.

Each is that of the press times (x / x0)^p over all numbers x that differ, where p = d ln F / d ln x at the press: a
line in logarithms, which holds over larger shifts than one in the numbers.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from math import exp, expm1, log
from typing import Any

from foundation.errors import InputError
from softdot.config.toml import leaves, parse_toml

QUANTITIES = ("force_N", "charge_pC", "voltage_V")
WITHOUT_EFFECT = frozenset({"readout", "fabrication", "mesh", "seed"})
"""Tables that change no press, or only how finely it is solved."""
OF_EXPONENT, OF_CURVATURE = 0.1, 0.5
"""The error that is told before a press has shown a larger one: exponents are a tenth off, as other meshes give others,
and change by one over a factor of e, so that half the square of the shift is missing."""
FARTHEST = log(2.0)
"""The sum of all shifts (in logarithms) beyond which nothing is estimated."""
MOST_BASES = 6
Values = tuple[float, float, float]


@dataclass
class PressedBeside:
    """A press from which others are estimated: stated and all values by dotted key, its answer, by which shares its
    mesh may be off, and its exponents.
    """

    stated: dict[str, Any]
    whole: dict[str, Any]
    answer: Values
    mesh_errors: Values
    exponents: dict[str, Values] = field(default_factory=dict)


class Estimator:
    """Presses of a tab, by their press_hash, with what they say of designs beside them. version : of what is known."""

    def __init__(self) -> None:
        self._bases: dict[str, PressedBeside] = {}
        self.version = 0
        self._scale = 1.0

    def knows(self, press_hash: str) -> bool:
        """Whether designs beside this one can be estimated."""
        found = self._bases.get(press_hash)
        return found is not None and bool(found.exponents)

    def learn(self, press_hash: str, text: str, values: Mapping[str, Any], answer: Values, mesh_errors: Values) -> None:
        """An accurate press has answered. What an estimate of it would have missed counts from now on."""
        self.version += 1
        expected = self.estimate(text)
        if expected is not None and press_hash not in self._bases:
            ratios = (
                abs(value - expected[name]["value"]) / expected[name]["error"]
                for name, value in zip(QUANTITIES, answer, strict=True)
                if expected[name]["error"] > 0
            )
            self._scale = max(self._scale, *ratios, 1.0)
        before = self._bases.pop(press_hash, None)
        made = PressedBeside(dotted(parse_toml(text, "design")), dotted(values), answer, mesh_errors)
        made.exponents = before.exponents if before else {}
        self._bases[press_hash] = made
        while len(self._bases) > MOST_BASES:
            del self._bases[next(iter(self._bases))]

    def add_exponents(self, press_hash: str, exponents: Mapping[str, Values]) -> None:
        """Some or all exponents of a press are known."""
        if press_hash in self._bases:
            self._bases[press_hash].exponents |= exponents
            self.version += 1

    def estimate(self, text: str) -> dict[str, Any] | None:
        """{quantity: {"value", "error"}} of a design from the nearest press; None where none is near enough, or where
        more differs than numbers with known exponents.
        """
        stated = _stated(text)
        near = stated and self._nearest(stated)
        return self._from(*near) if near and near[1] else None

    def along(self, text: str, key: str, values: Sequence[float]) -> list[dict[str, Any]]:
        """Estimates of a design at other values of one number, {"value": number, quantity: {"value", "error"}}, all
        from the press that is nearest to the design itself; none beyond its reach, or where nothing is known.
        """
        stated = _stated(text)
        near = stated and self._nearest(stated)
        if not stated or not near:
            return []
        found = []
        for value in values:
            shifts = _shifts(near[0], {**stated, key: value})
            estimate = None if shifts is None else self._from(near[0], shifts)
            if estimate is not None:
                found.append({"value": value, **{name: estimate[name] for name in QUANTITIES}})
        return found

    def law(self, text: str) -> dict[str, Any] | None:
        """By which powers the answer of a design grows: its "answer" by quantity, "exponents" (of force, charge and
        voltage) by dotted key, and "reach", the sum of shifts up to which they count; None where nothing is known.
        """
        stated = _stated(text)
        near = stated and self._nearest(stated)
        found = self._from(*near) if near else None
        if not near or found is None:
            return None
        basis, shifts = near
        return {
            "answer": {name: found[name]["value"] for name in QUANTITIES},
            "exponents": dict(basis.exponents),
            "reach": FARTHEST - sum(map(abs, shifts.values())),
        }

    def _nearest(self, stated: Mapping[str, Any]) -> tuple[PressedBeside, dict[str, float]] | None:
        """The press from which least differs, and the shifts from it; None where all differ in more than numbers."""
        near = [(basis, shifts) for basis in self._bases.values() if (shifts := _shifts(basis, stated)) is not None]
        return min(near, key=lambda one: sum(map(abs, one[1].values())), default=None)

    def _from(self, basis: PressedBeside, shifts: Mapping[str, float]) -> dict[str, Any] | None:
        """The estimate from one press; None beyond its reach."""
        distance = sum(map(abs, shifts.values()))
        if distance > FARTHEST:
            return None
        found: dict[str, Any] = {"moved": sorted(shifts)}
        for number, (name, value) in enumerate(zip(QUANTITIES, basis.answer, strict=True)):
            changes = [basis.exponents[key][number] * shift for key, shift in shifts.items()]
            of_order = OF_EXPONENT * sum(map(abs, changes)) + OF_CURVATURE * distance**2
            error = self._scale * (of_order + basis.mesh_errors[number])  # the other design has another mesh
            moved = value * exp(sum(changes))
            found[name] = {"value": moved, "error": abs(moved) * expm1(error)}
        return found


@lru_cache(maxsize=64)
def _stated(text: str) -> Mapping[str, Any] | None:
    """Dotted keys of a text; None where it is no TOML."""
    try:
        return dotted(parse_toml(text, "design"))
    except InputError:
        return None


def same_but_for(key: str, one: str, other: str) -> bool:
    """Whether two texts state the same design but for the value of one dotted key."""
    if one == other:
        return True
    before, after = _stated(one), _stated(other)
    if before is None or after is None:
        return False
    return {**before, key: None} == {**after, key: None}


def _shifts(basis: PressedBeside, stated: Mapping[str, Any]) -> dict[str, float] | None:
    """Dotted key -> ln(x / x0) of all numbers that differ; None where more differs, or an exponent is missing."""
    shifts: dict[str, float] = {}
    for key in basis.stated.keys() | stated.keys():
        if key.split(".", 1)[0] in WITHOUT_EFFECT or basis.stated.get(key) == stated.get(key):
            continue
        before, after = _size(basis.whole.get(key)), _size(stated.get(key))
        if key not in basis.exponents or before is None or after is None:
            return None
        if before != after:
            shifts[key] = log(after / before)
    return shifts


def _size(value: Any) -> float | None:
    """A number above zero; None for anything else."""
    return value if type(value) in (int, float) and value > 0.0 else None


def dotted(tables: Mapping[str, Any]) -> dict[str, Any]:
    """Dotted key -> value of every leaf, lists with their indices in brackets."""
    found = {}
    for way, value in leaves(tables):
        for inner, one in _entries(".".join(way), value):
            found[inner] = one
    return found


def _entries(key: str, value: Any) -> list[tuple[str, Any]]:
    if isinstance(value, list | tuple):
        return [pair for i, one in enumerate(value) for pair in _entries(f"{key}[{i}]", one)]
    if isinstance(value, dict):
        return [pair for name, one in value.items() for pair in _entries(f"{key}.{name}", one)]
    return [(key, value)]

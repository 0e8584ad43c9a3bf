"""A tolerance budget by draws: what force and voltage become where all quantities are off at once.

Each quantity is drawn evenly between its limits (JCGM 101:2008, 6.4.2), all independently. Presses with derivatives at
a few places of the box, on the coarser mesh of the budget, show how effects bend and join; a gradient-enhanced Gaussian
process in logarithms holds them, corrected to value and slopes of the finer mesh at the nominal design. What is known
at both ends alone enters by the parabola through these.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.stats import qmc

from foundation.arrays import Floats
from foundation.errors import InputError
from softdot.config.schema import Config
from softdot.differentiation import with_changes
from softdot.families.gradient_process import GradientProcess
from softdot.tolerances.factors import with_factors
from softdot.tolerances.questions import PressAnswer, Question, Response, path_matters
from softdot.tolerances.tolerances import Tolerance

DRAWS, SEED = 10_000, 0
PLACES = 6
"""Presses in the box besides the nominal one."""
LARGEST_CHANGE = 0.9
"""Relative change beyond which a quantity has no useful logarithm."""
SHARES = (0.05, 0.5, 0.95)
"""Shares of the draws that lie below what is told."""


@dataclass(frozen=True)
class ToleranceBox:
    """Quantities that are off: rows with slopes, each from -1 to 1 times its plus or minus. places (n, r), 0 first.

    relative (r,) : relative change of the key that a row changes most, at its upper end.
    """

    rows: tuple[Tolerance, ...]
    places: Floats
    relative: Floats

    @classmethod
    def of(cls, rows: Sequence[Tolerance], value: Callable[[str], float]) -> "ToleranceBox":
        """The box of the rows that count, with its places of the presses: a Latin hypercube. value : of a key."""
        counted = tuple(row for row in rows if row.counted)
        random = np.random.default_rng(SEED)
        spread = qmc.LatinHypercube(len(counted), seed=random, optimization="random-cd").random(PLACES)
        shares = [[change / value(key) for key, change in row.changes(1.0).items()] for row in counted]
        relative = np.array([max(one, key=abs) for one in shares])
        return cls(counted, np.vstack([np.zeros(len(counted)), 2.0 * spread - 1.0]), relative)

    def logarithmic(self, places: Floats) -> Floats:
        """Places (q, r) on axes in the logarithm of what a row changes: there powers are straight lines."""
        return np.asarray(np.log1p(self.relative * places) / self.relative)

    def changes(self, place: Floats) -> dict[str, float]:
        """Change of each key at a place (r,)."""
        found: dict[str, float] = {}
        for at, row in zip(place, self.rows, strict=True):
            for key, change in row.changes(float(at)).items():
                found[key] = found.get(key, 0.0) + change
        return found

    def along(self, found: PressAnswer) -> tuple[Floats, Floats]:
        """Logarithms (2,) of force and voltage, and their slopes (r, 2) along the rows, over plus or minus."""
        size = np.abs(np.array(found.nominal))
        slopes = np.array([row.effect(found.slopes) for row in self.rows])
        return np.log(size), slopes / (size * np.sign(found.nominal))


def box_questions(config: Config, box: ToleranceBox, keys: tuple[str, ...]) -> dict[str, Question]:
    """The presses at all places but the nominal one, by their names; none where the path of the press matters, and
    where a quantity may nearly vanish, or a place cannot be built.

    config : on the mesh of these presses.
    """
    factored = with_factors(config)
    if path_matters(factored) or np.abs(box.relative).max(initial=0.0) > LARGEST_CHANGE:
        return {}
    try:
        for place in box.places:
            with_changes(factored, box.changes(place))
    except InputError:
        return {}
    places = enumerate(box.places[1:], 1)
    return {f"all off at once, {number}": Question(config, keys, box.changes(place)) for number, place in places}


class BoxProcess:
    """Logarithms of the sizes of force and voltage over a box. nominal (2,) : at the nominal design.

    finer : at the nominal design. coarser : at the places of the box.
    """

    def __init__(self, box: ToleranceBox, finer: PressAnswer, coarser: Sequence[PressAnswer]) -> None:
        self._box = box
        values, slopes = (np.array(part) for part in zip(*map(box.along, coarser), strict=True))
        bent = slopes * (1.0 + box.relative * box.places)[:, :, None]
        self._process = GradientProcess(box.logarithmic(box.places), values, bent)
        self.nominal, slope = box.along(finer)
        self._finer = self.nominal - values[0], slope - slopes[0]

    def logs(self, places: Floats) -> Floats:
        """At places (q, r), (q, 2)."""
        at, (value, slope) = self._box.logarithmic(places), self._finer
        return np.asarray(self._process.mean(at) + value + at @ slope)

    @property
    def missed(self) -> Floats:
        """Root mean square (2,) of the relative errors at presses that are left out."""
        return np.asarray(np.sqrt((np.expm1(self._process.left_out().error) ** 2).mean(axis=0)))


def drawn(
    box: ToleranceBox,
    finer: PressAnswer,
    coarser: Sequence[PressAnswer],
    ends: Sequence[tuple[Response, Response]],
    draws: int = DRAWS,
) -> dict[str, Any] | None:
    """Force and voltage at SHARES of the draws, and what the process misses of presses that are left out.

    coarser : at the places of the box. ends : responses at the upper and lower end of quantities without slopes. None
    where a force or voltage is nought or changes its sign, so that it has no logarithm.
    """
    signs = np.sign(finer.nominal)
    responses = [one.nominal for one in coarser] + [end for pair in ends for end in pair]
    if not signs.all() or any((np.sign(one) != signs).any() for one in responses):
        return None
    process = BoxProcess(box, finer, coarser)
    random = np.random.default_rng(SEED + 1)
    logs = process.logs(random.uniform(-1.0, 1.0, (draws, len(box.rows))))
    for pair in ends:
        up, down = (np.log(np.abs(end)) - process.nominal for end in pair)
        off = random.uniform(-1.0, 1.0, (draws, 1))
        logs += 0.5 * (up - down) * off + 0.5 * (up + down) * off**2
    missed = 100.0 * process.missed
    found = signs * np.exp(logs)
    return {
        "count": draws,
        "presses": len(coarser),
        "force_N": _percentiles(found[:, 0]),
        "voltage_V": _percentiles(found[:, 1]),
        "left_out_error": {"force_percent": float(missed[0]), "voltage_percent": float(missed[1])},
    }


def _percentiles(values: Floats) -> dict[str, float]:
    """Values at SHARES, by name."""
    found = np.quantile(values, SHARES)
    return {f"below_{100 * share:g}_percent": float(one) for share, one in zip(SHARES, found, strict=True)}

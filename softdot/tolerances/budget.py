"""The tolerance budget: what each plus or minus of the making does to force and voltage, largest first."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import copysign, sqrt
from typing import Any

from foundation.executor import HERE, Executor
from softdot.config.schema import Config
from softdot.tolerances.questions import Question, answered
from softdot.tolerances.responses import Response, coarser
from softdot.tolerances.tolerances import Tolerance, shifts, tolerances

MESH_FACTOR, CHECK_FACTOR = 2.0, 3.0
"""Elements of the budget and of its check, against those of the configuration."""
SLOPES, CHECK, ENDS = "derivatives", "derivatives, coarser mesh", ("upper end", "lower end")


@dataclass(frozen=True)
class Effect:
    """What one tolerance does: the change at the upper end of the quantity; by both ends, the larger change.

    mesh_error : the same on a coarser mesh, less this; by both ends, how far these are from equal or opposite.
    """

    tolerance: Tolerance
    change: Response
    mesh_error: Response
    method: str


@dataclass(frozen=True)
class Budget:
    """nominal : at the deepest step of the mesh of the budget; nominal_mesh_error : a coarser mesh less that.

    effects : largest share of the voltage first. total : root of the sum of the squares of those that count.
    """

    nominal: Response
    nominal_mesh_error: Response
    total: Response
    effects: tuple[Effect, ...]
    elements_mm: tuple[float, float]

    def as_dict(self) -> dict[str, Any]:
        """For kit.json."""
        return {
            "nominal": _pair(self.nominal),
            "element_size_mm": self.elements_mm[0],
            "contact_element_size_mm": self.elements_mm[1],
            "mesh_error": _pair(self.nominal_mesh_error),
            "root_sum_square": {**_pair(self.total), **_percent(self.total, self.nominal)},
            "rows": [_row(effect, self.nominal) for effect in self.effects],
        }


def budget_of(
    config: Config, told: Callable[[int, int, str], None] = lambda *_: None, executor: Executor = HERE
) -> Budget:
    """The tolerance budget of a configuration, largest effect on the voltage first. InputError, LinearSolveError,
    MeshingError, StoppedShortError.

    First-order effects by direct differentiation of the press; what vanishes there by symmetry by presses at both ends.
    told : how many presses are there, of how many, and which was the last.
    """
    rows, moved = tolerances(config), shifts(config)
    keys = tuple(sorted({key for row in rows for key in row.slopes}))
    fine, coarse = (coarser(config, factor) for factor in (MESH_FACTOR, CHECK_FACTOR))
    ends = {
        f"{row.label}, {way}": Question(fine, moved=coarser(end, MESH_FACTOR))
        for row, *both in moved
        for way, end in zip(ENDS, both, strict=True)
    }
    found = answered({SLOPES: Question(fine, keys), **ends, CHECK: Question(coarse, keys)}, executor, told)
    (nominal, by_key), (check, check_by_key) = found[SLOPES], found[CHECK]
    effects = [_first_order(row, by_key, check_by_key) for row in rows]
    effects += [_finite(row, nominal, *(found[f"{row.label}, {way}"] for way in ENDS)) for row, *_ in moved]
    effects.sort(key=lambda effect: -abs(effect.change.voltage))
    return Budget(
        nominal, _minus(check, nominal), _total(effects), tuple(effects),
        (fine.mesh.element_size_mm, fine.mesh.contact_element_size_mm),
    )  # fmt: skip


def _first_order(row: Tolerance, fine: Mapping[str, Response], coarse: Mapping[str, Response]) -> Effect:
    change, check = (_chain(row, by_key) for by_key in (fine, coarse))
    return Effect(row, change, _minus(check, change), "derivative")


def _chain(row: Tolerance, by_key: Mapping[str, Response]) -> Response:
    """The derivative along the row's slopes, times its plus or minus."""
    force = sum(slope * by_key[key].force for key, slope in row.slopes.items())
    voltage = sum(slope * by_key[key].voltage for key, slope in row.slopes.items())
    return Response(row.plus_minus * force, row.plus_minus * voltage)


def _finite(row: Tolerance, nominal: Response, above: Response, below: Response) -> Effect:
    pairs = list(zip(_minus(above, nominal), _minus(below, nominal), strict=True))
    change = Response(*(copysign(max(abs(up), abs(down)), up) for up, down in pairs))
    error = Response(*(min(abs(up - down), abs(up + down)) / 2 for up, down in pairs))
    return Effect(row, change, error, "both ends")


def _total(effects: Sequence[Effect]) -> Response:
    counted = [effect.change for effect in effects if effect.tolerance.counted]
    return Response(*(sqrt(sum(part**2 for part in parts)) for parts in zip(*counted, strict=True)))


def _minus(one: Response, other: Response) -> Response:
    return Response(one.force - other.force, one.voltage - other.voltage)


def _pair(response: Response) -> dict[str, float]:
    return {"force_N": response.force, "voltage_V": response.voltage}


def _percent(change: Response, nominal: Response) -> dict[str, float]:
    return {
        "force_percent": 100 * change.force / nominal.force,
        "voltage_percent": 100 * change.voltage / nominal.voltage,
    }


def _row(effect: Effect, nominal: Response) -> dict[str, Any]:
    row = effect.tolerance
    about = {name: getattr(row, name) for name in ("label", "nominal", "plus_minus", "unit", "source", "confidence")}
    return {
        **about,
        **_pair(effect.change),
        **_percent(effect.change, nominal),
        "mesh_error": _percent(effect.mesh_error, nominal),
        "method": effect.method,
        "counted": row.counted,
        "note": row.note,
    }

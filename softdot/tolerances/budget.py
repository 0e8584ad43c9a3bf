"""The tolerance budget: by how much each tolerance of the parts changes force and voltage, largest first."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import copysign, sqrt
from typing import Any

from foundation.executor import HERE, Executor
from softdot.config.schema import Config
from softdot.differentiation import value_of
from softdot.tolerances.draws import LinearResponse, ToleranceBox, box_questions, drawn
from softdot.tolerances.factors import with_factors
from softdot.tolerances.questions import Question, answer_all
from softdot.tolerances.responses import Response, coarser_press
from softdot.tolerances.tolerances import Tolerance, shifts, tolerances
from softdot.tolerances.uncertainty import PRESS_ERRORS

MESH_FACTOR, CHECK_FACTOR = 2.0, 3.0
"""Element sizes of the budget and of its check, over those of the configuration."""
NOMINAL_QUESTION, CHECK_QUESTION, END_NAMES = "derivatives", "derivatives, coarser mesh", ("upper end", "lower end")
"""Names of the questions of a budget: those of its two meshes, and of each end of a shift."""


@dataclass(frozen=True)
class Effect:
    """The effect of one tolerance: the change of the response at its upper end, or, by both ends, the larger change.

    mesh_error : the change on a coarser mesh less this one; by both ends, how far the two are from equal or opposite.
    """

    tolerance: Tolerance
    change: Response
    mesh_error: Response
    method: str


@dataclass(frozen=True)
class Budget:
    """A tolerance budget, its effects ordered by their share of the voltage, largest first.

    nominal : at the deepest step, on the mesh of the budget. nominal_mesh_error : on a coarser mesh, less nominal.
    total : root of the sum of the squares of the effects that count. elements_mm : element size, and that under the
    dot. drawn : all off at once (softdot.tolerances.draws), None where the path of the press matters.
    """

    nominal: Response
    nominal_mesh_error: Response
    total: Response
    effects: tuple[Effect, ...]
    elements_mm: tuple[float, float]
    drawn: dict[str, Any] | None

    def as_dict(self) -> dict[str, Any]:
        """The budget as kit.json holds it."""
        return {
            "nominal": _as_table(self.nominal),
            "element_size_mm": self.elements_mm[0],
            "contact_element_size_mm": self.elements_mm[1],
            "mesh_error": _as_table(self.nominal_mesh_error),
            "root_sum_square": {**_as_table(self.total), **_percent_of_nominal(self.total, self.nominal)},
            "drawn": self.drawn,
            "rows": [_budget_row(effect, self.nominal) for effect in self.effects],
        }


def tolerance_budget(
    config: Config, report: Callable[[int, int, str], None] = lambda *_: None, executor: Executor = HERE
) -> Budget:
    """The tolerance budget of a configuration, largest effect on the voltage first. InputError, LinearSolveError,
    MeshingError, StoppedShortError.

    First-order effects are found by direct differentiation of the press; those that vanish by symmetry, by presses at
    both ends. report : called with the number of finished presses, their total, and the name of the last one.
    """
    rows, moved = tolerances(config), shifts(config)
    keys = tuple(sorted({key for row in rows for key in row.slopes}))
    fine, coarse = (coarser_press(config, factor) for factor in (MESH_FACTOR, CHECK_FACTOR))
    ends = {
        f"{row.label}, {way}": Question(fine, moved=coarser_press(end, MESH_FACTOR))
        for row, *both in moved
        for way, end in zip(END_NAMES, both, strict=True)
    }
    factored = with_factors(coarse)
    box = ToleranceBox.of(rows, lambda key: value_of(factored, key))
    together = box_questions(coarse, box, keys)
    found = answer_all(
        {NOMINAL_QUESTION: Question(fine, keys), **ends, CHECK_QUESTION: Question(coarse, keys)}, executor, report
    )
    (nominal, by_key), (check, check_by_key) = found[NOMINAL_QUESTION], found[CHECK_QUESTION]
    effects = [_effect_by_derivatives(row, by_key, check_by_key) for row in rows]
    effects += [
        _effect_by_ends(row, nominal, *(found[f"{row.label}, {way}"] for way in END_NAMES)) for row, *_ in moved
    ]
    effects.sort(key=lambda effect: -abs(effect.change.voltage))
    try:
        places = answer_all(together, executor, report)
    except PRESS_ERRORS:  # a budget of the effects one by one is worth having without a press of all at once
        places, together = {}, {}
    known = [LinearResponse(check, check_by_key), *(LinearResponse(*places[name]) for name in together)]
    both = [(found[f"{row.label}, {END_NAMES[0]}"], found[f"{row.label}, {END_NAMES[1]}"]) for row, *_ in moved]
    off_at_once = drawn(box, LinearResponse(nominal, by_key), known, both) if together else None
    return Budget(
        nominal, _difference(check, nominal), _root_sum_square(effects), tuple(effects),
        (fine.mesh.element_size_mm, fine.mesh.contact_element_size_mm), off_at_once,
    )  # fmt: skip


def _effect_by_derivatives(row: Tolerance, fine: Mapping[str, Response], coarse: Mapping[str, Response]) -> Effect:
    """The effect of a tolerance from the derivatives on two meshes."""
    change, check = (_change_along_slopes(row, by_key) for by_key in (fine, coarse))
    return Effect(row, change, _difference(check, change), "derivative")


def _change_along_slopes(row: Tolerance, by_key: Mapping[str, Response]) -> Response:
    """The derivative along the slopes of a tolerance, times its plus or minus."""
    force = sum(slope * by_key[key].force for key, slope in row.slopes.items())
    voltage = sum(slope * by_key[key].voltage for key, slope in row.slopes.items())
    return Response(row.plus_minus * force, row.plus_minus * voltage)


def _effect_by_ends(row: Tolerance, nominal: Response, above: Response, below: Response) -> Effect:
    """The effect of a tolerance from the responses at its upper and lower end."""
    pairs = list(zip(_difference(above, nominal), _difference(below, nominal), strict=True))
    change = Response(*(copysign(max(abs(up), abs(down)), up) for up, down in pairs))
    error = Response(*(min(abs(up - down), abs(up + down)) / 2 for up, down in pairs))
    return Effect(row, change, error, "both ends")


def _root_sum_square(effects: Sequence[Effect]) -> Response:
    """The root of the sum of the squares of all changes that count."""
    counted = [effect.change for effect in effects if effect.tolerance.counted]
    return Response(*(sqrt(sum(part**2 for part in parts)) for parts in zip(*counted, strict=True)))


def _difference(one: Response, other: Response) -> Response:
    """One response less another."""
    return Response(one.force - other.force, one.voltage - other.voltage)


def _as_table(response: Response) -> dict[str, float]:
    """A response as numbers with units in their names."""
    return {"force_N": response.force, "voltage_V": response.voltage}


def _percent_of_nominal(change: Response, nominal: Response) -> dict[str, float]:
    """A change in percent of the nominal response."""
    return {
        "force_percent": 100 * change.force / nominal.force,
        "voltage_percent": 100 * change.voltage / nominal.voltage,
    }


def _budget_row(effect: Effect, nominal: Response) -> dict[str, Any]:
    """An effect as a row of the budget in kit.json."""
    row = effect.tolerance
    about = {name: getattr(row, name) for name in ("label", "nominal", "plus_minus", "unit", "source", "confidence")}
    return {
        **about,
        **_as_table(effect.change),
        **_percent_of_nominal(effect.change, nominal),
        "mesh_error": _percent_of_nominal(effect.mesh_error, nominal),
        "method": effect.method,
        "counted": row.counted,
        "note": row.note,
    }

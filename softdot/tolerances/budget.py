"""The tolerance budget: by how much each tolerance of the parts changes force and voltage, largest first."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from foundation.arrays import Floats
from foundation.executor import HERE, Executor
from softdot.config.schema import Config
from softdot.differentiation import value_of
from softdot.tolerances.draws import ToleranceBox, box_questions, drawn
from softdot.tolerances.factors import with_factors
from softdot.tolerances.questions import Question, Response, answer_all, coarser_press
from softdot.tolerances.tolerances import Tolerance, shifts, tolerances
from softdot.tolerances.uncertainty import PRESS_ERRORS

MESH_FACTOR, CHECK_FACTOR = 2.0, 3.0
"""Element sizes of the budget and of its check, over those of the configuration."""
NOMINAL_QUESTION, CHECK_QUESTION, END_NAMES = "derivatives", "derivatives, coarser mesh", ("upper end", "lower end")
"""Names of the questions of a budget: those of its two meshes, and of each end of a shift."""
DERIVATIVE, BOTH_ENDS = "derivative", "both ends"
"""How an effect is found."""
OF_A_ROW = ("label", "nominal", "plus_minus", "unit", "source", "confidence", "counted")
"""What a row of a budget tells of its tolerance."""


class BudgetAnswer(Protocol):
    """Quantities (q,) of a budget and their derivatives (q,) by key."""

    @property
    def nominal(self) -> Sequence[float]:
        """The quantities."""

    @property
    def slopes(self) -> Mapping[str, Sequence[float]]:
        """Their derivatives by key."""


@dataclass(frozen=True)
class Effect:
    """The effect of one tolerance on the budget's quantities (q,).

    change : at the upper end, or, by both ends, the larger change with the sign of that at the upper end. mesh_error :
    the change on a coarser mesh less this one; by both ends, how far the two are from equal or opposite.
    """

    tolerance: Tolerance
    change: Floats
    mesh_error: Floats
    method: str

    @property
    def row(self) -> dict[str, Any]:
        """The tolerance and the method, as a row of a budget in kit.json."""
        return {**{name: getattr(self.tolerance, name) for name in OF_A_ROW}, "method": self.method}


@dataclass(frozen=True)
class Budget:
    """A tolerance budget, its effects on (force, voltage) ordered by their share of the voltage, largest first.

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
    fine, coarse = (coarser_press(config, factor) for factor in (MESH_FACTOR, CHECK_FACTOR))
    asked = budget_questions(fine, coarse, rows, moved)
    factored = with_factors(coarse)
    box = ToleranceBox.of(rows, lambda key: value_of(factored, key))
    together = box_questions(coarse, box, asked[CHECK_QUESTION].keys)
    found = answer_all(asked, executor, report)
    nominal, check = found[NOMINAL_QUESTION], found[CHECK_QUESTION]
    effects = effects_of(rows, moved, found)
    try:
        places = answer_all(together, executor, report)
    except PRESS_ERRORS:  # a budget of the effects one by one is worth having without a press of all at once
        places, together = {}, {}
    known = [check, *(places[name] for name in together)]
    above, below = ([found[f"{row.label}, {way}"].nominal for row in moved] for way in END_NAMES)
    return Budget(
        nominal.nominal, Response(*np.subtract(check.nominal, nominal.nominal).tolist()),
        Response(*root_sum_square(effects).tolist()), tuple(effects),
        (fine.mesh.element_size_mm, fine.mesh.contact_element_size_mm),
        drawn(box, nominal, known, list(zip(above, below, strict=True))) if together else None,
    )  # fmt: skip


def budget_questions(
    fine: Config, coarse: Config, rows: Sequence[Tolerance], moved: Sequence[Tolerance], is_full_load: bool = False
) -> dict[str, Question]:
    """The presses of a budget by their names: derivatives by the keys of rows on both meshes, and both ends of shifts.

    is_full_load : as of Question.
    """
    keys = tuple(sorted({key for row in rows for key in row.slopes}))
    ends = {
        f"{row.label}, {way}": Question(fine, changes=row.changes(share), is_full_load=is_full_load)
        for row in moved
        for way, share in zip(END_NAMES, (1.0, -1.0), strict=True)
    }
    nominal, check = (Question(one, keys, is_full_load=is_full_load) for one in (fine, coarse))
    return {NOMINAL_QUESTION: nominal, **ends, CHECK_QUESTION: check}


def effects_of(
    rows: Sequence[Tolerance], moved: Sequence[Tolerance], found: Mapping[str, BudgetAnswer]
) -> list[Effect]:
    """The effects of rows and of shifts from the answers to budget_questions, the largest on the last quantity first.

    The quantities are those of the nominal answers, (q,).
    """
    fine, coarse = found[NOMINAL_QUESTION], found[CHECK_QUESTION]
    effects = []
    for row in rows:
        change = row.effect(fine.slopes)
        effects.append(Effect(row, change, row.effect(coarse.slopes) - change, DERIVATIVE))
    for row in moved:
        up, down = (np.subtract(found[f"{row.label}, {way}"].nominal, fine.nominal) for way in END_NAMES)
        change = np.copysign(np.maximum(np.abs(up), np.abs(down)), up)
        effects.append(Effect(row, change, np.minimum(np.abs(up - down), np.abs(up + down)) / 2.0, BOTH_ENDS))
    return sorted(effects, key=lambda effect: -abs(effect.change[-1]))


def root_sum_square(effects: Sequence[Effect]) -> Floats:
    """The root of the sum of the squares of all changes (q,) that count."""
    return np.asarray(np.sqrt(sum(effect.change**2 for effect in effects if effect.tolerance.counted)))


def _as_table(response: Sequence[float] | Floats) -> dict[str, float]:
    """Force and voltage as numbers with units in their names."""
    return {"force_N": float(response[0]), "voltage_V": float(response[1])}


def _percent_of_nominal(change: Sequence[float] | Floats, nominal: Response) -> dict[str, float]:
    """A change of force and voltage in percent of the nominal ones."""
    force, voltage = 100.0 * np.asarray(change) / np.array(nominal)
    return {"force_percent": float(force), "voltage_percent": float(voltage)}


def _budget_row(effect: Effect, nominal: Response) -> dict[str, Any]:
    """An effect as a row of the budget in kit.json."""
    return {
        **effect.row,
        **_as_table(effect.change),
        **_percent_of_nominal(effect.change, nominal),
        "mesh_error": _percent_of_nominal(effect.mesh_error, nominal),
        "note": effect.tolerance.note,
    }

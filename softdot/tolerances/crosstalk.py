"""The tolerance budget of an array's crosstalk: by how much each tolerance changes what the next segment reads."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from foundation.executor import HERE, Executor
from softdot.arrays.case import ArrayCase
from softdot.arrays.roles import middle
from softdot.config.model import as_segment
from softdot.config.schema import Config
from softdot.tolerances.budget import (
    BOTH_ENDS,
    CHECK_FACTOR,
    CHECK_QUESTION,
    MESH_FACTOR,
    NOMINAL_QUESTION,
    Effect,
    budget_questions,
    effects_of,
    root_sum_square,
)
from softdot.tolerances.questions import PressAnswer, answer_all, coarser_press
from softdot.tolerances.tolerances import placement_shifts, tolerances


class CrosstalkShare(NamedTuple):
    """The largest crosstalk of a press in percent, and its derivatives by key. read : number of that electrode."""

    nominal: tuple[float]
    slopes: Mapping[str, tuple[float]]
    read: int

    @classmethod
    def of(cls, answer: PressAnswer, pressed: int) -> "CrosstalkShare":
        """From the voltages of all electrodes, one of them pressed.

        With s = V_n / V_p of the electrode n that reads most beside the pressed one p, the change by a quantity is
        s' = (V_n' V_p - V_n V_p') / V_p^2.
        """
        beside = np.abs(answer.electrodes_V[""])
        beside[pressed] = 0.0
        read = int(np.argmax(beside))
        (own, other), *_ = pairs = [(each[pressed], each[read]) for each in answer.electrodes_V.values()]
        sign = float(np.sign(other / own))
        slopes = [(100.0 * sign * (by_other * own - other * by_own) / own**2,) for by_own, by_other in pairs]
        return cls((100.0 * abs(other / own),), dict(zip(answer.electrodes_V, slopes, strict=True)), read)


@dataclass(frozen=True)
class CrosstalkBudget:
    """The budget of the largest crosstalk while one segment is pressed, its effects ordered by size, largest first, in
    percentage points of the pressed segment's voltage.

    pressed, read : labels of the pressed segment and of the one that reads most beside it. percent : voltage of that
    one in percent of the pressed one's. mesh_error : of percent on a coarser mesh, less percent. total : root of the
    sum of the squares of the effects that count, in percentage points.
    """

    pressed: str
    read: str
    percent: float
    mesh_error: float
    total: float
    effects: tuple[Effect, ...]

    def as_dict(self) -> dict[str, Any]:
        """The budget as kit.json holds it."""
        return {
            "pressed": self.pressed,
            "read": self.read,
            "crosstalk_percent": self.percent,
            "mesh_error_percentage_points": self.mesh_error,
            "root_sum_square_percentage_points": self.total,
            "rows": [_row(effect) for effect in self.effects],
        }


def crosstalk_budget(
    config: Config, report: Callable[[int, int, str], None] = lambda *_: None, executor: Executor = HERE
) -> CrosstalkBudget | None:
    """The budget of the crosstalk of an array, None for a single segment. InputError also where the path of the press
    matters, LinearSolveError, MeshingError, StoppedShortError.

    The segment nearest to the middle is pressed by one dot, and all segments are off alike; voltages are those of open
    circuits. report : as in softdot.tolerances.budget.tolerance_budget.
    """
    case = ArrayCase(config)
    if len(case.layout.places) == 1:
        return None
    place = middle(case.layout)
    press = case.press_over(place).config
    fine, coarse = (coarser_press(press, factor) for factor in (MESH_FACTOR, CHECK_FACTOR))
    whole = as_segment(fine, case.layout)
    rows, moved = tolerances(whole), placement_shifts(whole)
    answers = answer_all(budget_questions(fine, coarse, rows, moved, is_full_load=True), executor, report)
    pressed = case.layout.places.index(place)
    found = {name: CrosstalkShare.of(answer, pressed) for name, answer in answers.items()}
    nominal, effects = found[NOMINAL_QUESTION], effects_of(rows, moved, found)
    (percent,), (coarser_percent,) = nominal.nominal, found[CHECK_QUESTION].nominal
    return CrosstalkBudget(
        place.label, case.layout.places[nominal.read].label, percent, coarser_percent - percent,
        float(root_sum_square(effects)[0]), tuple(effects),
    )  # fmt: skip


def _row(effect: Effect) -> dict[str, Any]:
    """An effect as a row of the budget in kit.json; by both ends it has no error of the mesh."""
    is_moved = effect.method == BOTH_ENDS
    return {
        **effect.row,
        "change_percentage_points": float(effect.change[0]),
        "mesh_error_percentage_points": None if is_moved else float(effect.mesh_error[0]),
    }

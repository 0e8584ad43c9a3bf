"""The tolerance budget of an array's crosstalk: by how much each tolerance changes what the next segment reads."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import hypot
from typing import Any, NamedTuple

import numpy as np

from foundation.cache import data_hash, recall, remember
from foundation.errors import InputError
from foundation.executor import HERE, Executor
from foundation.source_hash import source_hash
from softdot.arrays.case import ArrayCase
from softdot.arrays.roles import middle
from softdot.config.hashes import input_hash
from softdot.config.model import as_segment, model_of
from softdot.config.schema import Config
from softdot.differentiation import variations_of
from softdot.json_files import plain
from softdot.prepared_press import PreparedPress
from softdot.tolerances.budget import CHECK_FACTOR, CHECK_QUESTION, END_NAMES, MESH_FACTOR, NOMINAL_QUESTION
from softdot.tolerances.factors import with_factors
from softdot.tolerances.questions import answer_all
from softdot.tolerances.responses import coarser_press
from softdot.tolerances.tolerances import Tolerance, placement_shifts, tolerances
from solve.solution.full_load import FullLoad


class ArrayQuestion(NamedTuple):
    """A question about a press of an array: the open-circuit voltage of each electrode at full load.

    keys : of the array as one segment with factors, for derivatives of these voltages. moved : the array as one
    segment, pressed on the same mesh in place of the stated one.
    """

    config: Config
    keys: tuple[str, ...] = ()
    moved: Config | None = None

    def answer(self) -> dict[str, list[float]]:
        """Voltages (e,) in V under "", derivatives (e,) by each key under the key. InputError, LinearSolveError,
        MeshingError, StoppedShortError.
        """
        prepared = PreparedPress(self.config)
        assert prepared.layout is not None
        stated = with_factors(as_segment(self.config, prepared.layout))
        try:
            load = FullLoad(model_of(stated), prepared.solved_mesh)
            by_key = load.derivatives(variations_of(stated, self.keys))
            here = load.answer if self.moved is None else load.similar_answer(model_of(self.moved))
        except ValueError as error:
            raise InputError(str(error)) from None
        found = {"": here, **by_key}
        load.close()
        return {key: list(map(float, one.electrode_voltages)) for key, one in found.items()}

    def stored_answer(self) -> dict[str, list[float]] | None:
        """The answer to an earlier equal question, None where there was none."""
        return recall(self._name)

    def keep(self, answer: dict[str, list[float]]) -> None:
        """Store an answer that another process gave."""
        remember(self._name, plain(answer))

    @property
    def _name(self) -> str:
        moved = "" if self.moved is None else input_hash(self.moved)
        return f"crosstalk-{data_hash([input_hash(self.config), list(self.keys), moved, source_hash(__name__)])}"


@dataclass(frozen=True)
class CrosstalkEffect:
    """The effect of one tolerance on the largest crosstalk, in percentage points of the pressed segment's voltage.

    change : at the upper end of the tolerance, or, by both ends, the larger change. mesh_error : the same on a coarser
    mesh less this one; None by both ends.
    """

    tolerance: Tolerance
    change: float
    mesh_error: float | None
    method: str


@dataclass(frozen=True)
class CrosstalkBudget:
    """The budget of the largest crosstalk while one segment is pressed, its effects ordered by size, largest first.

    pressed, read : labels of the pressed segment and of the one that reads most beside it. percent : voltage of that
    one in percent of the pressed one's. mesh_error : of percent on a coarser mesh, less percent. total : root of the
    sum of the squares of the effects that count, in percentage points.
    """

    pressed: str
    read: str
    percent: float
    mesh_error: float
    total: float
    effects: tuple[CrosstalkEffect, ...]

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
    circuits. With s = V_n / V_p of the segment n that reads most beside the pressed one p, the change by a quantity is
    s' = (V_n' V_p - V_n V_p') / V_p^2. report : as in softdot.tolerances.budget.tolerance_budget.
    """
    case = ArrayCase(config)
    if len(case.layout.places) == 1:
        return None
    place = middle(case.layout)
    press = case.press_over(place).config
    fine, coarse = (coarser_press(press, factor) for factor in (MESH_FACTOR, CHECK_FACTOR))
    whole = as_segment(fine, case.layout)
    rows, moved = tolerances(whole), placement_shifts(whole)
    keys = tuple(sorted({key for row in rows for key in row.slopes}))
    ends = {
        f"{row.label}, {way}": ArrayQuestion(fine, moved=end)
        for row, *both in moved
        for way, end in zip(END_NAMES, both, strict=True)
    }
    asked = {NOMINAL_QUESTION: ArrayQuestion(fine, keys), **ends, CHECK_QUESTION: ArrayQuestion(coarse, keys)}
    answers = answer_all(asked, executor, report)
    pressed = case.layout.places.index(place)
    found, check = (_Shares(pressed, answers[name]) for name in (NOMINAL_QUESTION, CHECK_QUESTION))
    effects = [_by_derivatives(row, found, check) for row in rows]
    effects += [
        _by_ends(row, found, [_Shares(pressed, answers[f"{row.label}, {way}"]) for way in END_NAMES])
        for row, *_ in moved
    ]
    effects.sort(key=lambda effect: -abs(effect.change))
    return CrosstalkBudget(
        place.label, case.layout.places[found.read].label, found.percent, check.percent - found.percent,
        hypot(*(effect.change for effect in effects if effect.tolerance.counted)), tuple(effects),
    )  # fmt: skip


class _Shares:
    """The largest crosstalk of a press, in percent, from the voltages of all electrodes and their derivatives."""

    def __init__(self, pressed: int, answer: Mapping[str, Sequence[float]]) -> None:
        self._pressed, self._answer = pressed, answer
        beside = np.abs(answer[""])
        beside[pressed] = 0.0
        self.read = int(np.argmax(beside))
        own, other = self._pair("")
        self.percent = 100.0 * abs(other / own)

    def slope(self, key: str) -> float:
        """Derivative of the largest crosstalk by a key."""
        (own, other), (own_slope, other_slope) = self._pair(""), self._pair(key)
        return 100.0 * float(np.sign(other / own)) * (other_slope * own - other * own_slope) / own**2

    def _pair(self, key: str) -> tuple[float, float]:
        """Of the pressed electrode, and of the one that reads most beside it."""
        return self._answer[key][self._pressed], self._answer[key][self.read]


def _by_derivatives(row: Tolerance, fine: _Shares, coarse: _Shares) -> CrosstalkEffect:
    change, check = (
        row.plus_minus * sum(slope * one.slope(key) for key, slope in row.slopes.items()) for one in (fine, coarse)
    )
    return CrosstalkEffect(row, change, check - change, "derivative")


def _by_ends(row: Tolerance, nominal: _Shares, ends: Sequence[_Shares]) -> CrosstalkEffect:
    changes = [end.percent - nominal.percent for end in ends]
    return CrosstalkEffect(row, max(changes, key=abs), None, "both ends")


def _row(effect: CrosstalkEffect) -> dict[str, Any]:
    kept = ("label", "nominal", "plus_minus", "unit", "source", "confidence", "counted")
    return {
        **{name: getattr(effect.tolerance, name) for name in kept},
        "change_percentage_points": effect.change,
        "mesh_error_percentage_points": effect.mesh_error,
        "method": effect.method,
    }

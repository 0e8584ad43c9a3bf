"""The last answers, kept: tables, curves of a path, courses of the dot.

A step of a fit changes one setting, and most settings leave most of these as they are. Questions have no hash, as
arrays and settings have none, so they are compared.
"""

from collections.abc import Callable
from operator import eq
from typing import Generic, TypeVar

import numpy as np

from diagnose.engines.segment.drive import Drive
from diagnose.engines.segment.response import Mechanics, mechanics
from foundation.arrays import Floats
from solve.model import Model
from solve.physics import linear_laws
from solve.reduced.fit import ResponseTable

Question = TypeVar("Question")
Answer = TypeVar("Answer")
Course = tuple[ResponseTable, Drive, Floats, tuple[object, ...]]
"""Table, drive, its values (t,), and what else acts on the dot."""


class Recent(Generic[Question, Answer]):
    """A cache of at most count answers; the one that was asked for longest ago goes first."""

    def __init__(self, count: int, same: Callable[[Question, Question], bool] = eq) -> None:
        self._count, self._same = count, same
        self._kept: list[tuple[Question, Answer]] = []

    def recall_or_make(self, question: Question, make: Callable[[], Answer]) -> Answer:
        """Answer to the same question as before, or else the one that is made, which is kept."""
        for number, (before, answer) in enumerate(self._kept):
            if self._same(before, question):
                self._kept.append(self._kept.pop(number))
                return answer
        made = make()
        self._kept = [*self._kept, (question, made)][-self._count :]
        return made

    def clear(self) -> None:
        """Forget all answers."""
        self._kept = []


class Courses:
    """A cache of the mechanics of the last drives that were followed: what stands behind the film leaves them alone."""

    def __init__(self, count: int) -> None:
        self._recent: Recent[Course, Mechanics] = Recent(count, _is_same_course)

    def mechanics(
        self, fit: ResponseTable, depth_mm: float, layers: tuple[str, ...], drive: Drive, values: Floats, on: Model
    ) -> Mechanics:
        """Mechanics under a drive of these values (t,), as response.mechanics gives them. ValueError as there."""
        physics = on.physics
        acting = linear_laws(physics.inelastic), physics.rig_terms
        return self._recent.recall_or_make(
            (fit, drive, values, acting), lambda: mechanics(fit, depth_mm, layers, drive, values, on)
        )


def _is_same_course(one: Course, other: Course) -> bool:
    """Whether two courses have the same table and drive, equal values (t,) and equal physics."""
    fit, drive, values, acting = one
    return fit is other[0] and drive is other[1] and acting == other[3] and np.array_equal(values, other[2])

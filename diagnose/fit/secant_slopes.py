"""Slopes of a prediction that are differenced once and then corrected by what each step showed.

Broyden's update, as in the secant version of Levenberg and Marquardt's method (Madsen, Nielsen and Tingleff, Methods
for Non-Linear Least Squares Problems, 2nd edition, 2004, section 3.5): a step costs one prediction, not one for each
value.
"""

from collections.abc import Callable
from typing import Generic, Protocol, TypeVar

import numpy as np

from foundation.arrays import Floats


class PredictedPoint(Protocol):
    """Values and what the model predicts there."""

    @property
    def values(self) -> Floats:
        """(q,)."""

    @property
    def predicted(self) -> Floats:
        """(n,)."""


PredictedType = TypeVar("PredictedType", bound=PredictedPoint)


class SecantSlopes(Generic[PredictedType]):
    """Slopes (n, q) along the way of one descent. exact : those at a place, by differences."""

    def __init__(self, exact: Callable[[PredictedType], Floats]) -> None:
        self._exact = exact
        self._place: PredictedType | None = None
        self._differenced = False
        self._slopes: Floats = np.zeros((0, 0))

    def at(self, place: PredictedType, anew: bool) -> Floats:
        """Slopes at a place, differenced there where they are asked for anew or none are known."""
        last, self._place = self._place, place
        if last is None or (anew and not (last is place and self._differenced)):
            self._slopes, self._differenced = self._exact(place), True
        elif last is not place:
            self._correct(place.values - last.values, place.predicted - last.predicted)
            self._differenced = False
        return self._slopes

    def _correct(self, moved: Floats, change: Floats) -> None:
        """Make the slopes tell the change (n,) of a step (q,), weighted by how much each value acts."""
        weight = moved * np.einsum("nq,nq->q", self._slopes, self._slopes)
        along = float(weight @ moved)
        if along > 0.0:
            self._slopes = self._slopes + np.outer(change - self._slopes @ moved, weight / along)

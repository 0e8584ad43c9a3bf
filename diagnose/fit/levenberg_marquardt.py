"""Bounded Levenberg-Marquardt (Marquardt, J. Soc. Ind. Appl. Math. 11 (1963) 431): damped Newton steps that stay within
bounds, on whatever gives a cost and its quadratic model.
"""

from collections.abc import Callable
from contextlib import suppress
from typing import NamedTuple, Protocol, TypeVar

import numpy as np
from scipy.optimize import lsq_linear

from foundation.arrays import Floats

FIRST_DAMPING = 1e-3
TIGHTEST = 1e6  # damping beyond which no step is tried
KEPT = 0.25  # of the gain that a quadratic model promised: it is made anew where a step gained less
RIDGE = 1e-12  # on a unit diagonal: coordinates that act exactly alike


class CostedPoint(Protocol):
    """Values and what they cost."""

    @property
    def values(self) -> Floats:
        """(q,)."""

    @property
    def cost(self) -> float:
        """The number that becomes least, infinite where there is no answer."""


PointType = TypeVar("PointType", bound=CostedPoint)


class Patience(NamedTuple):
    """iterations : the most. least_gain : of the cost, a step that gains less is the last. still : of a standard error,
    a step below it is none. usual_cost : of noise alone. Where a fit leaves more, standard errors are larger by the
    root of the ratio, and so are these. rough_gain : the same as least_gain, whatever a fit leaves.
    """

    iterations: int
    least_gain: float
    still: float
    usual_cost: float
    rough_gain: float = 0.0


def minimised(
    at: Callable[[Floats], PointType],
    expansion: Callable[[PointType, bool], tuple[Floats, Floats]],
    start: Floats,
    limits: Floats,
    patience: Patience,
) -> PointType:
    """The best point from a start (q,) within limits (q, 2), the start itself where its cost is infinite.

    at : the point at values. expansion : the Hessian (q, q) and the downhill gradient (q,) of the cost at a point, anew
    or corrected by what the last step showed. They are made anew where a corrected one promised what a step did not
    keep; the last word is that of one made anew.
    """
    here = at(np.clip(start, *limits.T))
    damping, anew, left = FIRST_DAMPING, True, patience.iterations if np.isfinite(here.cost) else 0
    while left > 0:
        left -= anew
        hessian, gradient = expansion(here, anew)
        misfit = max(here.cost / patience.usual_cost, 1.0)
        least_square = patience.still**2 * misfit
        after, damping = _improved(at, here, hessian, gradient, damping, limits, least_square if anew else np.inf)
        if after is not None:
            gain, moved = here.cost - after.cost, after.values - here.values
            square, promised = float(moved @ hessian @ moved), float(gradient @ moved)
            here = after
        least_gain = max(patience.least_gain * misfit, patience.rough_gain)
        ended = after is None or gain < least_gain or square < least_square
        if ended and anew:
            break
        anew = ended or gain < KEPT * (promised - 0.5 * square)
    return here


def _improved(
    at: Callable[[Floats], PointType],
    here: PointType,
    hessian: Floats,
    gradient: Floats,
    damping: float,
    limits: Floats,
    least_square: float,
) -> tuple[PointType | None, float]:
    """A better point and the next damping; none where only steps too small to matter are left, whose square in the
    metric of the Hessian is below least_square.
    """
    while damping < TIGHTEST:
        with suppress(ValueError):  # of a matrix that is not positive, or beyond all numbers
            step = bounded_step(hessian, gradient, damping, here.values, limits)
            after = at(here.values + step)
            if after.cost < here.cost:
                return after, damping / 10.0
            if float(step @ hessian @ step) < least_square:
                break
        damping = max(damping * 10.0, FIRST_DAMPING)
    return None, damping


def bounded_step(hessian: Floats, gradient: Floats, damping: float, values: Floats, limits: Floats) -> Floats:
    """The damped Newton step within the bounds."""
    scale = scales(hessian)
    damped = hessian / np.outer(scale, scale) + (damping + RIDGE) * np.eye(len(values))
    root = np.linalg.cholesky(damped)
    low, high = ((limits - values[:, None]) * scale[:, None]).T
    found = lsq_linear(root.T, np.linalg.solve(root, gradient / scale), (low, high), method="bvls")
    return np.asarray(np.clip(found.x / scale, limits[:, 0] - values, limits[:, 1] - values))


def scales(hessian: Floats) -> Floats:
    """Root of the diagonal (q,), 1 for a coordinate that changes nothing."""
    diagonal = np.diag(hessian)
    return np.asarray(np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0)))

"""Intervals of parameters by the profile likelihood.

An interval holds every value whose negative log-likelihood, minimised over the other parameters, is within half the
chi-square quantile of the least one (Wilks 1938; Venzon and Moolgavkar, Appl. Stat. 37 (1988) 87). Unlike a standard
error it need not be symmetric and stops at physical bounds.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq, minimize
from scipy.stats import chi2

from mesh.types import Bools, Floats

Objective = Callable[[Floats], float]
RESOLUTION = 0.01  # of the first guess of a standard error: how sharply the ends are found
# In the same unit: the step of numerical slopes, far above the tolerance of an iterative forward model; the slope and
# the change of the likelihood below which a minimum is found, far below the rise that is looked for.
ACCURACY = {"eps": 1e-3, "gtol": 3e-3, "ftol": 1e-5}
DOUBLINGS = 40  # of the search for an end, 1e12 standard errors: beyond it the parameter is not limited at all


@dataclass(frozen=True)
class Interval:
    """at_low, at_high : the interval ends at the bound because the likelihood does not exclude it."""

    value: float
    low: float
    high: float
    at_low: bool
    at_high: bool


class Profile:
    """A negative log-likelihood with bounds, in units of first guesses of the standard errors.

    best : (p,) the minimum. least : the value there less that at the start.
    """

    def __init__(self, objective: Objective, start: Floats, sigma: Floats, bounds: Floats) -> None:
        """start : (p,) near the minimum. sigma : (p,) first guesses of standard errors. bounds : (p, 2), may be inf."""
        self._sigma, self._bounds = sigma, bounds
        offset = objective(start)  # tolerances are relative: large sums must not drown the differences
        self._objective: Objective = lambda point: objective(point) - offset
        self.least, self.best = self._minimum(start, np.ones(len(start), dtype=bool))

    def interval(self, number: int, level: float = 0.9) -> Interval:
        """The interval of one parameter."""
        drop = 0.5 * float(chi2.ppf(level, 1))
        low, at_low = self._end(number, -1, drop)
        high, at_high = self._end(number, 1, drop)
        return Interval(float(self.best[number]), low, high, at_low, at_high)

    def _end(self, number: int, side: int, drop: float) -> tuple[float, bool]:
        """Where the profile has risen by `drop`, and whether a bound comes first."""
        excess = self._excess(number, drop)
        limit, step = float(self._bounds[number, (side + 1) // 2]), float(np.sqrt(2.0 * drop) * self._sigma[number])
        inside = outside = float(self.best[number])
        for _ in range(DOUBLINGS):
            outside = side * min(side * (outside + side * step), side * limit)
            if excess(outside) > 0.0:
                xtol = RESOLUTION * self._sigma[number]
                return float(brentq(excess, inside, outside, xtol=xtol)), False
            if outside == limit:
                break
            inside, step = outside, 2.0 * step
        return limit, True

    def _excess(self, number: int, drop: float) -> Callable[[float], float]:
        """The rise of the profile less `drop`; each minimisation starts from the last one."""
        others = np.arange(len(self.best)) != number
        last = self.best.copy()

        def excess(value: float) -> float:
            nonlocal last
            start = last.copy()
            start[number] = value
            rise, last = self._minimum(start, others)
            return rise - self.least - drop

        return excess

    def _minimum(self, start: Floats, vary: Bools) -> tuple[float, Floats]:
        """The least value over the parameters marked in vary (p,), and where it is."""
        point = start.copy()
        if not vary.any():
            return float(self._objective(point)), point

        def scaled(free: Floats) -> float:
            point[vary] = start[vary] + free * self._sigma[vary]
            return float(self._objective(point.copy()))

        limits = (self._bounds[vary] - start[vary, None]) / self._sigma[vary, None]
        found = minimize(scaled, np.zeros(int(vary.sum())), method="L-BFGS-B", bounds=limits, options=ACCURACY)
        point[vary] = np.clip(start[vary] + found.x * self._sigma[vary], *self._bounds[vary].T)
        return float(found.fun), point

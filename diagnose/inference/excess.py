"""How much of the excess a model leaves."""

from dataclasses import replace

import numpy as np

from diagnose.inference.quadratic import Quadratic
from diagnose.inference.refit import Fitted
from diagnose.inference.system import System


def excess(system: System) -> float:
    """Sum of squares above what noise and the engine's own errors make, nuisances integrated out; at least 0."""
    return max(system.quadratic.square(system.weighted(system.residual)) - float(system.live.sum()), 0.0)


def share_left(fit: Fitted, before: float) -> float:
    """Share of an excess that a fitted model leaves, its error of form not excused."""
    system = replace(fit.system, form=0.0)
    columns = np.column_stack([system.excused, fit.slopes[system.live]])
    sigma = np.concatenate([system.sigma, np.full(fit.slopes.shape[1], np.inf)])
    square = Quadratic(system.weighted(columns), sigma).square(system.weighted(system.residual))
    return max(square - float(system.live.sum()), 0.0) / before if before > 0.0 else 0.0

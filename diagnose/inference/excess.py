"""How much of the excess a model leaves."""

from dataclasses import replace

import numpy as np

from diagnose.fit.linearised_system import LinearisedSystem
from diagnose.fit.marginal_likelihood import Quadratic
from diagnose.fit.refit import Fitted


def excess(system: LinearisedSystem) -> float:
    """Sum of squares above what noise and the engine's own errors make, nuisances integrated out; at least 0."""
    return max(system.quadratic.square(system.weighted_rows(system.residual)) - float(system.informative.sum()), 0.0)


def share_left(fit: Fitted, before: float) -> float:
    """Share of an excess that a fitted model leaves, its model discrepancy not integrated out."""
    system = replace(fit.system, form_error=0.0)
    columns = np.column_stack([system.nuisance_design, fit.slopes[system.informative]])
    sigma = np.concatenate([system.sigma, np.full(fit.slopes.shape[1], np.inf)])
    square = Quadratic(system.weighted_rows(columns), sigma).square(system.weighted_rows(system.residual))
    return max(square - float(system.informative.sum()), 0.0) / before if before > 0.0 else 0.0

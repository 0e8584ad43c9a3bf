"""How much of the excess a model leaves."""

from diagnose.fit.linearised_system import LinearisedSystem


def excess(system: LinearisedSystem) -> float:
    """Sum of squares above what noise and the engine's own errors make, nuisances integrated out; at least 0."""
    return max(system.quadratic.square(system.weighted_rows(system.residual)) - float(system.informative.sum()), 0.0)

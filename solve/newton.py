"""Semismooth Newton iteration at fixed load."""

from dataclasses import dataclass

import numpy as np

from mesh.types import Floats
from solve.linear import LinearSolveError, LinearSolver
from solve.solid import InvertedElementError
from solve.system import Evaluation, Load, System

TOLERANCE = 1e-9
MAX_ITERATIONS = 25
MAX_HALVINGS = 6
SIMILAR_CONTACT = 6  # so many nodes may change contact and the last factorisation still be a good preconditioner


@dataclass(frozen=True)
class Equilibrium:
    """A converged state: unknowns, iterations and the residual relative to the contact forces."""

    x: Floats
    iterations: int
    relative_residual: float


class NoEquilibriumError(RuntimeError):
    """Newton did not converge; says why, and which unknown is worst."""

    def __init__(self, reason: str, x: Floats, worst: int | None) -> None:
        super().__init__(reason)
        self.x, self.worst = x, worst


def equilibrate(system: System, linear: LinearSolver, x: Floats, load: Load) -> Equilibrium:
    """Find the equilibrium near x (count,). NoEquilibriumError when there is none within the iterations."""
    x = x.copy()
    try:
        now = system.evaluate(x, load)
        previous = None
        for iteration in range(MAX_ITERATIONS):
            norm = float(np.linalg.norm(now.residual))
            relative = norm / max(now.load_norm, 1e-12)
            settled = previous is None or np.array_equal(previous, now.active)
            if relative <= TOLERANCE and settled:
                return Equilibrium(x, iteration, relative)
            if not np.isfinite(norm):
                break
            similar = previous is not None and int(np.sum(previous != now.active)) <= SIMILAR_CONTACT
            # inexact Newton: the linear residual need only fall as the nonlinear one will
            step = linear.solve(now.tangent, -now.residual, min(0.1 * relative, 1e-3), similar)
            previous = now.active
            x, now = _advance(system, x, step, load)
    except LinearSolveError as error:
        raise NoEquilibriumError(f"the tangent is singular ({error})", x, None) from error
    except InvertedElementError as error:
        raise NoEquilibriumError(str(error), x, None) from error
    worst = int(np.nanargmax(np.abs(now.residual)))
    raise NoEquilibriumError(f"no convergence in {MAX_ITERATIONS} Newton iterations", x, worst)


def _advance(system: System, x: Floats, step: Floats, load: Load) -> tuple[Floats, Evaluation]:
    """The full Newton step, halved while it turns an element inside out."""
    for _ in range(MAX_HALVINGS):
        trial = x + step
        try:
            return trial, system.evaluate(trial, load)
        except InvertedElementError as error:
            failure = error
            step = 0.5 * step
    raise failure

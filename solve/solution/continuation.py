"""Past a limit point: where no equilibrium lies near the last one, move on through damped states to the next.

Pseudo-transient continuation (Kelley and Keyes, SIAM J. Numer. Anal. 35 (1998) 508, doi:10.1137/S0036142996304796):
implicit Euler steps of c dx/ds = -R(x) at a fixed load, one Newton iteration each, longer as the residual falls. It
runs downhill in energy, so it ends where an equilibrium is stable. Nothing is damped in the answer: Newton finishes it.
"""

from dataclasses import replace

import numpy as np

from foundation.arrays import Floats
from solve.solution.errors import NoEquilibriumError
from solve.solution.linear import LinearSolveError, LinearSolver
from solve.solution.newton import equilibrate
from solve.system import Evaluation, Load, State, System
from solve.terms.solid import InvertedElementError

MAX_STEPS = 150
FIRST_DAMPING = 0.1  # of the median stiffness of a displacement
LEAST_DAMPING_RATIO, MOST_DAMPING_RATIO = 0.3, 3.0  # how far the damping may fall or grow from step to step
MOST_IDLE_STEPS = 60  # steps in which the unbalanced forces must fall once by a tenth below the least so far
MAX_REFUSED = 20  # steps that turn an element inside out, one after the other: it holds whatever the damping
NEWTON_RESIDUAL = 1e-5  # relative residual from which Newton goes on alone
LINEAR_TOLERANCE = 1e-6
SMALLEST_DIVISOR = 1e-300


def snap(system: System, linear: LinearSolver, load: Load, time: float, previous: State) -> State:
    """Find the equilibrium that the segment falls into from its last one. NoEquilibriumError where it finds none."""
    try:
        x, steps = _fall(system, linear, load, time, previous)
    except (InvertedElementError, LinearSolveError) as error:
        raise NoEquilibriumError(str(error), previous.x, None) from error
    state = equilibrate(system, linear, x, load, time, previous)
    return replace(state, iterations=state.iterations + steps, snapped=True)


def _fall(system: System, linear: LinearSolver, load: Load, time: float, previous: State) -> tuple[Floats, int]:
    """Unknowns (count,) near the next equilibrium, and the steps to there."""

    def evaluate(x: Floats) -> Evaluation:
        return system.evaluate(system.trial(x, load, time, previous), previous.histories)

    x, now = previous.x, evaluate(previous.x)
    dampers = np.zeros(len(x))
    dampers[system.mechanical] = FIRST_DAMPING * np.median(now.tangent.upper.diagonal()[system.mechanical])
    refused, least, least_at = 0, np.inf, 0
    for step in range(MAX_STEPS):
        unbalanced = _unbalanced_force(system, now)
        if unbalanced < 0.9 * least:
            least, least_at = unbalanced, step
        if step - least_at >= MOST_IDLE_STEPS or refused >= MAX_REFUSED:
            break
        if step > 0 and np.linalg.norm(now.residual) <= NEWTON_RESIDUAL * max(now.load_norm, previous.force_scale):
            return x, step
        change = linear.solve(now.tangent.with_shift(dampers), -now.residual, LINEAR_TOLERANCE)
        try:
            then = evaluate(x + change)
        except InvertedElementError:
            dampers *= MOST_DAMPING_RATIO
            refused += 1
            continue
        x, now, refused = x + change, then, 0
        ratio = _unbalanced_force(system, now) / max(unbalanced, SMALLEST_DIVISOR)
        dampers *= np.clip(ratio, LEAST_DAMPING_RATIO, MOST_DAMPING_RATIO)
    raise NoEquilibriumError(f"no equilibrium in {step + 1} damped steps either", x, None)


def _unbalanced_force(system: System, now: Evaluation) -> float:
    """Norm of the nodal forces; gaps that open and close jump too much to steer by."""
    return float(np.linalg.norm(now.residual[system.mechanical]))

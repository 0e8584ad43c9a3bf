"""Past a limit point: where no equilibrium lies near the last one, move on through damped states to the next.

Pseudo-transient continuation (Kelley and Keyes, SIAM J. Numer. Anal. 35 (1998) 508, doi:10.1137/S0036142996304796):
implicit Euler steps of c dx/ds = -R(x) at a fixed load, one Newton iteration each, longer as the residual falls. It
runs downhill in energy, so it ends where an equilibrium is stable. Nothing is damped in the answer: Newton finishes it.

Where contact opens in a step: a straight line between its ends gives back work that the segment never held.

From the last state that touches, under the force F, to the first one that is clear, by a gap g, the line carries force
over g too: F g / 2 too much.
"""

from dataclasses import replace

import numpy as np

from geometry.arrays import Floats
from solve.fem.term import Trial
from solve.solution.linear import LinearSolveError, LinearSolver
from solve.solution.newton import NoEquilibriumError, equilibrate
from solve.system import Evaluation, Load, State, System
from solve.terms.solid import InvertedElementError

MAX_STEPS = 150
FIRST_DAMPING = 0.1  # of the median stiffness of a displacement
FASTER, SLOWER = 0.3, 3.0  # how far the damping may fall or grow from step to step
PATIENCE = 60  # steps in which the unbalanced forces must fall once by a tenth below the least so far
MAX_REFUSED = 20  # steps that turn an element inside out, one after the other: it holds whatever the damping
NEAR = 1e-5  # relative residual from which Newton goes on alone
LINEAR_TOLERANCE = 1e-6
TINY = 1e-300


def snapped(system: System, linear: LinearSolver, load: Load, time: float, previous: State) -> State:
    """The equilibrium that the segment falls into from its last one. NoEquilibriumError where it finds none."""
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
        unbalanced = _unbalanced(system, now)
        if unbalanced < 0.9 * least:
            least, least_at = unbalanced, step
        if step - least_at >= PATIENCE or refused >= MAX_REFUSED:
            break
        if step > 0 and np.linalg.norm(now.residual) <= NEAR * max(now.load_norm, previous.force_scale):
            return x, step
        change = linear.solve(now.tangent.shifted(dampers), -now.residual, LINEAR_TOLERANCE)
        try:
            then = evaluate(x + change)
        except InvertedElementError:
            dampers *= SLOWER
            refused += 1
            continue
        x, now, refused = x + change, then, 0
        dampers *= np.clip(_unbalanced(system, now) / max(unbalanced, TINY), FASTER, SLOWER)
    raise NoEquilibriumError(f"no equilibrium in {step + 1} damped steps either", x, None)


def _unbalanced(system: System, now: Evaluation) -> float:
    """Norm of the nodal forces; gaps that open and close jump too much to steer by."""
    return float(np.linalg.norm(now.residual[system.mechanical]))


OPENING_TOLERANCE = 0.01  # of the most work put in so far


def opens_too_coarsely(system: System, before: State, state: State) -> bool:
    """Whether all contact is lost in a step, and with it more work than the tolerance."""
    here, there = _trial(system, before), _trial(system, state)
    if not system.contact.closed(here).any() or system.contact.closed(there).any():
        return False
    clear = float(system.contact.mean_gap(there.displacement, there.move).min())
    made_up = 0.5 * _force(system, before) * min(clear, -_travel(system, before, state))
    return made_up > OPENING_TOLERANCE * before.most_work


def with_work(system: System, before: State, state: State) -> State:
    """The state with the work of the dot up to it, by straight lines."""
    work = before.work + 0.5 * (_force(system, before) + _force(system, state)) * _travel(system, before, state)
    return replace(state, work=work, most_work=max(work, before.most_work))


def _trial(system: System, state: State) -> Trial:
    return system.trial(state.x, state.load, state.time, state)


def _force(system: System, state: State) -> float:
    """Of the dot on the segment, downwards."""
    return -float(system.dot_force(_trial(system, state))[2])


def _travel(system: System, before: State, state: State) -> float:
    """Of the dot, downwards."""
    return float(system.move(before.x, before.load)[2] - system.move(state.x, state.load)[2])

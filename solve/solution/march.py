"""March from target to target: sub-steps that adapt to convergence and to the error of the time integration.

Past a limit point: where no equilibrium lies near the last one, move on through damped states to the next.

Pseudo-transient continuation (Kelley and Keyes, SIAM J. Numer. Anal. 35 (1998) 508, doi:10.1137/S0036142996304796):
implicit Euler steps of c dx/ds = -R(x) at a fixed load, one Newton iteration each, longer as the residual falls. It
runs downhill in energy, so it ends where an equilibrium is stable. Nothing is damped in the answer: Newton finishes it.

Where contact opens in a step: a straight line between its ends gives back work that the segment never held.

From the last state that touches, under the force F, to the first one that is clear, by a gap g, the line carries force
over g too: F g / 2 too much.
"""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace

import numpy as np

from geometry.arrays import Floats
from solve.solution.linear import LinearSolveError, LinearSolver
from solve.solution.newton import (
    CRUSHED,
    NEAR_FORESEEN,
    NoEquilibriumError,
    equilibrate,
    explained,
    rim_met,
    smallest_volumes,
)
from solve.solution.schedule import Target, load_between
from solve.system import Evaluation, Load, State, System
from solve.terms.base import Trial
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


INCOMPRESSIBLE = 10.0  # of the bulk modulus over the shear modulus; 9.7 at a Poisson's ratio of 0.45
OPENING_TOLERANCE = 0.01  # of the most work put in so far


def opens_too_coarsely(system: System, before: State, state: State) -> bool:
    """Whether all contact is lost in a step, and with it more work than the tolerance."""
    here, there = _trial(system, before), _trial(system, state)
    if not system.contact.closed(here).any() or system.contact.closed(there).any():
        return False
    clear = float(system.contact.mean_gap(there.displacement, there.move).min())
    made_up = 0.5 * _force(system, before) * min(clear, -_travel(system, before, state))
    return made_up > OPENING_TOLERANCE * before.most_work


def crushes(system: System, before: State, state: State) -> bool:
    """Whether a step takes most of the volume of an element that can hardly be compressed.

    Then Newton's method has gone too far, to an equilibrium in which a fold of the mesh holds itself.
    """
    return _least_volume(system, state) < CRUSHED <= _least_volume(system, before)


def _least_volume(system: System, state: State) -> float:
    """The smallest det F of media that can hardly be compressed."""
    displacement = system.displacement(state.x)
    rubbers = [s for s in system.solids if s.law.bulk_modulus > INCOMPRESSIBLE * s.law.shear_modulus]
    return float(min((smallest_volumes(one, displacement).min() for one in rubbers), default=1.0))


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


MAX_APPROACHES = 20
ROUND_OFF = 1e-9  # of the segment's length
SMALLEST_SUBSTEP = 1.0 / 64.0  # for convergence; one that time asks to be smaller than that, by as much again
SMALLEST_IN_TIME = 1.0 / 128.0  # for the error of the time integration
TIME_TOLERANCE = 1e-3  # of the largest stress, or of the dot's path, in one sub-step

OnState = Callable[[State, State], None]  # a converged state and the one before it


def rest_state(system: System, linear: LinearSolver, start: Target) -> State:
    """The segment before the press; with a prestretched film at its equilibrium, the electrodes discharged.

    NoEquilibriumError.
    """
    rest = replace(system.at_rest(start.load), time=start.time)
    pull = system.film.prestress_resultant()
    if pull == 0.0:
        return rest
    long_ago = replace(rest, time=-np.inf, force_scale=pull)
    return equilibrate(system, linear, rest.x, start.load, start.time, long_ago)


def march(
    system: System,
    linear: LinearSolver,
    past: list[State],
    target: Target,
    kink: bool,
    on_state: OnState,
    may_snap: bool = False,
) -> str | None:
    """Walk to the target, halving the step where Newton fails or goes too far, time is cut too coarsely, or contact
    opens in midst.

    Where time is cut too coarsely in the smallest step too, that step is damped, and the state keeps its error.
    past : the last converged states, extended in place. kink : the rate of loading jumped at the last of them.
    may_snap : whether to look for a far equilibrium where Newton fails in the smallest step too (see
    solve.solution.march); not where answers must be smooth over the path. Returns why it stopped short, or None.
    """
    start, done, size, first = Target(past[-1].time, past[-1].load, kink), 0.0, 1.0, kink
    linear.exact = False
    while done < 1.0:
        left = 1.0 - done
        size = left / np.ceil(left / size - 1e-6)  # equal parts: a sliver that is left over would help nobody
        load, time = load_between(start, target, done + size)
        try:
            # across a kink the past says nothing of the future
            state = _equilibrate(system, linear, past[-1:] if first else past, load, time)
            error = system.time_error(past[-1], state, after_kink=first)
            if error > TIME_TOLERANCE and size > SMALLEST_IN_TIME:
                size *= max(0.5, 0.9 * np.sqrt(TIME_TOLERANCE / error)) if error < 4.0 * TIME_TOLERANCE else 0.5
                continue
            too_far = opens_too_coarsely(system, past[-1], state) or crushes(system, past[-1], state)
            if size > SMALLEST_SUBSTEP and too_far:
                size *= 0.5
                continue
            if error > TIME_TOLERANCE:
                damped = equilibrate(system, linear, state.x, load, time, past[-1], damped=True)
                state = replace(damped, iterations=state.iterations + damped.iterations, time_error=error)
        except NoEquilibriumError as failure:
            smallest = SMALLEST_SUBSTEP if size >= SMALLEST_SUBSTEP else SMALLEST_SUBSTEP**2
            linear.exact = True
            if 0.5 * size >= smallest:
                size *= 0.5
                continue
            elsewhere = may_snap and rim_met(system, past[-1], load) is None  # between two rigid bodies nothing falls
            found = _after_snap(system, linear, past[-1], load, time) if elsewhere else None
            if found is None:
                why = explained(system, failure, past[-1], load)
                return f"sub-steps fell below 1/{1 / smallest:.0f} of it: {why}"
            state, error = found, system.time_error(past[-1], found, after_kink=True)
        done, first = done + size, state.snapped
        size *= 2.0 if error < 0.2 * TIME_TOLERANCE else 1.0
        state = with_work(system, past[-1], state)
        on_state(state, past[-1])
        past.append(state)
        del past[:-2]
    return None


def _after_snap(system: System, linear: LinearSolver, last: State, load: Load, time: float) -> State | None:
    try:
        return snapped(system, linear, load, time, last)
    except NoEquilibriumError:
        return None


def _equilibrate(system: System, linear: LinearSolver, past: list[State], load: Load, time: float) -> State:
    """Newton from the line through the last two states and, where that fails, from the last one."""
    last = past[-1]
    if len(past) > 1:
        with suppress(NoEquilibriumError):
            return equilibrate(system, linear, _ahead(past[-2], last, time), load, time, last, near=NEAR_FORESEEN)
    try:
        return equilibrate(system, linear, _touching(system, last, load, time, 4), load, time, last)
    except NoEquilibriumError:  # on a curved dot four nodes can be too far from each other for a small force
        if system.unknowns.approach < 0:
            raise
    return equilibrate(system, linear, _touching(system, last, load, time, 1), load, time, last)


def _ahead(before: State, last: State, time: float) -> Floats:
    """The line through two states, at a later time. Contact spreads with kinks: a parabola through three is farther off
    where it ends, and costs more iterations.
    """
    return last.x + (last.x - before.x) * (time - last.time) / (last.time - before.time)


def _touching(system: System, last: State, load: Load, time: float, nodes: int) -> Floats:
    """A force needs contact to start from: move the dot until it overlaps so many nodes."""
    approach = system.unknowns.approach
    if approach < 0 or load.drive <= last.load.drive:
        return last.x
    if system.contact.closed(system.trial(last.x, load, time, last)).any():
        return last.x
    x = last.x.copy()
    for _ in range(MAX_APPROACHES):  # on a slope the gap closes more slowly than the dot moves
        gap = _gap(system, x, load, time, last)
        nearest = np.sort(gap)[min(nodes, len(gap)) - 1]
        if nearest < 0.0:
            break
        x[approach] += 1.01 * nearest + ROUND_OFF
    return x


def _gap(system: System, x: Floats, load: Load, time: float, last: State) -> Floats:
    """Mean gap (c,) at the nodes of the contact."""
    trial = system.trial(x, load, time, last)
    return system.contact.mean_gap(trial.displacement, trial.move)

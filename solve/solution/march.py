"""March from target to target: sub-steps that adapt to convergence and to the error of the time integration."""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace

import numpy as np

from foundation.arrays import Floats
from solve.solution.advice import explain_failure
from solve.solution.continuation import snap
from solve.solution.crushing import crushes
from solve.solution.errors import NoEquilibriumError
from solve.solution.held_rim import rim_met
from solve.solution.linear import LinearSolver
from solve.solution.newton import SETTLING_RESIDUAL_FORESEEN, equilibrate
from solve.solution.schedule import Target, load_between
from solve.solution.work import opens_too_coarsely, with_work
from solve.system import Load, State, System

MAX_APPROACHES = 20
APPROACH_ROUND_OFF = 1e-9  # of the segment's length
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
    solve.solution.continuation); not where answers must be smooth over the path. Returns why it stopped short, or None.
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
            too_far = opens_too_coarsely(system, past[-1], state) or crushes(system, past[-1].x, state.x)
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
            found = _snap_or_none(system, linear, past[-1], load, time) if elsewhere else None
            if found is None:
                why = explain_failure(system, failure, past[-1], load)
                return f"sub-steps fell below 1/{1 / smallest:.0f} of it: {why}"
            state, error = found, system.time_error(past[-1], found, after_kink=True)
        done, first = done + size, state.snapped
        size *= 2.0 if error < 0.2 * TIME_TOLERANCE else 1.0
        state = with_work(system, past[-1], state)
        on_state(state, past[-1])
        past.append(state)
        del past[:-2]
    return None


def _snap_or_none(system: System, linear: LinearSolver, last: State, load: Load, time: float) -> State | None:
    """The equilibrium that the segment falls into, None where it finds none."""
    try:
        return snap(system, linear, load, time, last)
    except NoEquilibriumError:
        return None


def _equilibrate(system: System, linear: LinearSolver, past: list[State], load: Load, time: float) -> State:
    """Newton from the line through the last two states and, where that fails, from the last one."""
    last = past[-1]
    if len(past) > 1:
        with suppress(NoEquilibriumError):
            return equilibrate(
                system, linear, _extrapolate(past[-2], last, time), load, time, last, near=SETTLING_RESIDUAL_FORESEEN
            )
    try:
        return equilibrate(system, linear, _move_to_contact(system, last, load, time, 4), load, time, last)
    except NoEquilibriumError:  # on a curved dot four nodes can be too far from each other for a small force
        if system.unknowns.approach < 0:
            raise
    return equilibrate(system, linear, _move_to_contact(system, last, load, time, 1), load, time, last)


def _extrapolate(before: State, last: State, time: float) -> Floats:
    """Unknowns (count,) on the line through two states, at a later time. Contact spreads with kinks: a parabola through
    three is farther off where it ends, and costs more iterations.
    """
    return last.x + (last.x - before.x) * (time - last.time) / (last.time - before.time)


def _move_to_contact(system: System, last: State, load: Load, time: float, nodes: int) -> Floats:
    """Unknowns (count,) with the dot moved until it overlaps a number of nodes: a force needs contact to start from."""
    approach = system.unknowns.approach
    if approach < 0 or load.drive <= last.load.drive:
        return last.x
    if system.contact.closed_nodes(system.trial(last.x, load, time, last)).any():
        return last.x
    x = last.x.copy()
    for _ in range(MAX_APPROACHES):  # on a slope the gap closes more slowly than the dot moves
        gap = _mean_gaps(system, x, load, time, last)
        nearest = np.sort(gap)[min(nodes, len(gap)) - 1]
        if nearest < 0.0:
            break
        x[approach] += 1.01 * nearest + APPROACH_ROUND_OFF
    return x


def _mean_gaps(system: System, x: Floats, load: Load, time: float, last: State) -> Floats:
    """Mean gap (c,) around each node of the contact."""
    trial = system.trial(x, load, time, last)
    return system.contact.mean_gap(trial.displacement, trial.move)

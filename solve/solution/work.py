"""The work of the dot along its path, and where contact opens in a step too coarsely to tell it.

A straight line between the ends of such a step gives back work that the segment never held: from the last state that
touches, under the force F, to the first one that is clear, by a gap g, the line carries force over g too, F g / 2 too
much.
"""

from dataclasses import replace

from solve.system import State, System
from solve.terms.base import Trial

OPENING_TOLERANCE = 0.01  # of the most work put in so far


def opens_too_coarsely(system: System, before: State, state: State) -> bool:
    """Whether all contact is lost in a step, and with it more work than the tolerance."""
    here, there = _trial(system, before), _trial(system, state)
    if not system.contact.closed_nodes(here).any() or system.contact.closed_nodes(there).any():
        return False
    clear = float(system.contact.mean_gap(there.displacement, there.move).min())
    made_up = 0.5 * _downward_force(system, before) * min(clear, -_downward_travel(system, before, state))
    return made_up > OPENING_TOLERANCE * before.most_work


def with_work(system: System, before: State, state: State) -> State:
    """The state with the work of the dot up to it, by straight lines."""
    mean_force = 0.5 * (_downward_force(system, before) + _downward_force(system, state))
    work = before.work + mean_force * _downward_travel(system, before, state)
    return replace(state, work=work, most_work=max(work, before.most_work))


def _trial(system: System, state: State) -> Trial:
    return system.trial(state.x, state.load, state.time, state)


def _downward_force(system: System, state: State) -> float:
    """Force of the dot on the segment, downwards."""
    return -float(system.dot_force(_trial(system, state))[2])


def _downward_travel(system: System, before: State, state: State) -> float:
    """Travel of the dot between two states, downwards."""
    return float(system.move(before.x, before.load)[2] - system.move(state.x, state.load)[2])

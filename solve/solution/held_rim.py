"""Where the dot meets the rim of a part that the case holds: neither of them can deform."""

import numpy as np

from solve.system import Load, State, System

NEAR_RIM = 0.01  # of the segment's length: a force stops a dot just short of the rim
ALLOWED_OVERLAP = -1e-6
"""Of the segment's length: contact does not act on nodes that are held, so that none may be overlapped."""


def rim_met(system: System, last: State, load: Load, gap_left: float | None = None) -> int | None:
    """The node of the held rim that the dot would overlap most under a load after a state; None where it is clear.

    gap_left : from which gap on it counts as met; none: 0, and a little more where a force stops short of it.
    """
    if gap_left is None:
        gap_left = NEAR_RIM if system.force_driven else 0.0
    nodes = np.unique(system.contact.facets)
    held = nodes[(system.unknowns.displacement[nodes] < 0).all(axis=1)]
    if len(held) == 0:
        return None
    gap = system.contact.dot.distance(system.points[held], system.move(last.x, load))[0]
    deepest = int(np.argmin(gap))
    return int(held[deepest]) if gap[deepest] < gap_left else None

"""Few and coarse presses of a candidate, which tell whether it is worth all of its presses.

Each coordinate is pressed at its smallest node on either side, a one-sided one at every second of its nodes, on the
diagnosis mesh, at three depths and, where the path matters, at three places of each way back. Along depth and way back
the change is linear in between.
"""

from dataclasses import replace

import numpy as np

from diagnose.engines.segment.interpolation import PressedEffect, pressed_effect
from diagnose.engines.segment.path_history import TURNING_NUMBERS
from diagnose.forward import Candidate, Coordinate
from foundation.arrays import Floats
from solve.tables.depth_press import RETURN, DepthPress

SEEN = 0, 2, 4
"""Numbers of the shares of the depth at which a rough press is seen; those where a press turns back are among them."""
SEEN_BACK = 0.75, 0.4, 0.03
"""Of the depth from which the dot returns."""


def rough_effect(candidate: Candidate) -> PressedEffect:
    """Layout of the rough presses of a candidate. Where a coordinate fades with the first, its own part is left out."""
    rough = [replace(coordinate, nodes=_rough_nodes(coordinate)) for coordinate in candidate.coordinates]
    if candidate.together == "fading":
        rough[1:] = [replace(coordinate, nodes=()) for coordinate in rough[1:]]
    return pressed_effect(candidate.together, tuple(rough))


def _rough_nodes(coordinate: Coordinate) -> tuple[float, ...]:
    if not coordinate.nodes or coordinate.low < 0.0 < coordinate.high:
        sides = [[node for node in coordinate.nodes if sign * node > 0.0] for sign in (-1.0, 1.0)]
        return tuple(min(side, key=abs) for side in sides if side)
    return coordinate.nodes[1::2] or coordinate.nodes


def rough_job(job: DepthPress) -> DepthPress:
    """The job of a full press, seen at few places and without the steps that slip takes."""
    shares = tuple(job.shares[n] for n in SEEN)
    back = tuple(SEEN.index(n) for n in job.back)
    return replace(job, shares=shares, back=back, returns=SEEN_BACK if back else (), parts=1)


def at_all_places(values: Floats, shares: tuple[float, ...]) -> Floats:
    """Changes (n + b r, 2 + e) at all places of a full press with shares (n,), from those of a rough press."""
    seen = [shares[n] for n in SEEN]
    found = [_interpolate(shares, seen, values[: len(SEEN)])]
    for number, turning in enumerate(TURNING_NUMBERS if len(values) > len(SEEN) else ()):
        back = values[len(SEEN) + number * len(SEEN_BACK) :][: len(SEEN_BACK)]
        begun = values[SEEN.index(turning)]
        found.append(_interpolate(RETURN, (*SEEN_BACK[::-1], 1.0), np.vstack([back[::-1], begun])))
    return np.concatenate(found)


def _interpolate(at: tuple[float, ...], known: list[float] | tuple[float, ...], values: Floats) -> Floats:
    """Values (m, o) at places (m,), linear between those (k, o) at places (k,), constant beyond their ends."""
    return np.column_stack([np.interp(at, known, column) for column in values.T])

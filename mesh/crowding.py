"""Nodes crowded towards held sides, where the stress of the film is singular and much of its charge arises."""

from dataclasses import replace

import numpy as np

from foundation.arrays import Floats
from geometry.parameters import Segment
from mesh.outline import stack_outline
from mesh.types import TET_EDGES, TetMesh

FIRST_MOVED_SHARE, LEAST_ROOM_SHARE = 0.6, 0.05
"""Share of half the footprint up to which nodes stay; least share that must be left beyond the foot of an effector."""
CROWDING_POWER = 3.0
"""Distances from the side become this power of themselves: evenly spaced nodes resolve a singularity again."""


def crowded_mesh(tet_mesh: TetMesh, segment: Segment) -> TetMesh:
    """The mesh of an extruded solid with its nodes moved towards the sides in x and y, of a slice in x.

    It stays as it was where no side is held. A block, cylinder or dome keeps its foot, and nothing moves where it
    leaves no room.
    """
    if segment.boundary == "free":
        return tet_mesh
    stack, shift = stack_outline(segment), np.zeros_like(tet_mesh.points_mm)
    ends = (stack.half_x, stack.effector_half_x), (stack.half_y, stack.effector_half_y)
    for axis, (side, foot) in enumerate(ends[:1] if segment.section == "plane-strain" else ends):
        first = FIRST_MOVED_SHARE if stack.shape in ("none", "layer") else max(FIRST_MOVED_SHARE, foot / side)
        place = tet_mesh.points_mm[:, axis]
        if first < 1.0 - LEAST_ROOM_SHARE:
            shift[:, axis] = side * _towards_one(place / side, first) - place
    corners, middles = tet_mesh.tets[:, :4], tet_mesh.tets[:, 4:]
    shift[middles] = shift[corners[:, TET_EDGES]].mean(axis=2)  # edges stay straight, or as curved as they were
    return replace(tet_mesh, points_mm=tet_mesh.points_mm + shift)


def _towards_one(place: Floats, first: float) -> Floats:
    """Places (n,) from -1 to 1; those between first and 1 are moved towards 1, and likewise on the other side."""
    left = np.clip((1.0 - np.abs(place)) / (1.0 - first), 0.0, 1.0)
    return np.asarray(np.where(left < 1.0, np.sign(place) * (1.0 - (1.0 - first) * left**CROWDING_POWER), place))

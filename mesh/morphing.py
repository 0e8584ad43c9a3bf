"""A mesh moved to a segment of other sizes: the map that derivatives by sizes and families of designs share.

Each size has a place in a body of reference: the share of the height of a layer, the share of the way from the axis to
the rim of the effector's foot, from there to the side, and the share of the height of a dome. The map takes a node from
its place in one segment to the same place in another, so that moving twice is moving once, and surfaces stay surfaces.
"""

from dataclasses import replace

import numpy as np

from foundation.arrays import Floats
from geometry.parameters import Segment
from mesh.outline import StackOutline, stack_outline
from mesh.types import TetMesh

LEAST_SHARE = 1e-9
"""Least share of the way to the side beyond a foot: one that reaches the side has none."""


def morphed_mesh(tet_mesh: TetMesh, old: Segment, new: Segment) -> TetMesh:
    """The mesh moved from the sizes of one segment to those of another of the same parts.

    ValueError where the parts differ.
    """
    before, after = (stack_outline(segment, slice_mm=tet_mesh.thickness_mm) for segment in (old, new))
    if before.shape != after.shape or before.is_slice != after.is_slice:
        raise ValueError("the segments differ in their layers")
    points = tet_mesh.points_mm.copy()
    points[:, :2] = _moved_in_plane(points[:, :2], before, after)
    points[:, 2] = _moved_heights(tet_mesh.points_mm, before, after)
    thickness = tet_mesh.thickness_mm if before.is_slice else tet_mesh.thickness_mm * new.width_mm / old.width_mm
    return replace(tet_mesh, points_mm=points, thickness_mm=thickness)


def _moved_in_plane(places: Floats, before: StackOutline, after: StackOutline) -> Floats:
    """Places (n, 2) in x and y: the foot of the effector and the sides stay what they are."""
    sides = [np.array([one.half_x, one.half_y]) for one in (before, after)]
    feet = [np.array([one.effector_half_x, one.effector_half_y]) for one in (before, after)]
    if np.array_equal(sides[0], sides[1]) and np.array_equal(feet[0], feet[1]):
        return places
    shares = places / sides[0]
    if before.shape in ("none", "layer"):
        return np.asarray(shares * sides[1])
    if before.shape == "block" or before.is_slice:
        moved = _beyond_foot(np.abs(shares), feet[0] / sides[0], feet[1] / sides[1])
        return np.asarray(np.sign(shares) * moved * sides[1])
    out = np.abs(shares).max(axis=1)  # 0 on the axis, 1 at the sides, along the ray of each node
    ray = shares / np.where(out > 0.0, out, 1.0)[:, None]
    rims = [
        foot[0] / np.maximum(np.hypot(*(ray * side).T), LEAST_SHARE) for foot, side in zip(feet, sides, strict=True)
    ]
    return np.asarray(_beyond_foot(out, *rims)[:, None] * ray * sides[1])


def _beyond_foot(share: Floats, rim: Floats, new_rim: Floats) -> Floats:
    """Shares of the way from the axis to the side, linear up to the rim of the foot, and linear from there on."""
    outside = (1.0 - new_rim) / np.maximum(1.0 - rim, LEAST_SHARE)
    within = share * (new_rim / np.where(rim > 0.0, rim, 1.0))
    return np.asarray(np.where(share <= rim, within, new_rim + (share - rim) * outside))


def _moved_heights(points: Floats, before: StackOutline, after: StackOutline) -> Floats:
    """Heights (n,) of points (n, 3): linear within each layer, within a dome the share of its height there."""
    heights = [(0.0, one.film_bottom, one.film_top, one.medium1_top, one.top) for one in (before, after)]
    count = -1 if before.shape in ("none", "dome") else None
    moved = np.interp(points[:, 2], heights[0][:count], heights[1][:count])
    if before.shape != "dome":
        return np.asarray(moved)
    above = points[:, 2] - before.medium1_top
    inside = above > 0.0
    out = np.abs(points[inside, 0]) if before.is_slice else np.hypot(points[inside, 0], points[inside, 1])
    stretch = _dome_stretch(np.minimum(out / before.effector_half_x, 1.0), before, after)
    moved[inside] = after.medium1_top + above[inside] * stretch
    return np.asarray(moved)


def _dome_stretch(share: Floats, before: StackOutline, after: StackOutline) -> Floats:
    """New height over old one of a cap at a share (n,) of the radius of its foot.

    A cap of foot a and sphere R is a^2 (1 - s^2) / (sqrt(R^2 - s^2 a^2) + R - h) high at the share s.
    """
    if (before.effector_half_x, before.top - before.medium1_top) == (
        after.effector_half_x,
        after.top - after.medium1_top,
    ):
        return np.ones(len(share))
    foot = [one.effector_half_x for one in (before, after)]
    below = []
    for one in (before, after):
        radius, centre = one.dome_radius, one.medium1_top - one.dome_centre_z
        root = np.sqrt(np.maximum(radius**2 - (share * one.effector_half_x) ** 2, 0.0))
        below.append(np.maximum(root + centre, LEAST_SHARE * radius))
    return np.asarray((foot[1] / foot[0]) ** 2 * below[0] / below[1])

"""Triangulation of an array's footprint, with lines at all edges of layers and circles around round effectors."""

from itertools import pairwise

import numpy as np

from foundation.arrays import Bools, Floats
from geometry.array.layout import ArrayLayout
from mesh.array.sizing import HYPOTENUSE_PER_MEAN_EDGE, ArraySizing
from mesh.bisection import Triangulation, refine
from mesh.footprint import crossed_triangles, join_triangles, round_patch
from mesh.layered import triangles_beside_planes

PATCH_TOLERANCE_MM = 1e-6


def footprint_triangulation(layout: ArrayLayout, field: ArraySizing) -> Triangulation:
    """Triangulation of an array's footprint as fine as the sizes ask for, as far as the mirror planes.

    Part 1 lies inside the foot of a round effector, part 0 elsewhere.
    """
    radius = layout.foot_radius_mm
    x, y = (_subdivide_lines(layout.lines(axis), field.coarse_mm) for axis in (0, 1))
    if radius is not None:
        x, y = (_lines_with_patches(line, layout, axis) for axis, line in enumerate((x, y)))
    quads = np.array([[[a, c], [b, c], [b, d], [a, d]] for c, d in pairwise(y) for a, b in pairwise(x)])
    start = (
        _triangulation_with_patches(layout, quads, radius)
        if radius is not None
        else _one_part(crossed_triangles(quads))
    )
    half = triangles_beside_planes(start, field.outline.planes)
    return refine(half, lambda xy: HYPOTENUSE_PER_MEAN_EDGE * field.at_footprint(xy), radius, layout.middles)


def _one_part(triangles: Floats) -> Triangulation:
    return join_triangles(triangles, np.zeros(len(triangles), dtype=np.int64))


def _subdivide_lines(lines: Floats, coarse_mm: float) -> Floats:
    """Lines (n,) with others between them, at most as far apart as elements are long."""
    pieces = [np.linspace(a, b, 1 + max(1, round((b - a) / coarse_mm)))[:-1] for a, b in pairwise(lines)]
    return np.concatenate([*pieces, lines[-1:]])


def _lines_with_patches(lines: Floats, layout: ArrayLayout, axis: int) -> Floats:
    """Lines (n,) in which those within patches are replaced by five over each patch, which make four cells."""
    centres, half = layout.centres(axis), layout.patch_mm
    outside = (np.abs(lines[:, None] - centres) > half + PATCH_TOLERANCE_MM).all(axis=1)
    inside = (centres[:, None] + half * np.array([-1.0, -0.5, 0.0, 0.5, 1.0])).ravel()
    return np.unique(np.round(np.concatenate([lines[outside], inside]), 9))


def _triangulation_with_patches(layout: ArrayLayout, quads: Floats, radius: float) -> Triangulation:
    """Triangles of the quadrilaterals outside the patches, and in each patch a disc and the ring around it."""
    centres = layout.middles
    away = np.abs(quads.mean(axis=1)[:, None] - centres).max(axis=2)
    outside = crossed_triangles(quads[(away > layout.patch_mm).all(axis=1)])
    rim, disc = round_patch((layout.patch_mm, layout.patch_mm), radius)
    ring = crossed_triangles(rim)
    triangles = [outside, *(ring + centre for centre in centres), *(disc + centre for centre in centres)]
    part = np.repeat([0, 1], [len(outside) + len(ring) * len(centres), len(disc) * len(centres)])
    return join_triangles(np.concatenate(triangles), part)


def on_or_beyond_circles(layout: ArrayLayout, points: Floats, radius: float) -> Bools:
    """Whether points (n, 2) lie on a circle around a segment's middle, or outside all circles; shape (n,)."""
    return np.asarray(distance_to_nearest_middle(layout, points) > radius - PATCH_TOLERANCE_MM)


def distance_to_nearest_middle(layout: ArrayLayout, points: Floats) -> Floats:
    """Distance (n,) in mm of points (n, 2) from the middle of the nearest segment."""
    return np.asarray(np.linalg.norm(points[:, None] - layout.middles, axis=2).min(axis=1))

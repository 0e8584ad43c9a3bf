"""Data of the 3D view of the parts at rest, before anything is meshed: their surfaces and the cut through them."""

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from export.dot_surface import dot_parts, in_segment_frame, triangle_surface
from export.viewer_data import base64_array, colour_maps, rgb
from foundation.arrays import Floats, Ints
from geometry.dot import DotShape
from geometry.solids import PART_COLOURS
from geometry.triangulation import triangulated

TESSELLATION_CHORD_MM, TESSELLATION_ANGLE_RAD = 0.02, 0.3
PLANE_INSET_SHARE = 1e-3
"""Share of the width by which the cut lies behind the middle: an exact one would run along edges of the triangles."""


def parts_view(solids: Mapping[str, Any], dot_shape: DotShape) -> dict[str, Any]:
    """Data of export/viewer.js for one step at rest, as export.viewer_data gives them for a press.

    solids : build123d solids of the layers and the case by their labels. The cut runs through the middle of the dot,
    or beside it where it lies outside.
    """
    surfaces = {
        label: triangulated(solid, TESSELLATION_CHORD_MM, TESSELLATION_ANGLE_RAD) for label, solid in solids.items()
    }
    low, high = _lowest_and_highest(surfaces.values())
    plane = float(
        np.clip(dot_shape.origin_mm[1] + PLANE_INSET_SHARE * (high - low)[1], *(0.99 * np.array([low[1], high[1]])))
    )
    half = 0.5 * (high - low)
    dot = [
        (in_segment_frame(dot_shape, part.points_mm, dot_shape.origin_mm), part.triangles)
        for part in dot_parts(dot_shape, (float(half[0]), float(half[1])))
    ]
    outer = [points[triangles].reshape(-1, 3) for points, triangles in surfaces.values()]
    cut = [_cut_face(*surface, plane) for surface in surfaces.values()]
    corners = np.concatenate([*outer, *cut])
    part = [np.full(len(piece), number) for pieces in (outer, cut) for number, piece in enumerate(pieces)]
    whole = np.arange(len(corners))
    at = sum(len(piece) for piece in outer)
    facets = np.concatenate([points[triangles].reshape(-1, 3) for points, triangles in dot])
    return {
        "steps": [{"indentation": 0.0, "force": 0.0}],
        "names": list(surfaces),
        "colours": [rgb(PART_COLOURS[name]) for name in surfaces],
        **colour_maps(),
        "plane": plane,
        "slice": False,
        "points": base64_array(corners, np.float32),
        "displacement": base64_array(np.zeros(corners.size), np.int16),
        "displacementUnit": 1.0,
        "region": base64_array(np.concatenate(part), np.uint8),
        "outer": base64_array(whole[:at], np.uint32),
        "section": base64_array(whole[at:], np.uint32),
        "film": base64_array(np.empty(0), np.uint32),
        "dotPoints": base64_array(facets, np.float32),
        "dotCut": base64_array(np.concatenate([_half_behind_plane(*surface, plane) for surface in dot]), np.float32),
        "dotShift": [[0.0, 0.0, 0.0]],
        "dotColour": rgb(PART_COLOURS["dot"]),
    }


def _lowest_and_highest(surfaces: Iterable[tuple[Floats, Ints]]) -> tuple[Floats, Floats]:
    """Lowest and highest corner (3,) of all surfaces."""
    points = np.concatenate([found for found, _ in surfaces])
    return points.min(axis=0), points.max(axis=0)


def _half_behind_plane(points: Floats, triangles: Ints, plane: float) -> Floats:
    """Corners (3 t, 3) of the half of a surface behind the plane y, closed there."""
    surface = triangle_surface(points, triangles).clean()
    kept = surface.clip_closed_surface("y", origin=(0.0, plane, 0.0)).triangulate()
    return np.asarray(kept.points[kept.regular_faces], np.float64).reshape(-1, 3)


def _cut_face(points: Floats, triangles: Ints, plane: float) -> Floats:
    """Corners (3 t, 3) of the face in which the plane y cuts a body."""
    kept = _half_behind_plane(points, triangles, plane).reshape(-1, 3, 3)
    flat = np.abs(kept[:, :, 1] - plane).max(axis=1) < 1e-6
    return np.asarray(kept[flat].reshape(-1, 3))

"""The triangulated surfaces of all parts, film left out, merged into one surface for pytetwild."""

from typing import Any

import numpy as np

from geometry.parameters import Segment
from mesh.outline import Outline
from mesh.types import Floats, Ints

DEFLECTION_MM = 2e-3  # nodes are put on the exact surface afterwards
DEFLECTION = 0.02  # of the smallest detail, where that is more
TURN_RAD = 0.5  # of neighbouring facets


def merged_surface(segment: Segment, stack: Outline, detail_mm: float) -> tuple[Floats, Ints]:
    """Vertices (n, 3) and faces (m, 3) of the parts; vertices merged, double and flat faces dropped.

    detail_mm : size of the smallest elements or parts; round surfaces get facets that suit it.
    """
    deflection = max(DEFLECTION_MM, DEFLECTION * detail_mm)
    vertices, faces, count = [], [], 0
    for solid in _solids(segment, stack):
        points, triangles = solid.tessellate(deflection, TURN_RAD)
        vertices.append(np.array([tuple(p) for p in points]))
        faces.append(np.array(triangles, dtype=np.int64) + count)
        count += len(points)
    return _merged(np.concatenate(vertices), np.concatenate(faces))


def _merged(vertices: Floats, faces: Ints) -> tuple[Floats, Ints]:
    """Merge vertices closer than a nanometre; drop faces that are degenerate or repeated."""
    _, first, number = np.unique(np.round(vertices * 1e6), axis=0, return_index=True, return_inverse=True)
    points, triangles = vertices[first], number.ravel()[faces]
    corner = points[triangles]
    area = np.linalg.norm(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1) / 2
    triangles = triangles[area > 1e-12]
    _, kept = np.unique(np.sort(triangles, axis=1), axis=0, return_index=True)
    return points, triangles[np.sort(kept)]


def _solids(segment: Segment, stack: Outline) -> list[Any]:
    """build123d solids of the stack without its film."""
    if stack.is_slice:
        return _slab(stack)
    from geometry.layer_solids import layer_solids

    return list(layer_solids(segment, film_thickness_mm=0.0).values())


def _slab(stack: Outline) -> list[Any]:
    """The x-z section as a slab: a cylinder is a box then, a dome a circular segment along y."""
    from build123d import Box, Cylinder, Pos, Rot

    def box(half_x: float, low: float, high: float) -> Any:
        return Pos(0, 0, (low + high) / 2) * Box(2 * half_x, 2 * stack.half_y, high - low)

    parts = [
        box(stack.half_x, 0.0, stack.film_bottom),
        box(stack.half_x, stack.film_top, stack.medium1_top),
    ]
    if stack.shape == "dome":
        ridge = Rot(90, 0, 0) * Cylinder(stack.dome_radius, 2 * stack.half_y)
        above = box(2 * stack.dome_radius, stack.medium1_top, stack.top)
        parts.append(Pos(0, 0, stack.dome_centre_z) * ridge & above)
    elif stack.shape != "none":
        parts.append(box(stack.effector_half_x, stack.medium1_top, stack.top))
    return parts

"""The mesh of an array: the footprint of all segments, extruded layer by layer, with gaps and grooves left out.

It is the extrusion of mesh.layered: the same bisection and the same split of prisms. The start triangulation has lines
at all edges of layers, so that each triangle lies either inside a layer or outside it. A layer that is held at walls
inside the array (an island in a stiff grid) has these walls among its facets side-<part>, as its sides at the rim.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from geometry.array.layout import ArrayLayout, Rectangle
from geometry.arrays import Bools, Floats, Ints
from geometry.dot import DotShape
from geometry.stack import layers
from mesh.build import MeshOptions
from mesh.layered import Triangulation, beside_planes, crossed, joined, levels, refine
from mesh.outline import outline
from mesh.quadratic import between_parts, quadratic
from mesh.quality import refuse_inverted
from mesh.sizing import GROWTH, RIM, RIM_GROWTH, Sizing, sizing
from mesh.types import (
    TET_FACES,
    LinearMesh,
    Planes,
    TetMesh,
    boundary_faces,
    face_neighbours,
    oriented,
    split_prisms,
    without_unused,
)

HYPOTENUSE = 1.6
"""Longest edge of a right triangle against its mean edge, as in mesh.layered."""
FAR_GROWTH = 0.25
"""mm of edge length on the film per mm beside the pressed segment: what reaches a neighbour is smooth."""
TOLERANCE_MM = 1e-6
SAMPLES = 20_000
TRIANGLES = 4.0
"""Triangles for a square of the edge length, as bisection leaves them: within a factor of 1.5 on arrays of six."""


@dataclass(frozen=True)
class ArraySizing(Sizing):
    """Fine under the dots and on the film of the segments they press, growing away from these.

    pressed : (k, 4) rectangles x0, x1, y0, y1 of the segments under the dots; ends : (n, 4) the same, of the film,
    where it ends at walls, else of the whole array.
    """

    pressed: Floats
    ends: Floats

    def at(self, points: Floats) -> Floats:
        """Edge lengths in mm at points (n, 3), shape (n,)."""
        z = points[:, 2]
        to_film = np.abs(z - np.clip(z, self.outline.film_bottom, self.outline.film_top))
        beside = FAR_GROWTH * _outside(points, self.pressed).min(axis=1)
        film = self.film_mm + GROWTH * to_film + beside
        to_end = np.abs(_inside(points, self.ends)).min(axis=1)
        rim = RIM * self.film_mm + RIM_GROWTH * np.hypot(to_film, to_end) + beside
        contact = self.contact_mm + GROWTH * self._to_contact(points)
        return np.asarray(np.minimum(np.minimum(np.minimum(contact, film), rim), self.coarse_mm))


def _inside(points: Floats, rectangles: Floats) -> Floats:
    """Distance (n, k) of points from the nearest edge of each rectangle, negative outside."""
    x, y = points[:, :1], points[:, 1:2]
    x0, x1, y0, y1 = rectangles.T
    return np.asarray(np.minimum(np.minimum(x - x0, x1 - x), np.minimum(y - y0, y1 - y)), dtype=np.float64)


def _outside(points: Floats, rectangles: Floats) -> Floats:
    """Distance (n, k) of points from each rectangle, zero inside."""
    x, y = points[:, :1], points[:, 1:2]
    x0, x1, y0, y1 = rectangles.T
    beside = np.maximum(np.maximum(x0 - x, x - x1), 0.0), np.maximum(np.maximum(y0 - y, y - y1), 0.0)
    return np.asarray(np.hypot(*beside), dtype=np.float64)


def array_mesh(layout: ArrayLayout, dot: DotShape, options: MeshOptions, planes: Planes = ()) -> TetMesh:
    """Mesh an array under a dot, as far as its mirror planes.

    dot : where and how round the dots are, which is where the mesh is fine. Raises MeshingError when an element is
    inverted. The layout must have passed its checks.
    """
    field = _sizing(layout, dot, options, planes)
    foot = _triangulate(layout, field)
    grooves = [
        layer.top_mm - groove.depth_mm for layer in layers(layout.segment) for groove in layout.grooves(layer.name)
    ]
    linear = _extrude(layout, foot, *levels(field.outline, field, options.film_layers, grooves))
    points, tets = quadratic(linear, None)
    facets = _facets(layout, points, tets, linear.region, linear.region_names, planes)
    twin = np.arange(len(points), dtype=np.int64)
    thickness = layout.whole.width_mm
    result = TetMesh(points, tets, linear.region, linear.region_names, facets, twin, thickness, planes)
    refuse_inverted(result)
    return result


def _sizing(layout: ArrayLayout, dot: DotShape, options: MeshOptions, planes: Planes) -> ArraySizing:
    """Sizes under a dot; the segments that it presses are those within the reach of a dot."""
    half_x, half_y = layout.half_mm
    base = sizing(outline(layout.whole, planes=planes), dot, options)
    segments = np.array(layout.rectangles("film"))
    near = _outside(np.column_stack([base.centers_mm, np.zeros(len(base.centers_mm))]), segments) <= base.reach_mm
    rim: list[Rectangle] = [(-half_x, half_x, -half_y, half_y)]
    ends = layout.rectangles("film") if layout.ends_at_walls("film") else rim
    pressed = segments[near.any(axis=0)] if near.any() else segments
    return ArraySizing(**vars(base), pressed=pressed, ends=np.array(ends))


def _triangulate(layout: ArrayLayout, field: ArraySizing) -> Triangulation:
    """The footprint, as fine at each place as the finest of skin and film above it."""
    stack = field.outline

    def size(xy: Floats) -> Floats:
        at = [np.column_stack([xy, np.full(len(xy), z)]) for z in (stack.film_top, stack.top)]
        return HYPOTENUSE * np.minimum(field.at(at[0]), field.at(at[1]))

    x, y = (_subdivided(layout.lines(axis), field.coarse_mm) for axis in (0, 1))
    quads = np.array(
        [[[a, c], [b, c], [b, d], [a, d]] for c, d in pairwise(y) for a, b in pairwise(x)],
    )
    start = crossed(quads)
    whole = joined(start, np.zeros(len(start), dtype=np.int64))
    return refine(beside_planes(whole, stack.planes), size, None)


def _subdivided(lines: Floats, coarse_mm: float) -> Floats:
    """Lines with others between them, as far apart as elements are long at most."""
    pieces = [np.linspace(a, b, 1 + max(1, round((b - a) / coarse_mm)))[:-1] for a, b in pairwise(lines)]
    return np.concatenate([*pieces, lines[-1:]])


def _extrude(
    layout: ArrayLayout, foot: Triangulation, heights: Floats, layer_region: Ints, names: tuple[str, ...]
) -> LinearMesh:
    """The prisms of all layers where each has material."""
    count, middle = len(foot.points), foot.points[foot.triangles].mean(axis=1)
    points = np.column_stack([np.tile(foot.points, (len(heights), 1)), np.repeat(heights, count)])
    tets, region = [], []
    for layer, part in enumerate(layer_region):
        height = (heights[layer] + heights[layer + 1]) / 2
        base = foot.triangles[layout.holds(names[part], middle, height)]
        tets.append(split_prisms(base + layer * count, base + (layer + 1) * count))
        region.append(np.full(len(tets[-1]), part, dtype=np.int64))
    all_tets = np.concatenate(tets)
    return without_unused(LinearMesh(points, oriented(points, all_tets), np.concatenate(region), names))


def _facets(
    layout: ArrayLayout, points: Floats, tets: Ints, region: Ints, names: tuple[str, ...], planes: Planes
) -> dict[str, Ints]:
    """The facets of mesh.types.TetMesh by name.

    The dot can touch what faces up, of the effector and of a bare medium 1. Walls in gaps are sides where the grid
    holds the layer, else bear no name.
    """
    owner, face = boundary_faces(tets)
    outer, part = tets[owner[:, None], TET_FACES[face]], region[owner]
    corner = points[outer[:, :3]]
    flat = np.ptp(corner[..., 2], axis=1) < TOLERANCE_MM
    on_base = flat & (np.abs(corner[..., 2]).max(axis=1) < TOLERANCE_MM)
    faces_up = flat & ~on_base & (np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])[:, 2] > 0.0)
    skin = [number for number, name in enumerate(names) if name in ("medium1", "effector")]
    result = {"contact": outer[faces_up & np.isin(part, skin)], "base": outer[on_base]}
    at_rim = _in_any_plane(corner, layout.half_mm)
    cut = np.zeros(len(outer), dtype=bool)
    for axis in planes:
        cut |= (np.abs(corner[..., axis]) < TOLERANCE_MM).all(axis=1)
    for number, name in enumerate(names):
        held = ~flat & ~cut if name in layout.array.grid_layers else at_rim
        mine = outer[held & (part == number)]
        if len(mine):
            result[f"side-{name}"] = mine
    neighbour, film = face_neighbours(tets[:, :4]), names.index("film")
    result["film-bottom"] = between_parts(tets, region, neighbour, names.index("medium2"), film)
    result["film-top"] = between_parts(tets, region, neighbour, film, names.index("medium1"))
    return result


def _in_any_plane(corner: Floats, half_mm: tuple[float, float]) -> Bools:
    """Facets (k, 3, 3) in a plane of the rim."""
    away = np.abs(np.abs(corner[..., :2]) - np.array(half_mm))
    return np.asarray((away < TOLERANCE_MM).all(axis=1).any(axis=1))


def expected_elements(layout: ArrayLayout, dot: DotShape, options: MeshOptions, planes: Planes = ()) -> float:
    """Rough number of elements: the triangles that the sizes ask for, times the layers, times three."""
    field = _sizing(layout, dot, options, planes)
    stack = field.outline
    low, high = np.array(stack.low), np.array([stack.half_x, stack.half_y])
    xy = np.random.default_rng(0).uniform(low, high, (SAMPLES, 2))
    at = [np.column_stack([xy, np.full(len(xy), z)]) for z in (stack.film_top, stack.top)]
    size = np.minimum(field.at(at[0]), field.at(at[1]))
    triangles = float(np.prod(high - low) * np.mean(TRIANGLES / size**2))
    x, y = field.centers_mm.mean(axis=0)
    z = np.linspace(0.0, stack.top, SAMPLES)
    through = stack.top * float(np.mean(1.0 / field.at(np.column_stack([np.full_like(z, x), np.full_like(z, y), z]))))
    return 3.0 * triangles * through

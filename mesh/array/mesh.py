"""The mesh of an array: the footprint of all segments, extruded layer by layer, with gaps and grooves left out.

It is the extrusion of mesh.layered: the same bisection and the same split of prisms. Each triangle of the footprint
lies either inside a layer or outside it. A dome is extruded too: its heights shrink to nothing at its rim, where the
nodes of all heights are one, and prisms become pyramids and tetrahedra. A row of plane-strain slices is the extrusion
of its section, as mesh.slice has it. A layer that is held at walls inside the array (by a stiff grid) has these walls
among its facets side-<part>, as its sides at the rim.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from foundation.arrays import Bools, Floats, Ints
from geometry.array.layout import ArrayLayout
from geometry.dot import DotShape
from geometry.stack import layers
from mesh.array.footprint import distance_to_nearest_middle, footprint_triangulation, on_or_beyond_circles
from mesh.array.sizing import ArraySizing, array_sizing
from mesh.bisection import Triangulation
from mesh.layered import layer_heights
from mesh.options import MeshOptions
from mesh.outline import RoundSurface, curved_surface, stack_outline
from mesh.quadratic import facets_between_parts, quadratic_nodes_and_tets
from mesh.quality import refuse_inverted
from mesh.section import MeshedSection, structured_section
from mesh.slice import extrude_section, node_twins
from mesh.types import (
    TET_FACES,
    LinearMesh,
    Planes,
    TetMesh,
    boundary_faces,
    face_neighbours,
    orient_tets,
    split_prisms,
    without_unused,
)

PLANE_TOLERANCE_MM = 1e-6


@dataclass(frozen=True)
class RoundSurfaces:
    """Round skins of all effectors: one surface, repeated above the middle of each segment (n, 2)."""

    one: RoundSurface
    centres: Floats

    def _local(self, points: Floats) -> tuple[Floats, Floats]:
        """Points (n, 3) relative to the middle of the nearest segment, and that middle (n, 3)."""
        nearest = np.linalg.norm(points[:, None, :2] - self.centres, axis=2).argmin(axis=1)
        middle = np.column_stack([self.centres[nearest], np.zeros(len(points))])
        return points - middle, middle

    def holds(self, points: Floats, tolerance: float = 1e-7) -> Bools:
        """Whether points (n, 3) lie on the skin of the nearest segment within a tolerance in mm."""
        return self.one.holds(self._local(points)[0], tolerance)

    def project(self, points: Floats) -> Floats:
        """Nearest points (n, 3) of the skin of the nearest segment; points in the plane of the foot stay in it."""
        local, middle = self._local(points)
        return np.asarray(self.one.project(local) + middle)

    def normals(self, points: Floats) -> Floats:
        """Outward unit normals (n, 3) of the skin of the nearest segment."""
        return self.one.normals(self._local(points)[0])


def array_mesh(layout: ArrayLayout, dot: DotShape, options: MeshOptions, planes: Planes = ()) -> TetMesh:
    """Mesh an array under a dot, as far as its mirror planes.

    dot : where and how round the dots are, which is where the mesh is fine. Raises MeshingError when an element is
    inverted. The layout must have passed its checks.
    """
    field = array_sizing(layout, dot, options, planes)
    grooves = [
        layer.top_mm - groove.depth_mm for layer in layers(layout.segment) for groove in layout.grooves(layer.name)
    ]
    heights, layer_region, names = layer_heights(field.outline, field, options.film_layers, grooves)
    thickness_mm = 2.0 * field.outline.half_y
    if layout.is_slice:
        linear = extrude_section(_section(layout, field, heights, layer_region, names), thickness_mm)
    else:
        linear = _extrude(layout, footprint_triangulation(layout, field), heights, layer_region, names)
    points, tets = quadratic_nodes_and_tets(linear, _round_surfaces(layout))
    facets = _facets(layout, points, tets, linear.region, linear.region_names, planes)
    twin = node_twins(points) if layout.is_slice else np.arange(len(points), dtype=np.int64)
    result = TetMesh(points, tets, linear.region, linear.region_names, facets, twin, thickness_mm, planes)
    refuse_inverted(result)
    return result


def _round_surfaces(layout: ArrayLayout) -> RoundSurfaces | None:
    one = curved_surface(stack_outline(layout.segment))
    return None if one is None else RoundSurfaces(one, layout.middles)


def _section(
    layout: ArrayLayout, field: ArraySizing, heights: Floats, layer_region: Ints, names: tuple[str, ...]
) -> MeshedSection:
    """The section of a row of slices."""

    def holds(layer: str, x: Floats, height: float) -> Bools:
        return layout.holds(layer, np.column_stack([x, np.zeros_like(x)]), height)

    return structured_section(field, heights, layer_region, names, layout.lines(0).tolist(), holds)


def _extrude(
    layout: ArrayLayout, foot: Triangulation, heights: Floats, layer_region: Ints, names: tuple[str, ...]
) -> LinearMesh:
    """Tetrahedra of the prisms of all layers where each has material."""
    points, node = _nodes(layout, foot, heights, layer_region, names)
    middle = foot.points[foot.triangles].mean(axis=1)
    tets, region = [], []
    for layer, part in enumerate(layer_region):
        height = (heights[layer] + heights[layer + 1]) / 2
        round_one = names[part] == "effector" and layout.foot_radius_mm is not None
        present = foot.part == 1 if round_one else layout.holds(names[part], middle, height)
        base = foot.triangles[present]
        prisms = split_prisms(node[layer][base], node[layer + 1][base])
        whole = (np.diff(np.sort(prisms, axis=1), axis=1) > 0).all(axis=1)  # at the rim of a dome some have shrunk
        tets.append(prisms[whole])
        region.append(np.full(len(tets[-1]), part, dtype=np.int64))
    all_tets = np.concatenate(tets)
    return without_unused(LinearMesh(points, orient_tets(points, all_tets), np.concatenate(region), names))


def _nodes(
    layout: ArrayLayout, foot: Triangulation, heights: Floats, layer_region: Ints, names: tuple[str, ...]
) -> tuple[Floats, Ints]:
    """Points of all levels, and the number (levels, n) of the node over each point of the footprint."""
    count = len(foot.points)
    points = np.column_stack([np.tile(foot.points, (len(heights), 1)), np.repeat(heights, count)])
    node = np.arange(len(points)).reshape(len(heights), count)
    effector, radius = layout.segment.effector, layout.foot_radius_mm
    if effector is None or radius is None or effector.shape != "dome":
        return points, node
    base = int(np.argmax(layer_region == names.index("effector")))
    sphere = curved_surface(stack_outline(layout.segment))
    assert sphere is not None
    away = np.minimum(distance_to_nearest_middle(layout, foot.points), radius)
    rise = sphere.centre[2] + np.sqrt(sphere.radius**2 - away**2) - heights[base]
    share = (heights[base:] - heights[base]) / (heights[-1] - heights[base])
    points[base * count :, 2] = (heights[base] + share[:, None] * np.maximum(rise, 0.0)).ravel()
    rim = on_or_beyond_circles(layout, foot.points, radius)
    node[base:, rim] = node[base, rim]
    return points, node


def _facets(
    layout: ArrayLayout, points: Floats, tets: Ints, region: Ints, names: tuple[str, ...], planes: Planes
) -> dict[str, Ints]:
    """Facets of the mesh by name, as in mesh.types.TetMesh.

    The dot can touch what faces up of medium 1 and of effectors that are layers, and the whole skin of other effectors.
    Walls in gaps are sides where the grid holds the layer, else they bear no name.
    """
    owner, face = boundary_faces(tets)
    outer, part = tets[owner[:, None], TET_FACES[face]], region[owner]
    corner = points[outer[:, :3]]
    flat = np.ptp(corner[..., 2], axis=1) < PLANE_TOLERANCE_MM
    on_base = flat & (np.abs(corner[..., 2]).max(axis=1) < PLANE_TOLERANCE_MM)
    cut = (np.ptp(corner[..., 1], axis=1) < PLANE_TOLERANCE_MM) & layout.is_slice
    for axis in planes:
        cut |= (np.abs(corner[..., axis]) < PLANE_TOLERANCE_MM).all(axis=1)
    result = {"contact": outer[_touchable(layout, corner, part, names, flat) & ~cut], "base": outer[on_base]}
    at_rim = _on_rim_planes(corner, layout.half_mm[: 1 if layout.is_slice else 2])
    for number, name in enumerate(names):
        held = ~flat if name in layout.array.grid_layers else at_rim
        mine = outer[held & ~cut & (part == number)]
        if len(mine):
            result[f"side-{name}"] = mine
    neighbour, film = face_neighbours(tets[:, :4]), names.index("film")
    result["film-bottom"] = facets_between_parts(tets, region, neighbour, names.index("medium2"), film)
    result["film-top"] = facets_between_parts(tets, region, neighbour, film, names.index("medium1"))
    return result


def _touchable(layout: ArrayLayout, corner: Floats, part: Ints, names: tuple[str, ...], flat: Bools) -> Bools:
    """Whether the dot can touch outer facets with these corners (k, 3, 3); shape (k,)."""
    normal_z = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])[:, 2]
    faces_up = flat & (normal_z > 0.0)
    skin = [number for number, name in enumerate(names) if name in ("medium1", "effector")]
    touchable = faces_up & np.isin(part, skin)
    effector = layout.segment.effector
    if effector is not None and effector.shape != "layer":
        touchable |= (part == names.index("effector")) & (faces_up | ~flat)
    return np.asarray(touchable)


def _on_rim_planes(corner: Floats, half_mm: Sequence[float]) -> Bools:
    """Whether facets with these corners (k, 3, 3) lie in a plane of the rim in x, or x and y; shape (k,)."""
    away = np.abs(np.abs(corner[..., : len(half_mm)]) - np.array(half_mm))
    return np.asarray((away < PLANE_TOLERANCE_MM).all(axis=1).any(axis=1))

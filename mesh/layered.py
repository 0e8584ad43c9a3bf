"""The deterministic mesher: triangulate the footprint, extrude it layer by layer, split the prisms.

A plane-strain slice: the x-z section extruded once in y and split into tetrahedra.

The symmetric start triangulation of the footprint, with the effector's foot resolved.

Newest-vertex bisection of a triangulation, with one boundary circle that new vertices are put on.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.arrays import Floats, Ints
from geometry.base import InputError
from geometry.dot import DotShape
from geometry.parameters import Segment
from mesh.build import MeshOptions
from mesh.interfaces import MeshedSection, section_with_film, structured
from mesh.outline import StackOutline, outline
from mesh.sizing import Sizing, graded_through, sizing
from mesh.tetwild import bare_stack
from mesh.types import TET_FACES, LinearMesh, Planes, boundary_faces, oriented, split_prisms, without_unused

Bools = NDArray[np.bool_]
SAME_HEIGHT_MM = 1e-9


@dataclass(frozen=True)
class Triangulation:
    """points : (n, 2); triangles : (m, 3), newest vertex first (its opposite edge is next); part : (m,)."""

    points: Floats
    triangles: Ints
    part: Ints


ORIGIN = np.zeros((1, 2))


def refine(
    start: Triangulation, size: Callable[[Floats], Floats], circle_radius: float | None, centres: Floats = ORIGIN
) -> Triangulation:
    """Bisect until the longest edge of each triangle is at most the size at its centroid.

    circle_radius : the edges between different parts are arcs of this circle about the nearest of the centres (n, 2).
    """
    current = start
    while True:
        corner = current.points[current.triangles]
        longest = np.linalg.norm(corner - np.roll(corner, 1, axis=1), axis=2).max(axis=1)
        marked = longest > size(corner.mean(axis=1)) * (1 + 1e-9)
        if not marked.any():
            return current
        current = _bisect(current, marked, circle_radius, centres)


def _bisect(old: Triangulation, marked: Bools, circle_radius: float | None, centres: Floats) -> Triangulation:
    """Cut every marked triangle at least once and close the triangulation (L. Chen, iFEM, 2009)."""
    edges, of_triangle = _edges(old.triangles)
    cut = np.zeros(len(edges), dtype=bool)
    cut[of_triangle[marked, 0]] = True
    while True:
        open_ones = cut[of_triangle].any(axis=1) & ~cut[of_triangle[:, 0]]
        if not open_ones.any():
            break
        cut[of_triangle[open_ones, 0]] = True
    points, middle = _cut_edges(old, edges, of_triangle, cut, circle_radius, centres)
    triangles, part = old.triangles, old.part
    for _ in range(2):  # the children's cut edges are edges of the old triangle, so twice is enough
        triangles, part, of_triangle = _halve(triangles, part, of_triangle, middle)
    return Triangulation(points, triangles, part)


def _edges(triangles: Ints) -> tuple[Ints, Ints]:
    """Unique edges (e, 2) and, per triangle, the edges opposite to its three vertices (m, 3)."""
    pairs = np.sort(triangles[:, [[1, 2], [2, 0], [0, 1]]], axis=2)
    edges, number = np.unique(pairs.reshape(-1, 2), axis=0, return_inverse=True)
    return edges, number.reshape(-1, 3)


def _cut_edges(
    old: Triangulation, edges: Ints, of_triangle: Ints, cut: Bools, circle_radius: float | None, centres: Floats
) -> tuple[Floats, Ints]:
    """All points with the new mid-points, and the number of each edge's mid-point (-1: not cut)."""
    middle = np.full(len(edges), -1, dtype=np.int64)
    middle[cut] = len(old.points) + np.arange(cut.sum())
    new = old.points[edges[cut]].mean(axis=1)
    if circle_radius is not None:
        low, high = np.full(len(edges), np.iinfo(np.int64).max), np.full(len(edges), -1, dtype=np.int64)
        for side in range(3):
            np.minimum.at(low, of_triangle[:, side], old.part)
            np.maximum.at(high, of_triangle[:, side], old.part)
        on_circle = (low != high)[cut]
        new[on_circle] = _onto_circle(new[on_circle], circle_radius, centres)
    return np.vstack([old.points, new]), middle


def _onto_circle(points: Floats, radius: float, centres: Floats) -> Floats:
    """Points (m, 2) moved onto the circle about the nearest centre."""
    away = points[:, None] - centres
    arm = away[np.arange(len(points)), np.linalg.norm(away, axis=2).argmin(axis=1)]
    return np.asarray(points + arm * (radius / np.linalg.norm(arm, axis=1, keepdims=True) - 1.0))


def _halve(triangles: Ints, part: Ints, of_triangle: Ints, middle: Ints) -> tuple[Ints, Ints, Ints]:
    """Cut triangles whose first edge is cut. Halves know the old edges they keep; new ones are not cut."""
    first = of_triangle[:, 0]
    new = np.where(first >= 0, middle[first], -1)
    keep, cut = new < 0, new >= 0
    a, b, c = triangles[cut].T
    _, edge_b, edge_c = of_triangle[cut].T
    none = np.full(len(a), -1, dtype=np.int64)
    left, right = np.stack([new[cut], a, b], axis=1), np.stack([new[cut], c, a], axis=1)
    left_edges, right_edges = np.stack([edge_c, none, none], axis=1), np.stack([edge_b, none, none], axis=1)
    return (
        np.vstack([triangles[keep], left, right]),
        np.concatenate([part[keep], part[cut], part[cut]]),
        np.vstack([of_triangle[keep], left_edges, right_edges]),
    )


def start_triangulation(outline: StackOutline, coarse_mm: float) -> Triangulation:
    """Triangles of about coarse_mm; part 1 inside the effector's foot, part 0 outside.

    Raises InputError when a cylinder leaves no room for triangles beside it.
    """
    round_foot = outline.shape == "cylinder"
    patch = _patch(outline) if round_foot else (outline.effector_half_x, outline.effector_half_y)
    x = _lines(outline.half_x, patch[0], coarse_mm, round_foot)
    y = _lines(outline.half_y, patch[1], coarse_mm, round_foot)
    cells = [(i, j) for j in range(len(y) - 1) for i in range(len(x) - 1)]
    if round_foot:
        cells = [c for c in cells if not _within(x, c[0], patch[0]) or not _within(y, c[1], patch[1])]
    around = ((0, 0), (1, 0), (1, 1), (0, 1))
    quads = np.array([[[x[i + di], y[j + dj]] for di, dj in around] for i, j in cells]).reshape(-1, 4, 2)
    triangles = crossed(quads)
    part = outline.inside_effector(triangles.mean(axis=1)).astype(np.int64)
    if round_foot:
        rim, disc = round_patch(patch, outline.effector_half_x)
        ring = crossed(rim)
        triangles = np.concatenate([triangles, ring, disc])
        part = np.concatenate([part, np.zeros(len(ring), dtype=np.int64), np.ones(len(disc), dtype=np.int64)])
    return joined(triangles, part)


def _patch(outline: StackOutline) -> tuple[float, float]:
    """Half sizes of the rectangle around a round foot."""
    radius = outline.effector_half_x
    room = min(outline.half_x, outline.half_y)
    if radius > 0.97 * room:
        raise InputError(
            f"segment.effector.diameter_mm = {2 * radius:g} leaves no rim for mesher layered on a footprint "
            f"of {2 * outline.half_x:g} x {2 * outline.half_y:g} mm: use mesher pytetwild"
        )
    wish = 1.3 * radius
    half_x, half_y = (half if half < 1.2 * wish else wish for half in (outline.half_x, outline.half_y))
    return half_x, half_y


def _lines(half: float, patch: float, coarse: float, round_foot: bool) -> Floats:
    """Symmetric grid lines through the edges of the patch; four cells over a patch around a round foot."""
    inner = 4 if round_foot else 2 * max(1, round(patch / coarse)) if 0 < patch < half else 0
    pieces = [np.linspace(-patch, patch, inner + 1)] if inner else []
    if inner and patch < half:
        outer = np.linspace(patch, half, 1 + max(1, round((half - patch) / coarse)))
        pieces = [-outer[:0:-1], *pieces, outer[1:]]
    elif not inner:
        pieces = [np.linspace(-half, half, 1 + 2 * max(1, round(half / coarse)))]
    return np.concatenate(pieces)


def _within(lines: Floats, cell: int, patch: float) -> bool:
    """Whether a cell of the grid lies in the patch."""
    return bool(abs(lines[cell] + lines[cell + 1]) / 2 < patch)


def crossed(quads: Floats) -> Floats:
    """Four triangles (4 k, 3, 2) of each quadrilateral (k, 4, 2), counter-clockwise, its centre first."""
    centre = quads.mean(axis=1)
    sides = [np.stack([centre, quads[:, i], quads[:, (i + 1) % 4]], axis=1) for i in range(4)]
    return np.concatenate(sides)


def round_patch(patch: tuple[float, float], radius: float) -> tuple[Floats, Floats]:
    """Quadrilaterals between circle and rectangle, and the triangles of the disc around a square core."""
    t = np.array([-1.0, -0.5, 0.0, 0.5])
    one = np.ones(4)
    unit = np.concatenate([np.stack(s, axis=1) for s in ((t, -one), (one, t), (-t, one), (-one, -t))])
    outer = unit * np.array(patch)
    circle = radius * unit / np.linalg.norm(unit, axis=1, keepdims=True)
    next_outer, next_circle = np.roll(outer, -1, axis=0), np.roll(circle, -1, axis=0)
    rim = np.stack([circle, outer, next_outer, next_circle], axis=1)
    inner, next_inner = 0.45 * radius * unit, 0.45 * radius * np.roll(unit, -1, axis=0)
    band = np.stack([inner, circle, next_circle, next_inner], axis=1)
    cell = 0.225 * radius * np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    core = np.array([cell + 0.225 * radius * np.array([i, j]) for i in range(-2, 2) for j in range(-2, 2)])
    return rim, crossed(np.concatenate([band, core]))


def joined(triangles: Floats, part: Ints) -> Triangulation:
    """Number the corners of loose triangles (m, 3, 2); corners closer than a nanometre are one."""
    flat = triangles.reshape(-1, 2)
    _, first, number = np.unique(np.round(flat * 1e6), axis=0, return_index=True, return_inverse=True)
    return Triangulation(flat[first], number.reshape(-1, 3).astype(np.int64), part)


def layered(segment: Segment, dot: DotShape, options: MeshOptions, planes: Planes = ()) -> LinearMesh:
    """Mesh a solid segment by extrusion, as far as its mirror planes. Raises InputError for a dome."""
    refuse_dome(segment)
    stack = outline(segment, planes=planes)
    field = sizing(stack, dot, options)
    foot = _triangulate(stack, field)
    heights, layer_region, names = levels(stack, field, options.film_layers)
    return _extrude(foot, heights, layer_region, names)


def refuse_dome(segment: Segment) -> None:
    """Raise InputError when the effector is a dome."""
    if segment.effector is not None and segment.effector.shape == "dome":
        raise InputError("mesh.mesher = layered cannot mesh segment.effector.shape = dome: use pytetwild")


def levels(
    stack: StackOutline, field: Sizing, film_layers: int, breaks: Iterable[float] = ()
) -> tuple[Floats, Ints, tuple[str, ...]]:
    """Heights (k + 1,), the part of each of the k layers, and the names of the parts; breaks : heights to go through
    in the media and the effector.
    """
    x, y = field.centers_mm[0] if len(field.centers_mm) else (0.0, 0.0)
    x, y = np.clip(x, -stack.half_x, stack.half_x), np.clip(y, -stack.half_y, stack.half_y)

    def size(z: Floats) -> Floats:
        under_dot = field.at(np.column_stack([np.full_like(z, x), np.full_like(z, y), z]))
        if not stack.is_slice:  # resolving the held side over the whole footprint is too dear in a solid
            return under_dot
        at_side = field.at(np.column_stack([np.full_like(z, stack.half_x), np.zeros_like(z), z]))
        return np.minimum(under_dot, at_side)

    def through(bottom: float, top: float) -> Floats:
        inside = {z for z in breaks if bottom + SAME_HEIGHT_MM < z < top - SAME_HEIGHT_MM}
        return graded_through([bottom, *sorted(inside), top], size)

    pieces = [
        ("medium2", through(0.0, stack.film_bottom)),
        ("film", np.linspace(stack.film_bottom, stack.film_top, film_layers + 1)),
        ("medium1", through(stack.film_top, stack.medium1_top)),
    ]
    if stack.shape != "none":
        pieces.append(("effector", through(stack.medium1_top, stack.top)))
    heights = np.concatenate([[0.0], *[z[1:] for _, z in pieces]])
    part = np.concatenate([np.full(len(z) - 1, i, dtype=np.int64) for i, (_, z) in enumerate(pieces)])
    return heights, part, tuple(name for name, _ in pieces)


def _triangulate(stack: StackOutline, field: Sizing) -> Triangulation:
    """The footprint, as fine at each place as the finest of skin and film above it."""

    def size(xy: Floats) -> Floats:
        at = [np.column_stack([xy, np.full(len(xy), z)]) for z in (stack.film_top, stack.top)]
        return 1.6 * np.minimum(field.at(at[0]), field.at(at[1]))  # right triangles: hypotenuse to mean edge

    start = beside_planes(start_triangulation(stack, field.coarse_mm), stack.planes)
    return refine(start, size, stack.effector_half_x if stack.shape == "cylinder" else None)


def beside_planes(start: Triangulation, planes: Planes) -> Triangulation:
    """The triangles on the positive side of every plane: the start and what bisection makes of it are symmetric."""
    middle = start.points[start.triangles].mean(axis=1)
    kept = (middle[:, list(planes)] > 0.0).all(axis=1)
    used, number = np.unique(start.triangles[kept], return_inverse=True)
    return Triangulation(start.points[used], number.reshape(-1, 3).astype(np.int64), start.part[kept])


def _extrude(foot: Triangulation, heights: Floats, layer_region: Ints, names: tuple[str, ...]) -> LinearMesh:
    """All prisms of all layers; the effector stands only on the triangles of its foot."""
    count = len(foot.points)
    points = np.column_stack([np.tile(foot.points, (len(heights), 1)), np.repeat(heights, count)])
    tets, region = [], []
    for layer, part in enumerate(layer_region):
        base = foot.triangles[foot.part == 1] if names[part] == "effector" else foot.triangles
        tets.append(split_prisms(base + layer * count, base + (layer + 1) * count))
        region.append(np.full(len(tets[-1]), part, dtype=np.int64))
    all_tets = np.concatenate(tets)
    return without_unused(LinearMesh(points, oriented(points, all_tets), np.concatenate(region), names))


SLAB = 2.0  # thickness of the slab that pytetwild meshes against that of the slice


def layered_slice(segment: Segment, dot: DotShape, options: MeshOptions, planes: Planes = ()) -> LinearMesh:
    """The slice from a structured graded section; its thickness is the contact element size."""
    refuse_dome(segment)
    thickness_mm = options.contact_element_size_mm
    stack = outline(segment, slice_mm=thickness_mm, planes=planes)
    field = sizing(stack, dot, options)
    return extruded(structured(stack, field, *levels(stack, field, options.film_layers)), thickness_mm)


def tetwild_slice(segment: Segment, dot: DotShape, options: MeshOptions, planes: Planes = ()) -> LinearMesh:
    """The slice from an unstructured section: the y face of a slab that pytetwild has meshed."""
    thickness_mm = options.contact_element_size_mm
    stack = outline(segment, film_thickness_mm=0.0, slice_mm=SLAB * thickness_mm, planes=planes)
    bare = y_face(bare_stack(segment, stack, dot, options), stack)
    section = section_with_film(bare, segment.film.thickness_um * 1e-3, options.film_layers)
    return extruded(section, thickness_mm)


def y_face(slab: LinearMesh, stack: StackOutline) -> MeshedSection:
    """The triangulation of a slab's face at the smallest y."""
    owner, face = boundary_faces(slab.tets)
    facets = slab.tets[owner[:, None], TET_FACES[face, :3]]
    chosen = (np.abs(slab.points_mm[facets, 1] + stack.half_y) < 1e-9).all(axis=1)
    used, number = np.unique(facets[chosen], return_inverse=True)
    region = slab.region[owner[chosen]]
    triangles = number.reshape(-1, 3).astype(np.int64)
    return MeshedSection(slab.points_mm[used][:, [0, 2]], triangles, region, slab.region_names)


def extruded(section: MeshedSection, thickness_mm: float) -> LinearMesh:
    """One layer of prisms from y = -thickness/2 to +thickness/2, each split into three tetrahedra."""
    count = len(section.points_mm)
    x, z = np.tile(section.points_mm, (2, 1)).T
    points = np.column_stack([x, np.repeat([-thickness_mm / 2, thickness_mm / 2], count), z])
    tets = split_prisms(section.triangles, section.triangles + count)
    region = np.repeat(section.region, 3)
    return without_unused(LinearMesh(points, oriented(points, tets), region, section.region_names))


def twins(points_mm: Floats) -> Ints:
    """For each node (n, 3) the lowest node of equal x and z, shape (n,)."""
    _, first, number = np.unique(np.round(points_mm[:, [0, 2]] * 1e7), axis=0, return_index=True, return_inverse=True)
    return np.asarray(first[number.ravel()], dtype=np.int64)

"""The default mesher: pytetwild (fTetWild) on the merged surfaces of the parts, snapped to their exact surfaces."""

import logging
from collections.abc import Iterator
from typing import Any

import numpy as np

from foundation.arrays import Floats, Ints
from geometry.dot import DotShape
from geometry.parameters import Segment
from geometry.stack import layers
from geometry.triangulation import triangulated
from mesh.film_layers import mesh_with_film
from mesh.options import MeshOptions
from mesh.outline import StackOutline, curved_surface, stack_outline
from mesh.sizing import background_mesh, sizing_field
from mesh.tetwild_process import tetrahedralize
from mesh.types import (
    TET_FACES,
    LinearMesh,
    MeshingError,
    Planes,
    face_neighbours,
    orient_tets,
    shape_quality,
    without_unused,
)

LEAST_DEFLECTION_MM = 2e-3  # nodes are put on the exact surface afterwards
DEFLECTION_SHARE = 0.02  # of the smallest detail, where that is more
FACET_TURN_RAD = 0.5  # of neighbouring facets


def merged_surface(segment: Segment, stack: StackOutline, detail_mm: float) -> tuple[Floats, Ints]:
    """Vertices (n, 3) and faces (m, 3) of all parts; equal vertices are merged, double and flat faces dropped.

    detail_mm : size of the smallest elements or parts; round surfaces get facets that suit it.
    """
    deflection = max(LEAST_DEFLECTION_MM, DEFLECTION_SHARE * detail_mm)
    surfaces = _solid_surfaces(segment, stack, deflection) if stack.is_round else _box_surfaces(stack)
    vertices, faces, count = [], [], 0
    for points, triangles in surfaces:
        vertices.append(points)
        faces.append(triangles + count)
        count += len(points)
    return _merge_vertices(np.concatenate(vertices), np.concatenate(faces))


def _merge_vertices(vertices: Floats, faces: Ints) -> tuple[Floats, Ints]:
    """Merge vertices closer than a nanometre; drop faces that are degenerate or repeated."""
    _, first, number = np.unique(np.round(vertices * 1e6), axis=0, return_index=True, return_inverse=True)
    points, triangles = vertices[first], number.ravel()[faces]
    corner = points[triangles]
    area = np.linalg.norm(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1) / 2
    triangles = triangles[area > 1e-12]
    _, kept = np.unique(np.sort(triangles, axis=1), axis=0, return_index=True)
    return points, triangles[np.sort(kept)]


UNIT_BOX_CORNERS = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)])
BOX_TRIANGLES = np.array(
    [[0, 3, 1], [0, 2, 3], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4],
     [2, 7, 3], [2, 6, 7], [0, 6, 2], [0, 4, 6], [1, 3, 7], [1, 7, 5]]
)  # fmt: skip
"""Triangles of a box; lid and base are cut along the same diagonal, so that those of two boxes coincide."""


def _box_surfaces(stack: StackOutline) -> Iterator[tuple[Floats, Ints]]:
    """Corners (8, 3) and triangles (12, 3) of the parts of a stack without its film, none of which is round."""
    foot = stack.half_x, stack.half_y
    parts = [(*foot, 0.0, stack.film_bottom), (*foot, stack.film_top, stack.medium1_top)]
    if stack.shape != "none":
        half_y = stack.half_y if stack.is_slice else stack.effector_half_y
        parts.append((stack.effector_half_x, half_y, stack.medium1_top, stack.top))
    for half_x, half_y, bottom, top in parts:
        low = np.array([max(-half_x, stack.low[0]), max(-half_y, stack.low[1]), bottom])
        yield low + UNIT_BOX_CORNERS * (np.array([half_x, half_y, top]) - low), BOX_TRIANGLES


def _solid_surfaces(segment: Segment, stack: StackOutline, deflection_mm: float) -> Iterator[tuple[Floats, Ints]]:
    """Points and triangles of the exact solids of a stack without its film."""
    from geometry.solids import layer_solids

    whole = _dome_slab(stack) if stack.is_slice else list(layer_solids(segment, film_thickness_mm=0.0).values())
    for solid in whole:
        cut = _cut_at_planes(solid, stack) if stack.planes else solid
        yield triangulated(cut, deflection_mm, FACET_TURN_RAD)


def _cut_at_planes(solid: Any, stack: StackOutline) -> Any:
    """The part of a solid on the positive sides of the mirror planes."""
    from build123d import Box, Pos

    (x, y), beyond = stack.low, 1.0
    size = stack.half_x - x + beyond, stack.half_y - y + beyond, stack.top + 2 * beyond
    at = x if 0 in stack.planes else x - beyond / 2, y if 1 in stack.planes else y - beyond / 2, -beyond
    return (Pos(*(low + length / 2 for low, length in zip(at, size, strict=True))) * Box(*size)) & solid


def _dome_slab(stack: StackOutline) -> list[Any]:
    """The x-z section under a dome as a slab, in which the dome is a circular segment along y."""
    from build123d import Box, Cylinder, Pos, Rot

    def box(half_x: float, low: float, high: float) -> Any:
        return Pos(0, 0, (low + high) / 2) * Box(2 * half_x, 2 * stack.half_y, high - low)

    ridge = Rot(90, 0, 0) * Cylinder(stack.dome_radius, 2 * stack.half_y)
    return [
        box(stack.half_x, 0.0, stack.film_bottom),
        box(stack.half_x, stack.film_top, stack.medium1_top),
        Pos(0, 0, stack.dome_centre_z) * ridge & box(2 * stack.dome_radius, stack.medium1_top, stack.top),
    ]


EFFECTOR_REGION = 2  # its region in a stack without film


def snap_to_surfaces(points: Floats, tets: Ints, region: Ints, stack: StackOutline) -> Floats:
    """Points (n, 3) in which those of facets between different regions (or outside) lie on the exact surfaces.

    Each such facet belongs to the surface it lies nearest to; a node gets the surfaces of all its facets.
    """
    neighbour = face_neighbours(tets)
    other = np.where(neighbour >= 0, region[neighbour], -1)
    owner, face = np.nonzero(other != region[:, None])
    facets = tets[owner[:, None], TET_FACES[face, :3]]
    planes, curved = _stack_planes(stack), curved_surface(stack)
    off = np.array([np.abs(points[facets, axis] - value).max(axis=1) for axis, value in planes])
    if curved is not None:
        # The skin of a round effector is its curved surface, its lid, a slice's cut or a mirror plane, never a side.
        skin = (region[owner] == EFFECTOR_REGION) & (other[owner, face] < 0)
        own = [
            (axis, value) == (2, stack.top) or (axis == 1 and stack.is_slice) or (axis in stack.planes and value == 0.0)
            for axis, value in planes
        ]
        off[np.ix_(~np.array(own), skin)] = np.inf
        away = np.abs(curved.distance(points[facets].reshape(-1, 3))).reshape(-1, 3).max(axis=1)
        off = np.vstack([off, np.where(skin, away, np.inf)])
    nearest = np.argmin(off, axis=0)
    result = points.copy()
    if curved is not None:
        on_curved = np.unique(facets[nearest == len(planes)])
        result[on_curved] = curved.project(result[on_curved])
    for number, (axis, value) in enumerate(planes):
        result[np.unique(facets[nearest == number]), axis] = value
    if curved is not None:
        result[on_curved] = curved.project(result[on_curved])  # the rim, now in the plane of the foot
    return result


def _stack_planes(stack: StackOutline) -> list[tuple[int, float]]:
    """Axis and coordinate in mm of every plane of the stack."""
    planes = [(0, stack.low[0]), (0, stack.half_x), (1, stack.low[1]), (1, stack.half_y)]
    planes += [(2, 0.0), (2, stack.film_bottom), (2, stack.medium1_top)]
    if stack.shape in ("layer", "block", "cylinder"):
        planes.append((2, stack.top))
    if stack.shape == "block" or (stack.shape == "cylinder" and stack.is_slice):
        planes += [(0, -stack.effector_half_x), (0, stack.effector_half_x)]
    if stack.shape == "block":
        planes += [(1, -stack.effector_half_y), (1, stack.effector_half_y)]
    return [(axis, value) for axis, value in planes if axis == 2 or value >= stack.low[axis]]


STOP_ENERGY = 7.0
WEDGE_ENERGY = 60.0
SHALLOW_DOME_RATIO = 0.7  # twice the height over the radius of a dome: it then meets medium 1 at less than 40 degrees
FLAT_TET_SHAPE = 2e-3  # a tetrahedron of this shape or less counts as flat
ENVELOPE_SHARE = 1e-3  # of the diagonal: how far pytetwild may leave the surface
DETAIL_ENVELOPE_SHARE = 0.04  # the same of an element under the dot or the thinnest part, where that is more
LOG = logging.getLogger(__name__)
MOST_ATTEMPTS = 6  # pytetwild is not repeatable: another attempt gives another mesh, one in ten flat elements


def tetwild_mesh(segment: Segment, dot: DotShape, options: MeshOptions, planes: Planes = ()) -> LinearMesh:
    """Mesh a solid segment, film included, as far as its mirror planes.

    Raises MeshingError when pytetwild fails, hangs or leaves an inverted element.
    """
    stack = stack_outline(segment, film_thickness_mm=0.0, planes=planes)
    bare = mesh_without_film(segment, stack, dot, options)
    return mesh_with_film(bare, segment.film.thickness_um * 1e-3, options.film_layers)


def mesh_without_film(segment: Segment, stack: StackOutline, dot: DotShape, options: MeshOptions) -> LinearMesh:
    """The mesh of the stack without its film: regions 0 medium2, 1 medium1, 2 effector. MeshingError."""
    thicknesses_mm = (layer.thickness_mm for layer in layers(segment) if layer.name != "film")
    detail_mm = min(options.contact_element_size_mm, *thicknesses_mm)
    vertices, faces = merged_surface(segment, stack, detail_mm)
    diagonal_mm = float(np.linalg.norm(np.ptp(vertices, axis=0)))
    bg_vertices, bg_tets, bg_values = background_mesh(stack, sizing_field(stack, dot, options))
    for attempt in range(MOST_ATTEMPTS):
        points, tets = tetrahedralize(
            options.timeout_s,
            vertices=vertices,
            faces=faces,
            bg_vertices=bg_vertices,
            bg_tets=bg_tets,
            bg_values=bg_values,
            edge_length=options.element_size_mm,
            epsilon=max(ENVELOPE_SHARE, DETAIL_ENVELOPE_SHARE * detail_mm / diagonal_mm),
            stop_energy=stop_energy(stack, options) * 1.5**attempt,
            coarsen=options.coarsen,
        )
        bare = _label_tets(points, orient_tets(points, tets), stack)
        flat = int((shape_quality(bare.points_mm, bare.tets) <= FLAT_TET_SHAPE).sum())
        LOG.debug("pytetwild, attempt %d: %d tetrahedra, %d of them flat", attempt + 1, len(tets), flat)
        if not flat:
            return bare
    raise MeshingError(
        f"pytetwild left {flat} flat elements in each of {MOST_ATTEMPTS} attempts: change mesh.element_size_mm or "
        "mesh.contact_element_size_mm a little"
    )


def stop_energy(stack: StackOutline, options: MeshOptions) -> float:
    """The distortion energy at which pytetwild stops: low, but not where the shape itself has a narrow wedge.

    A flat dome meets medium 1 at a small angle, and a round foot may touch the side of the segment: there no
    element can be good, and the mesher would refine without end. Coarsening makes every element as distorted as
    this allows, and undoes the refinement.
    """
    if options.coarsen or stack.shape not in ("cylinder", "dome") or (stack.shape == "cylinder" and stack.is_slice):
        return STOP_ENERGY
    narrow = min(stack.half_x, stack.half_y) - stack.effector_half_x < options.contact_element_size_mm
    shallow = stack.shape == "dome" and 2 * (stack.top - stack.medium1_top) < SHALLOW_DOME_RATIO * stack.effector_half_x
    return WEDGE_ENERGY if (narrow and not stack.is_slice) or shallow else STOP_ENERGY


def _label_tets(points: Floats, tets: Ints, stack: StackOutline) -> LinearMesh:
    """The mesh of the tetrahedra inside the parts, labelled, with nodes on the exact surfaces."""
    region = point_regions(points[tets].mean(axis=1), stack)
    inside = region >= 0
    names = ("medium2", "medium1", "effector")[: 2 if stack.shape == "none" else 3]
    kept = without_unused(LinearMesh(points, tets[inside], region[inside], names))
    exact = snap_to_surfaces(kept.points_mm, kept.tets, kept.region, stack)
    return LinearMesh(exact, kept.tets, kept.region, kept.region_names)


def point_regions(points: Floats, stack: StackOutline) -> Ints:
    """Number of the part of each point (n, 3): 0 medium2, 1 medium1, 2 effector, -1 outside."""
    x, y, z = np.abs(points[:, 0]), np.abs(points[:, 1]), points[:, 2]
    beside = (points[:, :2] > stack.low).all(axis=1)
    foot = beside & (x < stack.half_x) & (y < stack.half_y)
    result = np.full(len(points), -1, dtype=np.int64)
    result[foot & (z > 0) & (z < stack.film_bottom)] = 0
    result[foot & (z > stack.film_top) & (z < stack.medium1_top)] = 1
    effector = beside & stack.inside_effector(points[:, :2]) & (z > stack.medium1_top) & (z < stack.top)
    if stack.shape == "dome":
        across = x if stack.is_slice else np.hypot(x, y)
        effector &= np.hypot(across, z - stack.dome_centre_z) < stack.dome_radius
    result[effector] = 2
    return result

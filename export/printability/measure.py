"""All that is measured on a part, once for all printers, with its small round bumps and dents.

The triangulated surface of a part: rays through it, chords that tell how thick it is and how wide its gaps are.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from export.printability.findings import Point
from geometry.fabrication.part import LimitName, printer_names, printer_profile

DEFLECTION_MM = 0.005
"""Largest distance of a facet from the true surface: a tenth of the thinnest layer."""
ANGULAR_DEFLECTION = 0.15
"""Largest angle between neighbouring facets, in radians."""


def surface_of(body: Any) -> Any:
    """A trimesh.Trimesh, in mm, of a build123d shape; a Trimesh is taken as it is, with merged vertices."""
    import trimesh

    if isinstance(body, trimesh.Trimesh):
        merged = body.copy()
        merged.merge_vertices()
        return merged
    points, triangles = body.tessellate(DEFLECTION_MM, ANGULAR_DEFLECTION)
    surface = trimesh.Trimesh(np.array([tuple(p) for p in points]), np.array(triangles), process=True)
    surface.update_faces(surface.nondegenerate_faces(height=1e-9))
    return surface


Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
OFF_THE_SURFACE_MM = 1e-4
"""Rays start this far from their point, so that they do not meet the facet that they leave."""


class Rays:
    """VTK's static cell locator over the triangles of a trimesh.Trimesh."""

    def __init__(self, surface: Any) -> None:
        import pyvista
        from vtkmodules.vtkCommonDataModel import vtkStaticCellLocator

        self._grid = pyvista.wrap(surface)
        self._locator = vtkStaticCellLocator()
        self._locator.SetDataSet(self._grid)
        self._locator.BuildLocator()

    def first_hits(self, points: Floats, directions: Floats, reach_mm: float) -> tuple[Floats, Ints]:
        """Distance (n,) from each point (n, 3) along its unit direction (n, 3) and the triangle met (n,).

        Infinite and -1 where nothing is met within reach_mm.
        """
        from vtkmodules.vtkCommonCore import mutable

        distance = np.full(len(points), np.inf)
        face = np.full(len(points), -1)
        # VTK writes its answer into these; its stubs know plain numbers only
        where: Any = mutable(0.0)
        cell: Any = mutable(0)
        sub: Any = mutable(0)
        at, local = [0.0] * 3, [0.0] * 3
        starts = points + OFF_THE_SURFACE_MM * directions
        ends = points + reach_mm * directions
        for k, (start, end) in enumerate(zip(starts.tolist(), ends.tolist(), strict=True)):
            if self._locator.IntersectWithLine(start, end, 1e-9, where, at, local, sub, cell):
                distance[k] = OFF_THE_SURFACE_MM + float(where) * (reach_mm - OFF_THE_SURFACE_MM)
                face[k] = int(cell)
        return distance, face


SAMPLES = 3000
"""Points spread evenly by area; the middles of as many facets join them, for places of small area."""
OPPOSITE = -np.cos(np.radians(30.0))
"""Two faces are the two sides of a wall when their normals are opposite within 30 degrees; else it is an edge."""
CROSS_DIRECTIONS = 8
"""Tried across a chord, 22.5 degrees apart: a width is found within 1 / cos(11.25 degrees) = 1.02."""


@dataclass(frozen=True)
class Chords:
    """Straight lines between two opposite faces, shortest first.

    middle_mm : (n, 3). length_mm : (n,) thickness of the wall or width of the gap.
    cross_mm : (n,) smallest width between opposite faces at right angles to the chord, through its middle: of a
        wall its smaller extent, of a round pin or hole its diameter. Infinite beyond the reach, and where the
        section through both is not closed all round, as between four posts.
    """

    middle_mm: Floats
    length_mm: Floats
    cross_mm: Floats


def inner_chords(surface: Any, reach_mm: float) -> Chords:
    """Chords through the material, up to reach_mm long."""
    return _chords(surface, -1.0, reach_mm)


def outer_chords(surface: Any, reach_mm: float) -> Chords:
    """Chords through the air between faces of the part, up to reach_mm long."""
    return _chords(surface, 1.0, reach_mm)


def _chords(surface: Any, side: float, reach_mm: float) -> Chords:
    points, faces = _samples(surface)
    directions = side * surface.face_normals[faces]
    rays = Rays(surface)
    length, met = rays.first_hits(points, directions, reach_mm)
    kept = np.flatnonzero(_opposite(surface, faces, met))
    kept = kept[np.argsort(length[kept], kind="stable")]
    middle = points[kept] + directions[kept] * length[kept, None] / 2
    return Chords(middle, length[kept], _cross(surface, rays, middle, directions[kept], reach_mm))


def _opposite(surface: Any, faces: Ints, others: Ints) -> NDArray[np.bool_]:
    """Whether two faces (n,) are opposite; never where one of them is missing, -1."""
    normals = surface.face_normals
    facing = np.einsum("ij,ij->i", normals[faces], normals[others])
    return np.asarray((faces >= 0) & (others >= 0) & (facing < OPPOSITE))


def _samples(surface: Any) -> tuple[Floats, Ints]:
    """Points (n, 3) of the surface and their faces (n,)."""
    import trimesh

    points, faces = trimesh.sample.sample_surface(surface, SAMPLES, seed=0)
    step = max(1, len(surface.faces) // SAMPLES)
    middles = np.arange(0, len(surface.faces), step)
    return np.vstack([points, surface.triangles_center[middles]]), np.concatenate([faces, middles])


def _cross(surface: Any, rays: Rays, middle: Floats, along: Floats, reach_mm: float) -> Floats:
    """See Chords.cross_mm; through each middle (n, 3) across its unit direction (n, 3)."""
    first = np.cross(along, np.eye(3)[np.argmin(np.abs(along), axis=1)])
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    second = np.cross(along, first)
    smallest, best = np.full(len(middle), np.inf), first.copy()
    for angle in np.arange(CROSS_DIRECTIONS) * np.pi / CROSS_DIRECTIONS:
        across = np.cos(angle) * first + np.sin(angle) * second
        ahead, one = rays.first_hits(middle, across, reach_mm)
        behind, other = rays.first_hits(middle, -across, reach_mm)
        width = np.where(_opposite(surface, one, other), ahead + behind, np.inf)
        best[width < smallest] = across[width < smallest]
        smallest = np.minimum(smallest, width)
    narrow = np.flatnonzero(np.isfinite(smallest))
    open_ = ~_closed(rays, middle[narrow], along[narrow], best[narrow], reach_mm)
    smallest[narrow[open_]] = np.inf
    return smallest


def _closed(rays: Rays, middle: Floats, along: Floats, across: Floats, reach_mm: float) -> NDArray[np.bool_]:
    """Whether all four diagonals between two unit directions (n, 3) meet the surface."""
    diagonals = [(a * along + b * across) / np.sqrt(2.0) for a in (1, -1) for b in (1, -1)]
    hits = [rays.first_hits(middle, diagonal, reach_mm)[1] >= 0 for diagonal in diagonals]
    return np.asarray(np.all(hits, axis=0))


def connected_labels(pairs: NDArray[np.int64], count: int) -> NDArray[np.int64]:
    """One number (count,) for each triangle, equal where a chain of the pairs (n, 2) joins them."""
    graph = coo_array((np.ones(len(pairs), dtype=bool), tuple(pairs.T)), shape=(count, count))
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.int64)


SMOOTH = np.radians(18.0)
"""Facets that meet at less belong to one face: more than inside a curved face (export/printability/measure.py),
less than at the rim of the flattest dots, 28 degrees for 0.2 mm on 1.6 mm."""
ROUND = np.radians(1.0)
"""A face whose normals spread by less is flat."""


@dataclass(frozen=True)
class Bump:
    """A curved face that stands on, or is sunk into, one flat rim.

    width_mm : smallest extent of its rim; height_mm : how far it rises over the rim, or sinks below it.
    top_mm : (x, y, z) of the point farthest from the rim.
    """

    width_mm: float
    height_mm: float
    top_mm: tuple[float, float, float]


def bumps(surface: Any) -> list[Bump]:
    """All bumps and dents of a trimesh.Trimesh."""
    found = (_bump(surface, faces) for faces in _smooth_faces(surface))
    return [bump for bump in found if bump is not None]


def _smooth_faces(surface: Any) -> list[Any]:
    """Index arrays of the triangles of each face: what sharp edges separate."""
    smooth = surface.face_adjacency[surface.face_adjacency_angles < SMOOTH]
    labels = connected_labels(smooth, len(surface.faces))
    order = np.argsort(labels, kind="stable")
    return np.split(order, np.flatnonzero(np.diff(labels[order])) + 1)


def _bump(surface: Any, faces: Any) -> Bump | None:
    """The bump of one face; None where the face is flat or its rim does not lie in a plane."""
    normals = surface.face_normals[faces]
    mean = normals.mean(axis=0)
    if np.linalg.norm(mean) < 1e-6 or (normals @ normals[0]).min() > np.cos(ROUND):
        return None
    points, rim = _points_and_rim(surface, faces)
    if len(rim) < 3:
        return None
    axes, spread = _principal_axes(rim)
    heights = (points - rim.mean(axis=0)) @ axes[2]
    # a rim that is not plane, or a face that goes on beyond its rim on both sides, is no bump
    if spread[2] > 0.02 * spread[1] or min(heights.max(), -heights.min()) > 0.02 * np.ptp(heights):
        return None
    top = points[np.argmax(np.abs(heights))]
    return Bump(float(spread[1]), float(np.ptp(heights)), (float(top[0]), float(top[1]), float(top[2])))


def _points_and_rim(surface: Any, faces: Any) -> tuple[Floats, Floats]:
    """All corners (n, 3) of some triangles, and those (m, 3) on edges that only one of them has."""
    corners = surface.faces[faces]
    edges = np.sort(corners[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    single, count = np.unique(edges, axis=0, return_counts=True)
    rim = np.unique(single[count == 1])
    return surface.vertices[np.unique(corners)], surface.vertices[rim]


def _principal_axes(points: Floats) -> tuple[Floats, Floats]:
    """Rows (3, 3): axes of decreasing extent; and the extents (3,)."""
    centred = points - points.mean(axis=0)
    axes = np.linalg.svd(centred, full_matrices=False)[2]
    return axes, np.ptp(centred @ axes.T, axis=0)


THICKNESSES: tuple[LimitName, ...] = ("wall_mm", "feature_mm", "gap_mm", "hole_mm")


@dataclass(frozen=True)
class Measured:
    """surface : trimesh.Trimesh; up : unit vector (3,) that points up on the printer.

    broken_edges : (n, 2, 3) ends of the edges that do not join exactly two triangles; with any, there is no
        inside, and walls, gaps and bumps are None.
    walls, gaps : chords through the material and through the air, as long as the largest limit of any printer.
    """

    surface: Any
    up: Floats
    broken_edges: Floats
    walls: Chords | None
    gaps: Chords | None
    bumps: list[Bump] | None


def measure(body: Any, up: Point) -> Measured:
    """Measure a build123d shape or a trimesh.Trimesh."""
    surface = surface_of(body)
    upward = np.array(up, dtype=np.float64) / np.linalg.norm(up)
    broken = _broken_edges(surface)
    if len(broken) or not surface.is_volume:
        return Measured(surface, upward, broken, None, None, None)
    reach = max(printer_profile(name)[limit] for name in printer_names() for limit in THICKNESSES)
    walls, gaps = inner_chords(surface, reach), outer_chords(surface, reach)
    return Measured(surface, upward, broken, walls, gaps, bumps(surface))


def _broken_edges(surface: Any) -> Floats:
    edges, count = np.unique(surface.edges_sorted, axis=0, return_counts=True)
    return np.asarray(surface.vertices[edges[count != 2]])

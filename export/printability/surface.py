"""The triangulated surface of a part: rays through it, chords that tell how thick it is and how wide its gaps are."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from geometry.triangulation import triangulated

DEFLECTION_MM = 0.005
"""Largest distance of a facet from the true surface: a tenth of the thinnest layer."""
ANGULAR_DEFLECTION = 0.15
"""Largest angle between neighbouring facets, in radians."""


def surface_of(body: Any) -> Any:
    """Surface of a build123d shape as trimesh.Trimesh, in mm; a Trimesh is copied with merged vertices."""
    import trimesh

    if isinstance(body, trimesh.Trimesh):
        merged = body.copy()
        merged.merge_vertices()
        return merged
    surface = trimesh.Trimesh(*triangulated(body, DEFLECTION_MM, ANGULAR_DEFLECTION), process=True)
    surface.update_faces(surface.nondegenerate_faces(height=1e-9))
    return surface


Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
RAY_START_MM = 1e-4
"""Rays start this far from their point, so that they do not meet the facet that they leave."""


class Rays:
    """Rays through the triangles of a trimesh.Trimesh, by VTK's static cell locator."""

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
        starts = points + RAY_START_MM * directions
        ends = points + reach_mm * directions
        for k, (start, end) in enumerate(zip(starts.tolist(), ends.tolist(), strict=True)):
            if self._locator.IntersectWithLine(start, end, 1e-9, where, at, local, sub, cell):
                distance[k] = RAY_START_MM + float(where) * (reach_mm - RAY_START_MM)
                face[k] = int(cell)
        return distance, face


SURFACE_SAMPLES = 3000
"""Points spread evenly by area; the middles of as many facets join them, for places of small area."""
OPPOSITE_COSINE = -np.cos(np.radians(30.0))
"""Two faces are the two sides of a wall when their normals are opposite within 30 degrees; else it is an edge."""
CROSS_DIRECTIONS = 8
"""Directions across a chord, 22.5 degrees apart: a width is found within 1 / cos(11.25 degrees) = 1.02."""


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
    return _surface_chords(surface, -1.0, reach_mm)


def outer_chords(surface: Any, reach_mm: float) -> Chords:
    """Chords through the air between faces of the part, up to reach_mm long."""
    return _surface_chords(surface, 1.0, reach_mm)


def _surface_chords(surface: Any, side: float, reach_mm: float) -> Chords:
    points, faces = _sample_points(surface)
    directions = side * surface.face_normals[faces]
    rays = Rays(surface)
    length, met = rays.first_hits(points, directions, reach_mm)
    kept = np.flatnonzero(_are_opposite(surface, faces, met))
    kept = kept[np.argsort(length[kept], kind="stable")]
    middle = points[kept] + directions[kept] * length[kept, None] / 2
    return Chords(middle, length[kept], _cross_widths(surface, rays, middle, directions[kept], reach_mm))


def _are_opposite(surface: Any, faces: Ints, others: Ints) -> NDArray[np.bool_]:
    """Whether two faces (n,) are opposite; never where one of them is missing, -1."""
    normals = surface.face_normals
    facing = np.einsum("ij,ij->i", normals[faces], normals[others])
    return np.asarray((faces >= 0) & (others >= 0) & (facing < OPPOSITE_COSINE))


def _sample_points(surface: Any) -> tuple[Floats, Ints]:
    """Points (n, 3) of the surface and their faces (n,)."""
    import trimesh

    points, faces = trimesh.sample.sample_surface(surface, SURFACE_SAMPLES, seed=0)
    step = max(1, len(surface.faces) // SURFACE_SAMPLES)
    middles = np.arange(0, len(surface.faces), step)
    return np.vstack([points, surface.triangles_center[middles]]), np.concatenate([faces, middles])


def _cross_widths(surface: Any, rays: Rays, middle: Floats, along: Floats, reach_mm: float) -> Floats:
    """Smallest width (n,) through each middle (n, 3) across its unit direction (n, 3), as of Chords.cross_mm."""
    first = np.cross(along, np.eye(3)[np.argmin(np.abs(along), axis=1)])
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    second = np.cross(along, first)
    smallest, best = np.full(len(middle), np.inf), first.copy()
    for angle in np.arange(CROSS_DIRECTIONS) * np.pi / CROSS_DIRECTIONS:
        across = np.cos(angle) * first + np.sin(angle) * second
        ahead, one = rays.first_hits(middle, across, reach_mm)
        met = np.flatnonzero(one >= 0)
        behind, other = np.full(len(middle), np.inf), np.full(len(middle), -1)
        behind[met], other[met] = rays.first_hits(middle[met], -across[met], reach_mm)
        width = np.where(_are_opposite(surface, one, other), ahead + behind, np.inf)
        best[width < smallest] = across[width < smallest]
        smallest = np.minimum(smallest, width)
    narrow = np.flatnonzero(np.isfinite(smallest))
    open_ = ~_is_closed(rays, middle[narrow], along[narrow], best[narrow], reach_mm)
    smallest[narrow[open_]] = np.inf
    return smallest


def _is_closed(rays: Rays, middle: Floats, along: Floats, across: Floats, reach_mm: float) -> NDArray[np.bool_]:
    """Whether all four diagonals between two unit directions (n, 3) meet the surface, for each middle (n, 3)."""
    diagonals = [(a * along + b * across) / np.sqrt(2.0) for a in (1, -1) for b in (1, -1)]
    hits = [rays.first_hits(middle, diagonal, reach_mm)[1] >= 0 for diagonal in diagonals]
    return np.asarray(np.all(hits, axis=0))


def connected_labels(pairs: NDArray[np.int64], count: int) -> NDArray[np.int64]:
    """One number (count,) for each triangle, equal where a chain of the pairs (n, 2) joins them."""
    graph = coo_array((np.ones(len(pairs), dtype=bool), tuple(pairs.T)), shape=(count, count))
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.int64)

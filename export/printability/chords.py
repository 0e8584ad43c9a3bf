"""How thick a part is, and how wide its gaps are: chords from sampled points of the surface."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from export.printability.rays import Floats, Ints, Rays

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

"""The film put between medium 2 and medium 1: their interface is extruded, in a solid or in the section of a slice."""

import numpy as np
from numpy.typing import NDArray

from foundation.arrays import Floats, Ints
from mesh.section import MeshedSection
from mesh.types import TET_FACES, LinearMesh, face_neighbours, orient_tets, split_prisms

PART_NAMES = ("medium2", "film", "medium1", "effector")


def mesh_with_film(bare: LinearMesh, thickness_mm: float, film_layers: int) -> LinearMesh:
    """The mesh of medium2, medium1 (and effector) with the film's layers extruded from the interface."""
    neighbour = face_neighbours(bare.tets)
    lower = bare.region == 0
    owner, face = np.nonzero(lower[:, None] & (neighbour >= 0) & (bare.region[neighbour] == 1))
    facets = bare.tets[owner[:, None], TET_FACES[face, :3]]
    points, levels, moved = _film_levels(bare.points_mm, bare.tets, lower, np.unique(facets), thickness_mm, film_layers)
    prisms = [split_prisms(levels[i][facets], levels[i + 1][facets]) for i in range(film_layers)]
    tets = np.concatenate([np.where(lower[:, None], bare.tets, moved[bare.tets]), *prisms])
    region = _regions_with_film(bare.region, 3 * len(facets) * film_layers)
    return LinearMesh(points, orient_tets(points, tets), region, _part_names(bare.region))


def section_with_film(bare: MeshedSection, thickness_mm: float, film_layers: int) -> MeshedSection:
    """The section of a slice with the film between medium 2 and medium 1.

    Interface edges of the x-z section become rectangles, cut in two, mirrored at x = 0.
    """
    lower = bare.region == 0
    edges = _interface_edges(bare)
    points, levels, moved = _film_levels(
        bare.points_mm, bare.triangles, lower, np.unique(edges), thickness_mm, film_layers
    )
    cells = []
    for i in range(film_layers):
        (a, b), (d, c) = levels[i][edges].T, levels[i + 1][edges].T
        rising = (bare.points_mm[edges, 0].sum(axis=1) > 0)[:, None, None]
        one = np.stack([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)], axis=1)
        other = np.stack([np.stack([a, b, d], axis=1), np.stack([b, c, d], axis=1)], axis=1)
        cells.append(np.where(rising, one, other).reshape(-1, 3))
    triangles = np.concatenate([np.where(lower[:, None], bare.triangles, moved[bare.triangles]), *cells])
    region = _regions_with_film(bare.region, 2 * len(edges) * film_layers)
    return MeshedSection(points, triangles, region, _part_names(bare.region))


def _film_levels(
    points: Floats, cells: Ints, lower: NDArray[np.bool_], interface: Ints, thickness: float, film_layers: int
) -> tuple[Floats, list[Ints], Ints]:
    """Points with the film's nodes, node numbers (n,) on each of its levels, and those above the film (n,)."""
    above = np.setdiff1d(np.unique(cells[~lower]), interface)
    result = points.copy()
    result[above, -1] += thickness
    same = np.arange(len(points), dtype=np.int64)
    levels, added = [same], [result]
    for i in range(1, film_layers + 1):
        level = same.copy()
        level[interface] = len(points) + (i - 1) * len(interface) + np.arange(len(interface))
        copy = points[interface].copy()
        copy[:, -1] += thickness * i / film_layers
        levels.append(level)
        added.append(copy)
    return np.concatenate(added), levels, levels[-1]


def _interface_edges(bare: MeshedSection) -> Ints:
    """Edges (k, 2) between medium 2 and medium 1, from smaller to larger x."""
    pairs = np.sort(bare.triangles[:, [[0, 1], [1, 2], [2, 0]]], axis=2)
    low = np.unique(pairs[bare.region == 0].reshape(-1, 2), axis=0)
    high = np.unique(pairs[bare.region == 1].reshape(-1, 2), axis=0)
    both, count = np.unique(np.concatenate([low, high]), axis=0, return_counts=True)
    edges = both[count == 2]
    x = bare.points_mm[edges, 0]
    return np.take_along_axis(edges, np.argsort(x, axis=1), axis=1)


def _regions_with_film(bare: Ints, added: int) -> Ints:
    """Regions with the film as number 1."""
    return np.concatenate([np.where(bare > 0, bare + 1, 0), np.full(added, 1, dtype=np.int64)])


def _part_names(bare: Ints) -> tuple[str, ...]:
    """Names of the parts once the film is in."""
    return PART_NAMES[: int(bare.max()) + 2]

"""Named quadratic triangles of a quadratic mesh."""

import numpy as np
from numpy.typing import NDArray

from mesh.outline import Outline
from mesh.topology import TET_FACES, face_neighbours
from mesh.types import Floats, Ints

TOLERANCE_MM = 1e-6


def named_facets(
    points_mm: Floats, tets: Ints, region: Ints, names: tuple[str, ...], stack: Outline
) -> dict[str, Ints]:
    """The facets of mesh.types.TetMesh by name, each (k, 6)."""
    neighbour = face_neighbours(tets[:, :4])
    facets = _outer_facets(points_mm, tets, region, names, stack, neighbour)
    if "film" in names:
        film = names.index("film")
        facets["film-bottom"] = _between(tets, region, neighbour, names.index("medium2"), film)
        facets["film-top"] = _between(tets, region, neighbour, film, names.index("medium1"))
    return facets


def _outer_facets(
    points: Floats, tets: Ints, region: Ints, names: tuple[str, ...], stack: Outline, neighbour: Ints
) -> dict[str, Ints]:
    """Base, sides of each region and the contact skin."""
    owner, face = np.nonzero(neighbour < 0)
    outer = tets[owner[:, None], TET_FACES[face]]
    corner = points[outer[:, :3]]
    on_base = _on_plane(corner[..., 2], 0.0)
    on_x, on_y = _on_either(corner[..., 0], stack.half_x), _on_either(corner[..., 1], stack.half_y)
    on_side = on_x if stack.is_slice else on_x | on_y
    cut = on_y & stack.is_slice
    result = {"contact": outer[~(on_base | on_side | cut)], "base": outer[on_base]}
    for number, name in enumerate(names):
        mine = outer[on_side & ~on_base & (region[owner] == number)]
        if len(mine):
            result[f"side-{name}"] = mine
    return result


def _on_plane(coordinate: Floats, value: float) -> NDArray[np.bool_]:
    """Facets (k, 3) whose three corners have this coordinate."""
    return np.asarray((np.abs(coordinate - value) < TOLERANCE_MM).all(axis=1))


def _on_either(coordinate: Floats, half: float) -> NDArray[np.bool_]:
    """Facets (k, 3) in the plane at plus or at minus half."""
    return np.asarray(_on_plane(coordinate, half) | _on_plane(coordinate, -half))


def _between(tets: Ints, region: Ints, neighbour: Ints, lower: int, upper: int) -> Ints:
    """Facets from one part to the next above it, normal up."""
    other = np.where(neighbour >= 0, region[neighbour], -1)
    owner, face = np.nonzero((region[:, None] == lower) & (other == upper))
    return np.asarray(tets[owner[:, None], TET_FACES[face]])

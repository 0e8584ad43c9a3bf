"""Put the film between medium 2 and medium 1: extrude their interface, in a solid or in the section of a slice."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry.arrays import Floats, Ints
from mesh.outline import StackOutline
from mesh.sizing import Sizing, graded_through
from mesh.types import TET_FACES, LinearMesh, face_neighbours, oriented, split_prisms


@dataclass(frozen=True)
class MeshedSection:
    """points_mm : (n, 2) x and z; triangles : (m, 3); region : (m,) index into region_names."""

    points_mm: Floats
    triangles: Ints
    region: Ints
    region_names: tuple[str, ...]


def structured(
    stack: StackOutline, field: Sizing, heights: Floats, layer_region: Ints, names: tuple[str, ...]
) -> MeshedSection:
    """A graded grid of x columns and z layers, every rectangle cut by a diagonal that mirrors about x = 0."""
    x = _columns(stack, field)
    points = np.column_stack([np.tile(x, len(heights)), np.repeat(heights, len(x))])
    layer, column = np.divmod(np.arange((len(x) - 1) * (len(heights) - 1)), len(x) - 1)
    middle = (x[column] + x[column + 1]) / 2
    kept = (layer_region[layer] < 3) | (np.abs(middle) < stack.effector_half_x)
    column, layer, middle = column[kept], layer[kept], middle[kept]
    a = layer * len(x) + column
    b, c, d = a + 1, a + 1 + len(x), a + len(x)
    rising = (middle > 0)[:, None, None]
    one = np.stack([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)], axis=1)
    other = np.stack([np.stack([a, b, d], axis=1), np.stack([b, c, d], axis=1)], axis=1)
    triangles = np.where(rising, one, other).reshape(-1, 3)
    return MeshedSection(points, triangles, np.repeat(layer_region[layer], 2), names)


def _columns(stack: StackOutline, field: Sizing) -> Floats:
    """x lines through the sides of the effector, as fine as the finest of skin and film at each x."""

    def size(x: Floats) -> Floats:
        at = [np.column_stack([x, np.zeros_like(x), np.full_like(x, z)]) for z in (stack.film_top, stack.top)]
        return np.minimum(field.at(at[0]), field.at(at[1]))

    half, foot = stack.half_x, stack.effector_half_x
    breaks = [-half, 0.0, half]
    if 0.0 < foot < half * (1 - 1e-9):
        breaks = [-half, -foot, 0.0, foot, half]
    return graded_through(breaks, size)


NAMES = ("medium2", "film", "medium1", "effector")


def with_film(bare: LinearMesh, thickness_mm: float, film_layers: int) -> LinearMesh:
    """A mesh of medium2, medium1 (and effector) with the film's layers extruded from the interface."""
    neighbour = face_neighbours(bare.tets)
    lower = bare.region == 0
    owner, face = np.nonzero(lower[:, None] & (neighbour >= 0) & (bare.region[neighbour] == 1))
    facets = bare.tets[owner[:, None], TET_FACES[face, :3]]
    points, levels, moved = _levels(bare.points_mm, bare.tets, lower, np.unique(facets), thickness_mm, film_layers)
    prisms = [split_prisms(levels[i][facets], levels[i + 1][facets]) for i in range(film_layers)]
    tets = np.concatenate([np.where(lower[:, None], bare.tets, moved[bare.tets]), *prisms])
    region = _regions(bare.region, 3 * len(facets) * film_layers)
    return LinearMesh(points, oriented(points, tets), region, _names(bare.region))


def section_with_film(bare: MeshedSection, thickness_mm: float, film_layers: int) -> MeshedSection:
    """The same in the x-z section: interface edges become rectangles cut in two, mirrored about x = 0."""
    lower = bare.region == 0
    edges = _interface_edges(bare)
    points, levels, moved = _levels(bare.points_mm, bare.triangles, lower, np.unique(edges), thickness_mm, film_layers)
    cells = []
    for i in range(film_layers):
        (a, b), (d, c) = levels[i][edges].T, levels[i + 1][edges].T
        rising = (bare.points_mm[edges, 0].sum(axis=1) > 0)[:, None, None]
        one = np.stack([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)], axis=1)
        other = np.stack([np.stack([a, b, d], axis=1), np.stack([b, c, d], axis=1)], axis=1)
        cells.append(np.where(rising, one, other).reshape(-1, 3))
    triangles = np.concatenate([np.where(lower[:, None], bare.triangles, moved[bare.triangles]), *cells])
    region = _regions(bare.region, 2 * len(edges) * film_layers)
    return MeshedSection(points, triangles, region, _names(bare.region))


def _levels(
    points: Floats, cells: Ints, lower: NDArray[np.bool_], interface: Ints, thickness: float, film_layers: int
) -> tuple[Floats, list[Ints], Ints]:
    """Raised points with the film's nodes added, node numbers on each level, and those above the film."""
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


def _regions(bare: Ints, added: int) -> Ints:
    """Regions with the film as number 1."""
    return np.concatenate([np.where(bare > 0, bare + 1, 0), np.full(added, 1, dtype=np.int64)])


def _names(bare: Ints) -> tuple[str, ...]:
    """Names of the parts once the film is in."""
    return NAMES[: int(bare.max()) + 2]

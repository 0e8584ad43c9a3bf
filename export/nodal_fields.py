"""Element values spread to nodes part by part (smooth inside a part, with jumps between parts), and curved cells cut
into small linear ones to be drawn. Units are those that results are shown in.
"""

import functools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from geometry.arrays import Floats, Ints
from mesh.types import TetMesh


@dataclass(frozen=True)
class SplitNodes:
    """Nodes doubled where parts meet.

    node : (s,) the mesh node of each split node; region : (s,) its part.
    tets : (m, 10) the tetrahedra in split nodes; weight : (m,) their volumes.
    """

    node: Ints
    region: Ints
    tets: Ints
    weight: Floats


def split_nodes(tet_mesh: TetMesh) -> SplitNodes:
    """Give each part its own copy of the nodes it shares with others."""
    parts = len(tet_mesh.region_names)
    keys, inverse = np.unique(tet_mesh.tets * parts + tet_mesh.region[:, None], return_inverse=True)
    return SplitNodes(keys // parts, keys % parts, inverse.reshape(tet_mesh.tets.shape), _volumes(tet_mesh))


def spread(split: SplitNodes, values: Floats) -> Floats:
    """Volume-weighted mean (s,) or (s, c) of the element values (m,) or (m, c) around each split node."""
    return _at_nodes(split.tets, split.weight, values, len(split.node))


def largest_principal(tensor: Floats) -> Floats:
    """Largest eigenvalue (k,) of symmetric tensors (k, 6) in the order 11, 22, 33, 12, 23, 13."""
    rows = np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2]])
    return np.asarray(np.linalg.eigvalsh(tensor[:, rows])[:, -1])


def film_values(tet_mesh: TetMesh, film_tets: Ints, values: Floats) -> Floats:
    """Film values (k,) as element values (m,), zero elsewhere."""
    whole = np.zeros(len(tet_mesh.tets))
    whole[film_tets] = values
    return whole


def film_at_nodes(tet_mesh: TetMesh, values: Floats) -> Floats:
    """Film values (k,) or (k, c) at the mesh's nodes: the volume-weighted mean around each, zero off the film."""
    film = tet_mesh.region_tets("film")
    return _at_nodes(tet_mesh.tets[film], _volumes(tet_mesh)[film], values, len(tet_mesh.points_mm))


def _volumes(tet_mesh: TetMesh) -> Floats:
    """Volumes (m,) of the straight tetrahedra, mm3."""
    a, b, c, d = (tet_mesh.points_mm[tet_mesh.tets[:, i]] for i in range(4))
    return np.asarray(np.abs(np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a)) / 6)


def _at_nodes(tets: Ints, weight: Floats, values: Floats, count: int) -> Floats:
    """Weighted mean at each of count nodes of values (m,) or (m, c) of the elements around it; zero without any."""
    flat, around = tets.ravel(), np.repeat(weight, tets.shape[1])
    total = np.bincount(flat, around, count)
    columns = np.repeat(values.reshape(len(values), -1), tets.shape[1], axis=0).T
    sums = np.column_stack([np.bincount(flat, around * column, count) for column in columns])
    return np.asarray((sums / np.where(total > 0.0, total, 1.0)[:, None]).reshape(count, *values.shape[1:]))


TRIANGLE_EDGES = ((0, 1), (1, 2), (2, 0))
TETRA_EDGES = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))
_TRIANGLE_CHILDREN = ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5))
_TETRA_CHILDREN = (
    (0, 4, 6, 7), (4, 1, 5, 8), (6, 5, 2, 9), (7, 8, 9, 3),
    (4, 6, 7, 8), (6, 7, 8, 9), (4, 5, 6, 8), (5, 6, 8, 9),
)  # fmt: skip


@functools.cache
def triangle_pattern(level: int) -> tuple[Floats, Ints]:
    """Weights (p, 6) of the quadratic triangle's nodes at small corners, and small triangles (4^level, 3)."""
    return _pattern(level, 3, TRIANGLE_EDGES, _TRIANGLE_CHILDREN)


@functools.cache
def tetra_pattern(level: int) -> tuple[Floats, Ints]:
    """Weights (p, 10) of the quadratic tetrahedron's nodes, and small tetrahedra (8^level, 4)."""
    return _pattern(level, 4, TETRA_EDGES, _TETRA_CHILDREN)


def _pattern(
    level: int, corners: int, edges: Sequence[tuple[int, int]], children: Sequence[tuple[int, ...]]
) -> tuple[Floats, Ints]:
    """Halve each edge ``level`` times in barycentric coordinates and evaluate the shape functions there."""
    cells = np.eye(corners)[None]
    for _ in range(level):
        mids = np.stack([cells[:, [i, j]].mean(axis=1) for i, j in edges], axis=1)
        cells = np.concatenate([cells, mids], axis=1)[:, np.array(children)].reshape(-1, corners, corners)
    points, index = np.unique(cells.reshape(-1, corners), axis=0, return_inverse=True)
    at_corners = points * (2 * points - 1)
    at_mids = np.column_stack([4 * points[:, i] * points[:, j] for i, j in edges])
    return np.hstack([at_corners, at_mids]), index.reshape(-1, corners)


MM_PER_M = 1e3
MPA_PER_PA = 1e-6
PC_PER_MM2_PER_C_PER_M2 = 1e6
"""1 C/m^2 = 1e12 pC / 1e6 mm^2."""

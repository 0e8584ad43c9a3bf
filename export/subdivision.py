"""Curved cells cut into small linear ones to be drawn."""

import functools
from collections.abc import Sequence

import numpy as np

from foundation.arrays import Floats, Ints

TRIANGLE_EDGES = ((0, 1), (1, 2), (2, 0))
TETRA_EDGES = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))
TRIANGLE_CHILDREN = ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5))
TETRA_CHILDREN = (
    (0, 4, 6, 7), (4, 1, 5, 8), (6, 5, 2, 9), (7, 8, 9, 3),
    (4, 6, 7, 8), (6, 7, 8, 9), (4, 5, 6, 8), (5, 6, 8, 9),
)  # fmt: skip


@functools.cache
def triangle_pattern(level: int) -> tuple[Floats, Ints]:
    """Weights (p, 6) of the quadratic triangle's nodes at small corners, and small triangles (4^level, 3)."""
    return _subdivision_pattern(level, 3, TRIANGLE_EDGES, TRIANGLE_CHILDREN)


@functools.cache
def tetra_pattern(level: int) -> tuple[Floats, Ints]:
    """Weights (p, 10) of the quadratic tetrahedron's nodes at small corners, and small tetrahedra (8^level, 4)."""
    return _subdivision_pattern(level, 4, TETRA_EDGES, TETRA_CHILDREN)


def _subdivision_pattern(
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

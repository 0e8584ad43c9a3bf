"""Element values averaged at nodes part by part: smooth inside a part, with jumps between parts."""

from dataclasses import dataclass

import numpy as np

from foundation.arrays import Floats, Ints
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
    """The nodes of a mesh, those that parts share doubled for each of them."""
    parts = len(tet_mesh.region_names)
    keys, inverse = np.unique(tet_mesh.tets * parts + tet_mesh.region[:, None], return_inverse=True)
    return SplitNodes(keys // parts, keys % parts, inverse.reshape(tet_mesh.tets.shape), _volumes(tet_mesh))


def nodal_means(split: SplitNodes, values: Floats) -> Floats:
    """Volume-weighted mean (s,) or (s, c) of the element values (m,) or (m, c) around each split node."""
    return _weighted_means(split.tets, split.weight, values, len(split.node))


def largest_principal(tensor: Floats) -> Floats:
    """Largest eigenvalue (k,) of symmetric tensors (k, 6) in the order 11, 22, 33, 12, 23, 13."""
    rows = np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2]])
    return np.asarray(np.linalg.eigvalsh(tensor[:, rows])[:, -1])


def film_values(tet_mesh: TetMesh, film_tets: Ints, values: Floats) -> Floats:
    """Film values (k,) as element values (m,), zero elsewhere."""
    whole = np.zeros(len(tet_mesh.tets))
    whole[film_tets] = values
    return whole


def _volumes(tet_mesh: TetMesh) -> Floats:
    """Volumes (m,) of the straight tetrahedra, mm3."""
    a, b, c, d = (tet_mesh.points_mm[tet_mesh.tets[:, i]] for i in range(4))
    return np.asarray(np.abs(np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a)) / 6)


def _weighted_means(tets: Ints, weight: Floats, values: Floats, count: int) -> Floats:
    """Weighted mean at each of count nodes of values (m,) or (m, c) of the elements around it; zero without any."""
    flat, around = tets.ravel(), np.repeat(weight, tets.shape[1])
    total = np.bincount(flat, around, count)
    columns = np.repeat(values.reshape(len(values), -1), tets.shape[1], axis=0).T
    sums = np.column_stack([np.bincount(flat, around * column, count) for column in columns])
    return np.asarray((sums / np.where(total > 0.0, total, 1.0)[:, None]).reshape(count, *values.shape[1:]))

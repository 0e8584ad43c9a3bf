"""Element values spread to nodes part by part: smooth inside a part, with jumps between parts."""

from dataclasses import dataclass

import numpy as np

from mesh.types import Floats, Ints, TetMesh


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
    a, b, c, d = (tet_mesh.points_mm[tet_mesh.tets[:, i]] for i in range(4))
    volume = np.abs(np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a)) / 6
    return SplitNodes(keys // parts, keys % parts, inverse.reshape(tet_mesh.tets.shape), volume)


def spread(split: SplitNodes, values: Floats) -> Floats:
    """Volume-weighted mean (s,) of the element values (m,) around each split node."""
    count = len(split.node)
    flat = split.tets.ravel()
    total = np.bincount(flat, np.repeat(split.weight * values, 10), count)
    return np.asarray(total / np.bincount(flat, np.repeat(split.weight, 10), count))


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
    tets = tet_mesh.tets[tet_mesh.region_tets("film")]
    a, b, c, d = (tet_mesh.points_mm[tets[:, i]] for i in range(4))
    weight = np.repeat(np.abs(np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a)), 10)
    count, flat = len(tet_mesh.points_mm), tets.ravel()
    total = np.bincount(flat, weight, count)
    columns = np.repeat(values.reshape(len(values), -1), 10, axis=0).T
    sums = np.column_stack([np.bincount(flat, weight * column, count) for column in columns])
    return np.asarray((sums / np.where(total > 0.0, total, 1.0)[:, None]).reshape(count, *values.shape[1:]))

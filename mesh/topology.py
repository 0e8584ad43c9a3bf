"""Faces, edges and neighbours of tetrahedra."""

import numpy as np
from numpy.typing import NDArray

from mesh.errors import MeshingError
from mesh.types import Ints

TET_EDGES = np.array([(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)])
# Outward faces of a positive tetrahedron in VTK's order: corners, then the mid-sides 01, 12, 20 of the face.
TET_FACES = np.array([(0, 2, 1, 6, 5, 4), (0, 1, 3, 4, 8, 7), (1, 2, 3, 5, 9, 8), (0, 3, 2, 7, 9, 6)])


def unique_edges(tets: Ints) -> tuple[Ints, Ints]:
    """Edges (e, 2), smaller node first, and the number of each tetrahedron's six edges (m, 6)."""
    pairs = np.sort(tets[:, TET_EDGES], axis=2).reshape(-1, 2)
    edges, number = np.unique(pairs, axis=0, return_inverse=True)
    return edges.astype(np.int64), number.reshape(-1, 6).astype(np.int64)


def face_neighbours(tets: Ints) -> Ints:
    """For each tetrahedron and face (m, 4) the tetrahedron on the other side, -1 outside.

    Raises MeshingError when more than two tetrahedra share a face.
    """
    corners = np.sort(tets[:, TET_FACES[:, :3]], axis=2).reshape(-1, 3)
    _, number, count = np.unique(corners, axis=0, return_inverse=True, return_counts=True)
    if count.max() > 2:
        raise MeshingError(
            "more than two tetrahedra share a face, so a part is too small to mesh: "
            "change its size or mesh.element_size_mm"
        )
    number = number.ravel()
    order = np.argsort(number, kind="stable")
    paired = np.flatnonzero(number[order][1:] == number[order][:-1])
    neighbour = np.full(len(number), -1, dtype=np.int64)
    one, other = order[paired], order[paired + 1]
    neighbour[one], neighbour[other] = other // 4, one // 4
    return neighbour.reshape(-1, 4)


def boundary_faces(tets: Ints) -> tuple[Ints, Ints]:
    """Tetrahedra (k,) and local faces (k,) on the outer boundary."""
    owner, face = np.nonzero(face_neighbours(tets[:, :4]) < 0)
    return owner.astype(np.int64), face.astype(np.int64)


def node_mask(count: int, nodes: Ints) -> NDArray[np.bool_]:
    """True for the listed nodes, shape (count,)."""
    mask = np.zeros(count, dtype=bool)
    mask[nodes] = True
    return mask

"""The mesh that passes from the mesher to solver and exporters, and the four-node tetrahedra it is made from."""

import hashlib
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from foundation.arrays import Floats, Ints

Planes = tuple[int, ...]
"""Axes of mirror planes: 0 is the plane x = 0, 1 the plane y = 0."""
UPSIDE_DOWN = [0, 2, 1, 5, 4, 3]
"""Order of the six nodes of a quadratic facet in which its normal is opposite."""


@dataclass(frozen=True)
class TetMesh:
    """One conforming mesh of quadratic tetrahedra, labelled by part.

    points_mm : (n, 3) float. Corner nodes and mid-side nodes.
    tets : (m, 10) int. VTK order of the quadratic tetrahedron (type 24):
        corners 0-3, then mid-sides of edges 01, 12, 02, 03, 13, 23. Positive volume.
    region : (m,) int. Index into region_names.
    region_names : names of the parts that exist, e.g. ("medium2", "film", "medium1", "effector").
    facets : name -> (k, 6) int. Quadratic triangles (VTK type 22: corners, then mid-sides 01, 12, 20),
        normal pointing out of the solid (for film facets: up). Names:
        "contact"  outer surface that the dot can touch (effector skin but its sides, bare top of medium 1)
        "base"     bottom of medium 2
        "side-<region>"  the x faces (and the y faces when solid) of that region, where it has one
        "film-bottom", "film-top"  the two faces of the film
    twin : (n,) int. For each node the node that stands for it: itself, except in a plane-strain slice, where
        all nodes of equal (x, z) share one, so that nothing varies over y.
    thickness_mm : thickness in y of a plane-strain slice, else width_mm.
    planes : axes, 0 for x and 1 for y, at whose zero a mirror plane ends the mesh (mesh.symmetry). No facets are named
        there.
    """

    points_mm: Floats
    tets: Ints
    region: Ints
    region_names: tuple[str, ...]
    facets: dict[str, Ints]
    twin: Ints
    thickness_mm: float
    planes: Planes = ()

    def region_tets(self, name: str) -> Ints:
        """Indices of the tetrahedra of one part, shape (k,)."""
        return np.flatnonzero(self.region == self.region_names.index(name))


class MeshingError(RuntimeError):
    """A mesh could not be made: one sentence, what happened and what to change. The command exits with 3."""


@dataclass(frozen=True)
class LinearMesh:
    """A labelled mesh of four-node tetrahedra.

    points_mm : (n, 3); tets : (m, 4), positive volume; region : (m,) index into region_names.
    """

    points_mm: Floats
    tets: Ints
    region: Ints
    region_names: tuple[str, ...]


def signed_volumes(points: Floats, tets: Ints) -> Floats:
    """Signed volumes (m,) of straight tetrahedra (m, 4)."""
    corner = points[tets]
    one, two, three = np.moveaxis(corner[:, 1:] - corner[:, :1], 1, 0)
    # No elimination, which divides by a pivot that may be too small for its inverse.
    return np.asarray(np.sum(one * np.cross(two, three), axis=1) / 6.0)


def shape_quality(points: Floats, tets: Ints) -> Floats:
    """Volume over that of the regular tetrahedron on the longest edge, 6 sqrt(2) V / l^3, shape (m,)."""
    corner = points[tets]
    longest = np.linalg.norm(corner[:, :, None] - corner[:, None], axis=3).max(axis=(1, 2))
    return np.asarray(6 * np.sqrt(2) * signed_volumes(points, tets) / longest**3)


def orient_tets(points: Floats, tets: Ints) -> Ints:
    """The tetrahedra (m, 4) renumbered so that every volume is positive."""
    result = tets.copy()
    negative = signed_volumes(points, tets) < 0
    result[negative] = result[negative][:, [0, 1, 3, 2]]
    return result


def split_prisms(lower: Ints, upper: Ints) -> Ints:
    """Split prisms into three tetrahedra each, shape (3 k, 4), not oriented, three after three.

    lower, upper : (k, 3) node numbers of corresponding corners. Every side face is cut by the diagonal from
    the lower corner of the smaller number, so that prisms sharing a face agree (J. Dompierre et al., How to
    subdivide pyramids, prisms and hexahedra into tetrahedra, 1999).
    """
    order = np.argsort(lower, axis=1)
    a, b, c = np.take_along_axis(lower, order, axis=1).T
    d, e, f = np.take_along_axis(upper, order, axis=1).T
    tets = np.stack([np.stack(t, axis=1) for t in ((a, b, c, f), (a, b, e, f), (a, d, e, f))], axis=1)
    return np.asarray(tets.reshape(-1, 4), dtype=np.int64)


def without_unused(linear: LinearMesh) -> LinearMesh:
    """The mesh without nodes that belong to no tetrahedron; the order of nodes is kept."""
    used = np.unique(linear.tets)
    number = np.full(len(linear.points_mm), -1, dtype=np.int64)
    number[used] = np.arange(len(used))
    return LinearMesh(linear.points_mm[used], number[linear.tets], linear.region, linear.region_names)


TET_EDGES = np.array([(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)])
# Outward faces of a positive tetrahedron in VTK's order: corners, then the mid-sides 01, 12, 20 of the face.
TET_FACES = np.array([(0, 2, 1, 6, 5, 4), (0, 1, 3, 4, 8, 7), (1, 2, 3, 5, 9, 8), (0, 3, 2, 7, 9, 6)])


def unique_edges(tets: Ints) -> tuple[Ints, Ints]:
    """Edges (e, 2), smaller node first, and the numbers (m, 6) of each tetrahedron's edges."""
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
    """Numbers (k,) of the tetrahedra on the outer boundary, and of their faces there (k,), as in TET_FACES."""
    owner, face = np.nonzero(face_neighbours(tets[:, :4]) < 0)
    return owner.astype(np.int64), face.astype(np.int64)


def node_mask(count: int, nodes: Ints) -> NDArray[np.bool_]:
    """True for the listed nodes, shape (count,)."""
    mask = np.zeros(count, dtype=bool)
    mask[nodes] = True
    return mask


def mesh_hash(tet_mesh: TetMesh) -> str:
    """SHA-256, in hexadecimal, of all that a mesh holds."""
    facets = sorted(tet_mesh.facets)
    told = (tet_mesh.thickness_mm, tet_mesh.region_names, tet_mesh.planes, facets)
    digest = hashlib.sha256(repr(told).encode())
    arrays = [tet_mesh.points_mm, tet_mesh.tets, tet_mesh.region, tet_mesh.twin]
    for array in [*arrays, *(tet_mesh.facets[name] for name in facets)]:
        digest.update(str(array.shape).encode() + np.ascontiguousarray(array).tobytes())
    return digest.hexdigest()

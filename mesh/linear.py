"""A mesh of four-node tetrahedra on the way to the quadratic one, and prisms split into such tetrahedra."""

from dataclasses import dataclass

import numpy as np

from mesh.types import Floats, Ints


@dataclass(frozen=True)
class LinearMesh:
    """Corner nodes only.

    points_mm : (n, 3); tets : (m, 4), positive volume; region : (m,) index into region_names.
    """

    points_mm: Floats
    tets: Ints
    region: Ints
    region_names: tuple[str, ...]


def signed_volumes(points: Floats, tets: Ints) -> Floats:
    """Signed volumes (m,) of straight tetrahedra (m, 4)."""
    corner = points[tets]
    edges = corner[:, 1:] - corner[:, :1]
    return np.asarray(np.linalg.det(edges) / 6.0)


def shape(points: Floats, tets: Ints) -> Floats:
    """Volume over that of the regular tetrahedron on the longest edge, 6 sqrt(2) V / l^3, shape (m,)."""
    corner = points[tets]
    longest = np.linalg.norm(corner[:, :, None] - corner[:, None], axis=3).max(axis=(1, 2))
    return np.asarray(6 * np.sqrt(2) * signed_volumes(points, tets) / longest**3)


def oriented(points: Floats, tets: Ints) -> Ints:
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
    """The same mesh without nodes that belong to no tetrahedron; the order of nodes is kept."""
    used = np.unique(linear.tets)
    number = np.full(len(linear.points_mm), -1, dtype=np.int64)
    number[used] = np.arange(len(used))
    return LinearMesh(linear.points_mm[used], number[linear.tets], linear.region, linear.region_names)

"""The Jacobian of curved ten-node tetrahedra at sample points."""

import numpy as np

from foundation.arrays import Floats

_RULE_COORDINATE = (5 - np.sqrt(5)) / 20


# Corners, mid-sides, centroid and the four points of the rule of degree 2, in barycentric coordinates.
SAMPLE_POINTS = np.vstack(
    [
        np.eye(4),
        [(np.eye(4)[a] + np.eye(4)[b]) / 2 for a, b in ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))],
        np.full((1, 4), 0.25),
        np.full((4, 4), _RULE_COORDINATE) + (1 - 4 * _RULE_COORDINATE) * np.eye(4),
    ]
)


_BARYCENTRIC_GRADIENTS = np.vstack([-np.ones((1, 3)), np.eye(3)])


def shape_gradients(barycentric: Floats) -> Floats:
    """Gradients (q, 10, 3) of the quadratic shape functions in the reference element at barycentric points (q, 4)."""
    lam, grad = barycentric[:, :, None], _BARYCENTRIC_GRADIENTS[None]
    corner = (4 * lam - 1) * grad
    edges = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))
    middle = np.stack([4 * (lam[:, a] * grad[:, b] + lam[:, b] * grad[:, a]) for a, b in edges], axis=1)
    return np.asarray(np.concatenate([corner, middle], axis=1))


def jacobians(nodes: Floats, barycentric: Floats = SAMPLE_POINTS) -> Floats:
    """Jacobian matrices (m, q, 3, 3), columns dx/dxi, of elements with nodes (m, 10, 3)."""
    return np.asarray(np.einsum("mni,qnj->mqij", nodes, shape_gradients(barycentric), optimize=True))


def determinants(matrices: Floats) -> Floats:
    """Determinants (...) of 3 x 3 matrices (..., 3, 3) by expansion, in less than half the time of numpy.linalg.det."""
    (a, b, c), (d, e, f), (g, h, i) = np.moveaxis(matrices, (-2, -1), (0, 1))
    return np.asarray(a * (e * i - f * h) + b * (f * g - d * i) + c * (d * h - e * g))


def smallest_determinant_ratio(nodes: Floats) -> Floats:
    """Smallest over mean Jacobian determinant of each element (m,): 1 when straight, <= 0 when inverted."""
    if not len(nodes):
        return np.zeros(0)
    determinant = np.linalg.det(jacobians(nodes))
    mean = np.abs(determinant).mean(axis=1)
    return np.asarray(determinant.min(axis=1) / mean)


def scaled_jacobians(nodes: Floats) -> Floats:
    """Smallest scaled Jacobian of each element (m,): 1 for the regular tetrahedron.

    At each sample the tetrahedron spanned by the local tangents is rated as in P. M. Knupp, Algebraic mesh
    quality metrics (2001), and the Verdict library: sqrt(2) det / largest product of three edges at a corner.
    """
    tangent = np.moveaxis(jacobians(nodes), 3, 2)
    corners = np.concatenate([np.zeros_like(tangent[:, :, :1]), tangent], axis=2)
    length = np.linalg.norm(corners[:, :, :, None] - corners[:, :, None, :], axis=4)
    products = np.stack([np.prod([length[:, :, i, j] for j in range(4) if j != i], axis=0) for i in range(4)], axis=2)
    return np.asarray((np.sqrt(2) * np.linalg.det(tangent) / products.max(axis=2)).min(axis=1))


def volumes(nodes: Floats) -> Floats:
    """Volumes (m,) of curved elements with nodes (m, 10, 3), exact by a rule of degree 3 (Keast, 5 points)."""
    points = np.vstack([np.full((1, 4), 0.25), np.full((4, 4), 1 / 6) + np.eye(4) / 3])
    weights = np.array([-4 / 5, *([9 / 20] * 4)]) / 6
    return np.asarray(np.linalg.det(jacobians(nodes, points)) @ weights)

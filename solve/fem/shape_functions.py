"""Linear and quadratic shape functions of the reference simplices, and their gradients in an undeformed element."""

import numpy as np

from foundation.arrays import Floats

TET_EDGES = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))
TRIANGLE_EDGES = ((0, 1), (1, 2), (2, 0))


def barycentric(points: Floats) -> tuple[Floats, Floats]:
    """Barycentric coordinates (q, d+1) of reference points (q, d), and their constant gradients (d+1, d)."""
    dim = points.shape[1]
    coordinates = np.column_stack([1.0 - points.sum(axis=1), points])
    gradients = np.vstack([-np.ones((1, dim)), np.eye(dim)])
    return coordinates, gradients


def linear(points: Floats) -> Floats:
    """P1 values at reference points (q, d), shape (q, d+1)."""
    return barycentric(points)[0]


def quadratic(points: Floats) -> tuple[Floats, Floats]:
    """P2 values (q, n) and reference gradients (q, n, d) at points (q, d); n = 6 or 10."""
    lam, dlam = barycentric(points)
    edges = TET_EDGES if points.shape[1] == 3 else TRIANGLE_EDGES
    corner = lam * (2.0 * lam - 1.0)
    d_corner = (4.0 * lam - 1.0)[:, :, None] * dlam
    middle = np.stack([4.0 * lam[:, a] * lam[:, b] for a, b in edges], axis=1)
    d_middle = np.stack([4.0 * (lam[:, a, None] * dlam[b] + lam[:, b, None] * dlam[a]) for a, b in edges], axis=1)
    return np.concatenate([corner, middle], axis=1), np.concatenate([d_corner, d_middle], axis=1)


def physical_gradients(corners: Floats, reference_gradients: Floats, weight: Floats) -> tuple[Floats, Floats]:
    """Gradients with respect to the undeformed position and integration weights.

    corners : (m, n, 3) nodes of each element; reference_gradients : (q, n, 3); weight : (q,).
    Returns (m, q, n, 3) and (m, q). The determinant is not checked here: the mesher refuses inverted elements.
    """
    jacobian = np.einsum("qna,mni->mqia", reference_gradients, corners, optimize=True)
    gradient = np.matmul(reference_gradients[None], np.linalg.inv(jacobian))
    return np.ascontiguousarray(gradient), np.linalg.det(jacobian) * weight

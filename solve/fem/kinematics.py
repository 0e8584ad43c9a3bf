"""Reference simplices, their quadrature and shape functions, and compiled kinematics at quadrature points.

F = 1 + du/dX, C = F^t F, J = det F (Holzapfel, Nonlinear Solid Mechanics, 2000, eqs. 2.39, 2.64, 2.51).
"""

from itertools import permutations

import numpy as np

from geometry.arrays import Floats
from solve.compiled import in_threads
from solve.materials.isochoric import I_OF, J_OF


def deformation_gradient(gradient: Floats, displacement: Floats) -> Floats:
    """F = 1 + du/dX at (m, q, n, 3) gradients and (m, n, 3) nodal displacements: (m, q, 3, 3)."""
    f = np.empty((*gradient.shape[:2], 3, 3))
    _deformation_gradient(gradient, displacement, f)
    return f


def cauchy_green(f: Floats) -> Floats:
    """C = F^t F (m q, 3, 3), points in order, of F (m, q, 3, 3)."""
    c = np.empty((f.shape[0] * f.shape[1], 3, 3))
    _cauchy_green(f.reshape(-1, 3, 3), c)
    return c


def green_lagrange(gradient: Floats, displacement: Floats) -> Floats:
    """E = (H + H^t + H^t H) / 2, H = du/dX, (m, q, 6) with engineering shears, of the arguments of F.

    Not from F^t F - 1: a stiff film at a strain near round-off would not know its stress.
    """
    strain = np.empty((*gradient.shape[:2], 6))
    _green_lagrange(gradient, displacement, strain)
    return strain


def smallest_jacobian(f: Floats) -> Floats:
    """Smallest det F of each element (m,), of F (m, q, 3, 3); not-a-number where there is one."""
    smallest = np.empty(len(f))
    _smallest_jacobian(f, smallest)
    return smallest


@in_threads()
def _deformation_gradient(start, stop, gradient, displacement, f):  # type: ignore[no-untyped-def]
    for e in range(start, stop):
        for q in range(gradient.shape[1]):
            for i in range(3):
                x, y, z = 0.0, 0.0, 0.0
                for a in range(gradient.shape[2]):
                    u = displacement[e, a, i]
                    x += u * gradient[e, q, a, 0]
                    y += u * gradient[e, q, a, 1]
                    z += u * gradient[e, q, a, 2]
                f[e, q, i, 0], f[e, q, i, 1], f[e, q, i, 2] = x, y, z
                f[e, q, i, i] += 1.0


@in_threads()
def _green_lagrange(start, stop, gradient, displacement, strain):  # type: ignore[no-untyped-def]
    h = np.empty((3, 3))
    for e in range(start, stop):
        for q in range(gradient.shape[1]):
            for i in range(3):
                for j in range(3):
                    h[i, j] = 0.0
                    for a in range(gradient.shape[2]):
                        h[i, j] += displacement[e, a, i] * gradient[e, q, a, j]
            for v in range(6):
                i, j = I_OF[v], J_OF[v]
                twice = h[i, j] + h[j, i] + h[0, i] * h[0, j] + h[1, i] * h[1, j] + h[2, i] * h[2, j]
                strain[e, q, v] = 0.5 * twice if v < 3 else twice


@in_threads()
def _cauchy_green(start, stop, f, c):  # type: ignore[no-untyped-def]
    for n in range(start, stop):
        for i in range(3):
            for j in range(3):
                c[n, i, j] = f[n, 0, i] * f[n, 0, j] + f[n, 1, i] * f[n, 1, j] + f[n, 2, i] * f[n, 2, j]


@in_threads()
def _smallest_jacobian(start, stop, f, smallest):  # type: ignore[no-untyped-def]
    for e in range(start, stop):
        low = np.inf
        for q in range(f.shape[1]):
            h = f[e, q]
            det = (
                h[0, 0] * (h[1, 1] * h[2, 2] - h[1, 2] * h[2, 1])
                - h[0, 1] * (h[1, 0] * h[2, 2] - h[1, 2] * h[2, 0])
                + h[0, 2] * (h[1, 0] * h[2, 1] - h[1, 1] * h[2, 0])
            )
            if not det >= low:  # takes not-a-number too, and keeps it
                low = det
        smallest[e] = low


def _orbit(*barycentric: float) -> Floats:
    """All distinct permutations of a barycentric point, shape (k, len)."""
    return np.array(sorted(set(permutations(barycentric))))


def tetrahedron(degree: int = 3) -> tuple[Floats, Floats]:
    """Rule for the tetrahedron: points (q, 3) and weights (q,) that sum to 1/6.

    degree 3: 8 points; degree 5: 14 points. Curved quadratic elements need at least 3.
    Sources: Witherden and Vincent, Comput. Math. Appl. 69 (2015); Walkington, CMU report (2000).
    """
    if degree <= 3:
        a, b = 0.32816330251638171, 0.10804724989842859
        orbits = [_orbit(a, a, a, 1 - 3 * a), _orbit(b, b, b, 1 - 3 * b)]
        weights = [0.13621784253708741, 0.11378215746291261]
    else:
        a, b, c = 0.31088591926330061, 0.092735250310891226, 0.045503704125649649
        orbits = [_orbit(a, a, a, 1 - 3 * a), _orbit(b, b, b, 1 - 3 * b), _orbit(c, c, 0.5 - c, 0.5 - c)]
        weights = [0.11268792571801585, 0.073493043116361950, 0.042546020777081466]
    points = np.concatenate(orbits)[:, 1:]
    weight = np.concatenate([np.full(len(o), w) for o, w in zip(orbits, weights, strict=True)])
    return np.ascontiguousarray(points), weight / weight.sum() / 6.0


def triangle() -> tuple[Floats, Floats]:
    """Rule of degree 4 for the triangle: points (6, 2) and weights (6,) that sum to 1/2.

    Source: Dunavant, Int. J. Numer. Meth. Eng. 21 (1985).
    """
    a, b = 0.44594849091596489, 0.09157621350977074
    orbits = [_orbit(a, a, 1 - 2 * a), _orbit(b, b, 1 - 2 * b)]
    weight = np.repeat([0.22338158967801147, 0.10995174365532187], 3)
    return np.ascontiguousarray(np.concatenate(orbits)[:, 1:]), weight / weight.sum() / 2.0


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

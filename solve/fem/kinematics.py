"""Compiled kinematics at quadrature points: F = 1 + du/dX, C = F^t F, J = det F, and the Green-Lagrange strain.

Holzapfel, Nonlinear Solid Mechanics, 2000, eqs. 2.39, 2.64, 2.51 and 2.69; F is of the undeformed position, and what
belongs to elements comes as (elements, points, ...).
"""

import numpy as np

from foundation.arrays import Floats
from solve.compiled import in_threads
from solve.tensors import I_OF, J_OF


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
    """Strain E = (H + H^t + H^t H) / 2, H = du/dX, (m, q, 6) with engineering shears, from gradients (m, q, n, 3) and
    nodal displacements (m, n, 3).

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

"""Compiled kinematics at quadrature points: deformation gradient, right Cauchy-Green tensor, smallest Jacobian.

F = 1 + du/dX, C = F^t F, J = det F (Holzapfel, Nonlinear Solid Mechanics, 2000, eqs. 2.39, 2.64, 2.51).
"""

import numba as nb
import numpy as np

from mesh.types import Floats


@nb.njit(parallel=True, cache=True)
def _kinematics(grad, nodal, f, c, smallest):  # type: ignore[no-untyped-def]
    for e in nb.prange(grad.shape[0]):
        low = np.inf
        for q in range(grad.shape[1]):
            h = f[e, q]
            for i in range(3):
                for j in range(3):
                    h[i, j] = 1.0 if i == j else 0.0
            for a in range(grad.shape[2]):
                x, y, z = grad[e, q, a, 0], grad[e, q, a, 1], grad[e, q, a, 2]
                for i in range(3):
                    u = nodal[e, a, i]
                    h[i, 0] += u * x
                    h[i, 1] += u * y
                    h[i, 2] += u * z
            for i in range(3):
                for j in range(3):
                    c[e, q, i, j] = h[0, i] * h[0, j] + h[1, i] * h[1, j] + h[2, i] * h[2, j]
            det = (
                h[0, 0] * (h[1, 1] * h[2, 2] - h[1, 2] * h[2, 1])
                - h[0, 1] * (h[1, 0] * h[2, 2] - h[1, 2] * h[2, 0])
                + h[0, 2] * (h[1, 0] * h[2, 1] - h[1, 1] * h[2, 0])
            )
            if not det >= low:  # also takes not-a-number
                low = det
        smallest[e] = low


def kinematics(gradient: Floats, nodal: Floats) -> tuple[Floats, Floats, Floats]:
    """F (m, q, 3, 3), C (m, q, 3, 3) and min J (m,) from gradients (m, q, n, 3) and displacements (m, n, 3)."""
    f = np.empty((*gradient.shape[:2], 3, 3))
    c, smallest = np.empty_like(f), np.empty(len(f))
    _kinematics(gradient, nodal, f, c, smallest)
    return f, c, smallest

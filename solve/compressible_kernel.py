"""Compiled element integrals of a compressible solid: quadratic displacement, no pressure unknown."""

import numba as nb
import numpy as np

from solve.element_kernels import _add_displacement_part, _strain_operator


@nb.njit(parallel=True, cache=True)
def compressible_solid(grad, weight, f, s, cc, ke, re):  # type: ignore[no-untyped-def]
    """P2 elements, unknowns (10 nodes x 3 displacements); r_u and K_uu of element_kernels.py.

    grad (m, q, 10, 3), weight (m, q), f (m, q, 3, 3), s (m, q, 6) and cc (m, q, 6, 6) the whole stress and
    tangent; ke (m, 30, 30) upper triangle and re (m, 30) are overwritten.
    """
    for e in nb.prange(grad.shape[0]):
        b, cb = np.empty((6, 30)), np.empty((6, 30))
        ke[e] = 0.0
        re[e] = 0.0
        for q in range(grad.shape[1]):
            _strain_operator(f[e, q], grad[e, q], b)
            _add_displacement_part(b, grad[e, q], s[e, q], cc[e, q], weight[e, q], cb, ke[e], re[e])

"""Compiled element integrals of the piezoelectric film: quadratic tetrahedra and the electrode's voltage."""

import numba as nb
import numpy as np

from solve.element_kernels import _add_displacement_part, _strain_operator


@nb.njit(parallel=True, cache=True)
def film_solid(grad, weight, f, stress, tangent, charge, coupling, permittivity, per_volt, ke, re):  # type: ignore[no-untyped-def]
    """P2 elements, unknowns (10 nodes x 3 displacements, then the electrode's voltage).

    grad (m, q, 10, 3), weight (m, q), f (m, q, 3, 3), stress S (m, q, 6), tangent CC (m, q, 6, 6), charge D3 (m, q),
    coupling d (6,), permittivity, per_volt = de3/dV; ke (m, 31, 31) upper triangle and re (m, 31) overwritten.
    re[30] is dh/dV, the element's share of the electrode's charge at that voltage; S = CC (E - d e3) gives
    dS/de3 = -CC d and dD3/de3 = eps - d CC d.
    """
    for e in nb.prange(grad.shape[0]):
        b, cb, cd = np.empty((6, 30)), np.empty((6, 30)), np.empty(6)
        ke[e] = 0.0
        re[e] = 0.0
        for q in range(grad.shape[1]):
            w = weight[e, q]
            dcd = 0.0
            for v in range(6):
                cd[v] = 0.0
                for k in range(6):
                    cd[v] += tangent[e, q, v, k] * coupling[k]
                dcd += coupling[v] * cd[v]
            _strain_operator(f[e, q], grad[e, q], b)
            _add_displacement_part(b, grad[e, q], stress[e, q], tangent[e, q], w, cb, ke[e], re[e])
            for col in range(30):
                x = 0.0
                for v in range(6):
                    x -= cd[v] * b[v, col]
                ke[e, col, 30] += w * per_volt * x
            re[e, 30] -= w * per_volt * charge[e, q]
            ke[e, 30, 30] += w * per_volt * per_volt * (dcd - permittivity)

"""Compiled element integrals of the piezoelectric film: quadratic tetrahedra and the electrode's voltage."""

import numpy as np

from solve.compiled import MATH, in_threads
from solve.fem.stiffness_blocks import (
    COLUMNS,
    add_weighted_rows,
    displacement_stiffness,
    first_tangent_rows,
    strain_rows,
    transpose_gradients,
)


@in_threads(MATH)
def film_solid(start, stop, grad, weight, f, stress, tangent, charge, coupling, permittivity, per_volt, ke, re):  # type: ignore[no-untyped-def]
    """P2 elements, unknowns (10 nodes x 3 displacements, then the electrode's voltage).

    grad (m, q, 10, 3), weight (m, q), f (m, q, 3, 3), stress S (m, q, 6), tangent CC (m, q, 6, 6), charge D3 (m, q),
    coupling d (6,), permittivity, per_volt = de3/dV; the upper triangle of ke (m, 31, 31) and re (m, 31) are
    overwritten. re[30] is dh/dV, the element's share of the electrode's charge at that voltage; S = CC (E - d e3) gives
    dS/de3 = -CC d and dD3/de3 = eps - d CC d.
    """
    points = grad.shape[1]
    b, cb, t = np.zeros((6, COLUMNS)), np.zeros((6, COLUMNS + 8)), np.empty((3, 3 * points, COLUMNS))
    g, k, ru, rv = np.empty((3 * points, 10)), np.empty((10, COLUMNS)), np.empty(COLUMNS), np.empty(COLUMNS)
    sw, ccw, cd = np.empty(6), np.empty((6, 6)), np.empty(6)
    for e in range(start, stop):
        ru[:] = 0.0
        rv[:] = 0.0
        charged, stiffness = 0.0, 0.0
        for q in range(points):
            gq, w = g[3 * q : 3 * q + 3], weight[e, q]
            transpose_gradients(grad[e, q], gq)
            dcd = 0.0
            for v in range(6):
                sw[v], cd[v] = w * stress[e, q, v], 0.0
                for m in range(6):
                    ccw[v, m] = w * tangent[e, q, v, m]
                    cd[v] -= per_volt * ccw[v, m] * coupling[m]
                dcd -= coupling[v] * cd[v]
            strain_rows(f[e, q], gq, b)
            first_tangent_rows(f[e, q], gq, sw, ccw, b, cb, t, 3 * q)
            add_weighted_rows(sw, b, ru)
            add_weighted_rows(cd, b, rv)
            charged -= w * per_volt * charge[e, q]
            stiffness += per_volt * (dcd - w * per_volt * permittivity)
        displacement_stiffness(g, t, k, ke[e])
        re[e, 30], ke[e, 30, 30] = charged, stiffness
        for a in range(10):
            for i in range(3):
                re[e, 3 * a + i], ke[e, 3 * a + i, 30] = ru[10 * i + a], rv[10 * i + a]

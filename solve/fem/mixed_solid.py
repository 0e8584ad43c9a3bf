"""Compiled element integrals of the mixed solid: residual and symmetric tangent of displacement and pressure.

Total Lagrangian form. With the strain operator B (6 x 3n), E' = B u':
    r_u = int B^t S,    K_uu = int B^t CC B + (grad N_a . S grad N_b) 1
The mixed solid adds p to the stress, S = S_iso + p J C^-1, and the weak form of p = K (J - 1):
    r_p = int N_p (J - 1 - p / K),    K_up = int B^t (J C^-1) N_p,    K_pp = -int N_p N_p / K
(Zienkiewicz, Taylor and Fox, The Finite Element Method for Solid and Structural Mechanics, 2014, ch. 5.)
"""

import numpy as np

from solve.compiled import MATH, in_threads, piece
from solve.fem.stiffness_blocks import (
    COLUMNS,
    add_weighted_rows,
    displacement_stiffness,
    first_tangent_rows,
    strain_rows,
    transpose_gradients,
)
from solve.tensors import I_OF, J_OF, inverse


@piece(MATH)
def _add_pressure_part(ci, pj, h, s, cc):  # type: ignore[no-untyped-def]
    """Write C^-1 as six numbers into h; add p J C^-1 to S and p J (C^-1 x C^-1 - 2 C^-1 (.) C^-1) to CC; fill
    CC below.
    """
    for v in range(6):
        h[v] = ci[I_OF[v], J_OF[v]]
    for v in range(6):
        i, j = I_OF[v], J_OF[v]
        s[v] += pj * h[v]
        for k in range(v, 6):
            m, n = I_OF[k], J_OF[k]
            cc[v, k] += pj * (h[v] * h[k] - ci[i, m] * ci[j, n] - ci[i, n] * ci[j, m])
            cc[k, v] = cc[v, k]


@piece(MATH)
def _add_pressure_rows(n, w, mismatch, bulk, ke, re):  # type: ignore[no-untyped-def]
    """Add w N_p (J - 1 - p / K) to r_p, -w N_p N_p / K to K_pp."""
    for a in range(4):
        re[30 + a] += w * n[a] * mismatch
        for d in range(a, 4):
            ke[30 + a, 30 + d] -= w * n[a] * n[d] / bulk


@in_threads(MATH)
def mixed_solid(start, stop, grad, weight, shape_p, f, pressure, bulk, s_iso, cc_iso, ke, re):  # type: ignore[no-untyped-def]
    """P2-P1 elements, unknowns (10 nodes x 3 displacements, then 4 pressures).

    grad (m, q, 10, 3), weight (m, q), shape_p (q, 4), f (m, q, 3, 3), pressure (m, 4), s_iso (m, q, 6),
    cc_iso (m, q, 6, 6) symmetric; the upper triangle of ke (m, 34, 34) and re (m, 34) are overwritten.
    """
    points = grad.shape[1]
    b, cb, t = np.zeros((6, COLUMNS)), np.zeros((6, COLUMNS + 8)), np.empty((3, 3 * points, COLUMNS))
    g, k, up, ru = np.empty((3 * points, 10)), np.empty((10, COLUMNS)), np.empty((4, COLUMNS)), np.empty(COLUMNS)
    c, ci, s, cc, h, x = np.empty((3, 3)), np.empty((3, 3)), np.empty(6), np.empty((6, 6)), np.empty(6), np.empty(6)
    for e in range(start, stop):
        up[:] = 0.0
        ru[:] = 0.0
        ke[e, 30:] = 0.0
        re[e] = 0.0
        for q in range(points):
            fq, gq, n, w = f[e, q], g[3 * q : 3 * q + 3], shape_p[q], weight[e, q]
            transpose_gradients(grad[e, q], gq)
            for i in range(3):
                for j in range(3):
                    c[i, j] = fq[0, i] * fq[0, j] + fq[1, i] * fq[1, j] + fq[2, i] * fq[2, j]
            jac = np.sqrt(inverse(c, ci))
            p = n[0] * pressure[e, 0] + n[1] * pressure[e, 1] + n[2] * pressure[e, 2] + n[3] * pressure[e, 3]
            for v in range(6):
                s[v] = w * s_iso[e, q, v]
                for m in range(v, 6):
                    cc[v, m] = w * cc_iso[e, q, v, m]
            _add_pressure_part(ci, w * p * jac, h, s, cc)
            strain_rows(fq, gq, b)
            first_tangent_rows(fq, gq, s, cc, b, cb, t, 3 * q)
            add_weighted_rows(s, b, ru)
            for a in range(4):
                for v in range(6):
                    x[v] = w * jac * n[a] * h[v]
                add_weighted_rows(x, b, up[a])
            _add_pressure_rows(n, w, jac - 1.0 - p / bulk, bulk, ke[e], re[e])
        displacement_stiffness(g, t, k, ke[e])
        for a in range(10):
            for i in range(3):
                re[e, 3 * a + i] = ru[10 * i + a]
                for d in range(4):
                    ke[e, 3 * a + i, 30 + d] = up[d, 10 * i + a]

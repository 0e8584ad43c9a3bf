"""Compiled element integrals of a compressible solid: quadratic displacement, no pressure unknown."""

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
def compressible_solid(start, stop, grad, weight, f, s, cc, ke, re):  # type: ignore[no-untyped-def]
    """P2 elements, unknowns (10 nodes x 3 displacements); r_u and K_uu as in solve.fem.mixed_solid.

    grad (m, q, 10, 3), weight (m, q), f (m, q, 3, 3), s (m, q, 6) and cc (m, q, 6, 6) the whole stress and
    tangent; the upper triangle of ke (m, 30, 30) and re (m, 30) are overwritten.
    """
    points = grad.shape[1]
    b, cb, t = np.zeros((6, COLUMNS)), np.zeros((6, COLUMNS + 8)), np.empty((3, 3 * points, COLUMNS))
    g, k, ru = np.empty((3 * points, 10)), np.empty((10, COLUMNS)), np.empty(COLUMNS)
    sw, ccw = np.empty(6), np.empty((6, 6))
    for e in range(start, stop):
        ru[:] = 0.0
        for q in range(points):
            gq = g[3 * q : 3 * q + 3]
            transpose_gradients(grad[e, q], gq)
            for v in range(6):
                sw[v] = weight[e, q] * s[e, q, v]
                for m in range(6):
                    ccw[v, m] = weight[e, q] * cc[e, q, v, m]
            strain_rows(f[e, q], gq, b)
            first_tangent_rows(f[e, q], gq, sw, ccw, b, cb, t, 3 * q)
            add_weighted_rows(sw, b, ru)
        displacement_stiffness(g, t, k, ke[e])
        for a in range(10):
            for i in range(3):
                re[e, 3 * a + i] = ru[10 * i + a]

"""Compiled element integrals: residual and symmetric tangent of the mixed solid and of the film.

Total Lagrangian form. With the strain operator B (6 x 3n), E' = B u':
    r_u = int B^t S,    K_uu = int B^t CC B + (grad N_a . S grad N_b) 1
The mixed solid adds p to the stress, S = S_iso + p J C^-1, and the weak form of p = K (J - 1):
    r_p = int N_p (J - 1 - p / K),    K_up = int B^t (J C^-1) N_p,    K_pp = -int N_p N_p / K
(Zienkiewicz, Taylor and Fox, The Finite Element Method for Solid and Structural Mechanics, 2014, ch. 5.)
"""

import numba as nb
import numpy as np

from solve.materials.isochoric import I_OF, J_OF, inverse


@nb.njit(inline="always")
def _strain_operator(f, g, b):  # type: ignore[no-untyped-def]
    """B (6, 3n) from F (3, 3) and the gradients g (n, 3)."""
    for a in range(g.shape[0]):
        for i in range(3):
            col = 3 * a + i
            for v in range(3):
                b[v, col] = f[i, v] * g[a, v]
            for v in range(3, 6):
                k, m = I_OF[v], J_OF[v]
                b[v, col] = f[i, k] * g[a, m] + f[i, m] * g[a, k]


@nb.njit(inline="always")
def _add_displacement_part(b, g, s, cc, w, cb, ke, re):  # type: ignore[no-untyped-def]
    """Add w B^t S to re and the upper triangle of w (B^t CC B + geometric part) to ke."""
    n = b.shape[1]
    for v in range(6):
        for j in range(n):
            cb[v, j] = 0.0
        for k in range(6):
            c = w * cc[v, k]
            for j in range(n):
                cb[v, j] += c * b[k, j]
        for j in range(n):
            re[j] += w * s[v] * b[v, j]
    for i in range(n):
        for v in range(6):
            x = b[v, i]
            for j in range(i, n):
                ke[i, j] += x * cb[v, j]
    for a in range(g.shape[0]):
        t0 = w * (s[0] * g[a, 0] + s[3] * g[a, 1] + s[5] * g[a, 2])
        t1 = w * (s[3] * g[a, 0] + s[1] * g[a, 1] + s[4] * g[a, 2])
        t2 = w * (s[5] * g[a, 0] + s[4] * g[a, 1] + s[2] * g[a, 2])
        for c in range(a, g.shape[0]):
            value = t0 * g[c, 0] + t1 * g[c, 1] + t2 * g[c, 2]
            for i in range(3):
                ke[3 * a + i, 3 * c + i] += value


@nb.njit(parallel=True, cache=True)
def mixed_solid(grad, weight, shape_p, f, pressure, bulk, s_iso, cc_iso, ke, re):  # type: ignore[no-untyped-def]
    """P2-P1 elements, unknowns (10 nodes x 3 displacements, then 4 pressures).

    grad (m, q, 10, 3), weight (m, q), shape_p (q, 4), f (m, q, 3, 3), pressure (m, 4), s_iso (m, q, 6),
    cc_iso (m, q, 6, 6); ke (m, 34, 34) upper triangle and re (m, 34) are overwritten.
    """
    for e in nb.prange(grad.shape[0]):
        b, cb = np.empty((6, 30)), np.empty((6, 30))
        c, ci, s, cc = np.empty((3, 3)), np.empty((3, 3)), np.empty(6), np.empty((6, 6))
        ke[e] = 0.0
        re[e] = 0.0
        for q in range(grad.shape[1]):
            fq, g, w = f[e, q], grad[e, q], weight[e, q]
            for i in range(3):
                for j in range(3):
                    c[i, j] = fq[0, i] * fq[0, j] + fq[1, i] * fq[1, j] + fq[2, i] * fq[2, j]
            jac = np.sqrt(inverse(c, ci))
            p = 0.0
            for a in range(4):
                p += shape_p[q, a] * pressure[e, a]
            for v in range(6):
                i, j = I_OF[v], J_OF[v]
                s[v] = s_iso[e, q, v] + p * jac * ci[i, j]
                for k in range(6):
                    m, n = I_OF[k], J_OF[k]
                    odot = ci[i, m] * ci[j, n] + ci[i, n] * ci[j, m]
                    cc[v, k] = cc_iso[e, q, v, k] + p * jac * (ci[i, j] * ci[m, n] - odot)
            _strain_operator(fq, g, b)
            _add_displacement_part(b, g, s, cc, w, cb, ke[e], re[e])
            for col in range(30):
                x = 0.0
                for v in range(6):
                    x += ci[I_OF[v], J_OF[v]] * b[v, col]
                x *= w * jac
                for a in range(4):
                    ke[e, col, 30 + a] += x * shape_p[q, a]
            for a in range(4):
                re[e, 30 + a] += w * shape_p[q, a] * (jac - 1.0 - p / bulk)
                for d in range(a, 4):
                    ke[e, 30 + a, 30 + d] -= w * shape_p[q, a] * shape_p[q, d] / bulk


@nb.njit(parallel=True, cache=True)
def film_solid(grad, weight, f, stiffness, coupling, permittivity, field, per_volt, ke, re):  # type: ignore[no-untyped-def]
    """Piezoelectric P2 elements, unknowns (10 nodes x 3 displacements, then the electrode's voltage).

    grad (m, q, 10, 3), weight (m, q), f (m, q, 3, 3), stiffness (6, 6), coupling (6,), permittivity,
    field (m,) electric field e3, per_volt = de3/dV; ke (m, 31, 31) upper triangle and re (m, 31) overwritten.
    re[30] is dh/dV, the element's share of the electrode's charge at that voltage.
    """
    for e in nb.prange(grad.shape[0]):
        b, cb = np.empty((6, 30)), np.empty((6, 30))
        strain, s, cd = np.empty(6), np.empty(6), np.zeros(6)
        dcd = 0.0
        for v in range(6):
            for k in range(6):
                cd[v] += stiffness[v, k] * coupling[k]
            dcd += coupling[v] * cd[v]
        ke[e] = 0.0
        re[e] = 0.0
        for q in range(grad.shape[1]):
            fq, g, w = f[e, q], grad[e, q], weight[e, q]
            for v in range(6):
                i, j = I_OF[v], J_OF[v]
                c = fq[0, i] * fq[0, j] + fq[1, i] * fq[1, j] + fq[2, i] * fq[2, j]
                strain[v] = (0.5 * (c - 1.0) if v < 3 else c) - coupling[v] * field[e]
            displacement = permittivity * field[e]
            for v in range(6):
                s[v] = 0.0
                for k in range(6):
                    s[v] += stiffness[v, k] * strain[k]
                displacement += coupling[v] * s[v]
            _strain_operator(fq, g, b)
            _add_displacement_part(b, g, s, stiffness, w, cb, ke[e], re[e])
            for col in range(30):
                x = 0.0
                for v in range(6):
                    x -= cd[v] * b[v, col]
                ke[e, col, 30] += w * per_volt * x
            re[e, 30] -= w * per_volt * displacement
            ke[e, 30, 30] += w * per_volt * per_volt * (dcd - permittivity)


@nb.njit(cache=True)
def scatter(ke, re, dofs, slots, data, residual):  # type: ignore[no-untyped-def]
    """Add element matrices (upper triangles, packed row by row in slots) and vectors; negative = fixed.

    Two local unknowns may be the same global one (a slice's twins): their pair then counts for (i, j) and (j, i).
    """
    for e in range(ke.shape[0]):
        n = 0
        for i in range(ke.shape[1]):
            if dofs[e, i] >= 0:
                residual[dofs[e, i]] += re[e, i]
            for j in range(i, ke.shape[1]):
                slot = slots[e, n]
                if slot >= 0:
                    same = i != j and dofs[e, i] == dofs[e, j]
                    data[slot] += 2.0 * ke[e, i, j] if same else ke[e, i, j]
                n += 1

"""Compiled loops over the quadrature points of an interface; the formulae are those of solve.terms.jump."""

import numpy as np

from solve.compiled import in_threads


@in_threads()
def differentiate_opening(start, stop, z, value, slope, curvature):  # type: ignore[no-untyped-def]
    """Write the opening (p,), its slope (p, 9) and curvature (p, 9, 9) by z = (d, t1, t2) (p, 9)."""
    a, n, p = np.empty(3), np.empty(3), np.empty(3)
    by_tangents, product = np.empty((3, 6)), np.empty((3, 6))
    across, by_area = np.empty((3, 3)), np.empty((3, 3))
    for point in range(start, stop):
        d, t1, t2 = z[point, :3], z[point, 3:6], z[point, 6:]
        delta = 0.0
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            a[i] = t1[j] * t2[k] - t1[k] * t2[j]
            for b in range(6):
                by_tangents[i, b] = 0.0
            by_tangents[i, j], by_tangents[i, k] = t2[k], -t2[j]  # -t2 x
            by_tangents[i, 3 + j], by_tangents[i, 3 + k] = -t1[k], t1[j]  # t1 x
        size = np.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])
        for i in range(3):
            n[i] = a[i] / size
            delta += d[i] * n[i]
        value[point] = delta
        for i in range(3):
            p[i] = (d[i] - delta * n[i]) / size
        for i in range(3):
            for j in range(3):
                across[i, j] = ((1.0 if i == j else 0.0) - n[i] * n[j]) / size
                by_area[i, j] = -(delta * across[i, j] + p[i] * n[j] + n[i] * p[j]) / size
        c, s = curvature[point], slope[point]
        for i in range(3):
            s[i] = n[i]
            for j in range(3):
                c[i, j] = 0.0
            for b in range(6):
                c[i, 3 + b] = product[i, b] = 0.0
                for k in range(3):
                    c[i, 3 + b] += across[i, k] * by_tangents[k, b]
                    product[i, b] += by_area[i, k] * by_tangents[k, b]
                c[3 + b, i] = c[i, 3 + b]
        for b in range(6):
            s[3 + b] = 0.0
            for k in range(3):
                s[3 + b] += p[k] * by_tangents[k, b]
            for e in range(6):
                c[3 + b, 3 + e] = 0.0
                for k in range(3):
                    c[3 + b, 3 + e] += by_tangents[k, b] * product[k, e]
        for i in range(3):  # p . (dt1 x dt2)
            j, k = (i + 1) % 3, (i + 2) % 3
            c[3 + j, 6 + k] += p[i]
            c[3 + k, 6 + j] -= p[i]
            c[6 + k, 3 + j] += p[i]
            c[6 + j, 3 + k] -= p[i]


@in_threads()
def integrate_tangent(start, stop, hessian, rows, area, ke):  # type: ignore[no-untyped-def]
    """Write ke (k, 3n, 3n), upper triangle: the sum over q of area (k, q) times rows (q, 3, n) on both sides of
    (k, q, 9, 9).
    """
    count = rows.shape[2]
    half = np.empty((9, 3 * count))
    for e in range(start, stop):
        ke[e] = 0.0
        for q in range(rows.shape[0]):
            for i in range(9):
                for b in range(count):
                    for j in range(3):
                        x = 0.0
                        for r in range(3):
                            x += hessian[e, q, i, 3 * r + j] * rows[q, r, b]
                        half[i, 3 * b + j] = area[e, q] * x
            for b in range(count):
                for i in range(3):
                    for r in range(3):
                        factor = rows[q, r, b]
                        for j in range(3 * b, 3 * count):
                            ke[e, 3 * b + i, j] += factor * half[3 * r + i, j]

"""Stress and tangent of laws in powers of the principal stretches: Ogden rubber and hyperfoam.

With the eigenvalues c_a and eigenvectors N_a of C, c_a = l_a^2, an isotropic W(l1, l2, l3) has
    S = sum_a S_a N_a x N_a,     S_a = W_a / c_a,    W_a = dW / d ln l_a
    CC = sum_ab (W_ab - 2 d_ab W_a) / (c_a c_b) N_a x N_a x N_b x N_b + sum_(a<b) D_ab G_ab x G_ab
with G_ab = N_a x N_b + N_b x N_a and the divided difference D_ab = (S_b - S_a) / (c_b - c_a) (Holzapfel, Nonlinear
Solid Mechanics, 2000, eq. 6.180). Both laws have W_a = g_a - t with g_a = sum k x_a, x_a = l_a^alpha:
    Ogden, isochoric:  l_a over J^(1/3), k = mu,     t = mean g,
                       W_ab = d_ab h_a - (h_a + h_b - mean h) / 3,  h_a = sum k alpha x_a
    hyperfoam:         k = 2 mu / alpha,             t = sum k J^(-alpha beta),
                       W_ab = d_ab h_a + sum k alpha beta J^(-alpha beta)
The divided difference of c^p is c_a^(p - 1) expm1(p z) / expm1(z), z = ln(c_b / c_a), which loses no digits at any
gap: equal stretches need no tolerance, only the limit p at z = 0 itself.
"""

import numpy as np

from foundation.arrays import Floats
from solve.compiled import in_threads, piece
from solve.tensors import I_OF, J_OF

PAIR_A, PAIR_B = np.array([0, 1, 0]), np.array([1, 2, 2])
MAX_SWEEPS = 12  # Jacobi's method converges at least quadratically: four or five do


@piece()
def _principal(cauchy_green, c, square, vector):  # type: ignore[no-untyped-def]
    """Eigenvalues (3,) and eigenvectors (3, 3, columns) of C, by Jacobi's method; c (3, 3) is scratch.

    Golub and Van Loan, Matrix Computations, 2013, sec. 8.5: backward stable also for equal eigenvalues.
    """
    for i in range(3):
        for j in range(3):
            c[i, j], vector[i, j] = cauchy_green[i, j], 1.0 if i == j else 0.0
    for _ in range(MAX_SWEEPS):
        diagonal = True
        for k in range(3):
            p, q = PAIR_A[k], PAIR_B[k]
            r, off, gap = 3 - p - q, c[p, q], c[q, q] - c[p, p]
            if off * off <= 1e-32 * c[p, p] * c[q, q]:
                continue
            diagonal = False
            t = (2.0 if gap >= 0.0 else -2.0) * off / (abs(gap) + np.sqrt(gap * gap + 4.0 * off * off))
            cos = 1.0 / np.sqrt(1.0 + t * t)
            sin = t * cos
            c[p, p] -= t * off
            c[q, q] += t * off
            c[p, q] = c[q, p] = 0.0
            rp, rq = c[r, p], c[r, q]
            c[r, p] = c[p, r] = cos * rp - sin * rq
            c[r, q] = c[q, r] = sin * rp + cos * rq
            for i in range(3):
                vp, vq = vector[i, p], vector[i, q]
                vector[i, p], vector[i, q] = cos * vp - sin * vq, sin * vp + cos * vq
        if diagonal:
            break
    for i in range(3):
        square[i] = c[i, i]


@piece()
def _turn_back(vector, normal, block, shear, basis, image, stress, tangent):  # type: ignore[no-untyped-def]
    """Write S (6,) and CC (6, 6) from S_a (3,), the coefficients (3, 3) of the first sum of CC and D_01, D_12, D_02."""
    for v in range(6):
        i, j = I_OF[v], J_OF[v]
        for a in range(3):
            basis[v, a] = vector[i, a] * vector[j, a]
            p, q = PAIR_A[a], PAIR_B[a]
            basis[v, 3 + a] = vector[i, p] * vector[j, q] + vector[i, q] * vector[j, p]
        stress[v] = basis[v, 0] * normal[0] + basis[v, 1] * normal[1] + basis[v, 2] * normal[2]
        for a in range(3):
            image[v, a] = basis[v, 0] * block[0, a] + basis[v, 1] * block[1, a] + basis[v, 2] * block[2, a]
            image[v, 3 + a] = basis[v, 3 + a] * shear[a]
    for v in range(6):
        for w in range(v, 6):
            x = 0.0
            for k in range(6):
                x += image[v, k] * basis[w, k]
            tangent[v, w] = tangent[w, v] = x


@piece()
def _add_divided_differences(square, p, factor, shear):  # type: ignore[no-untyped-def]
    """Add to D (3,) the divided differences of f c^p, given factor[a] = f c_a^p."""
    for k in range(3):
        a, b = PAIR_A[k], PAIR_B[k]
        gap = (square[b] - square[a]) / square[a]
        slope = p if gap == 0.0 else np.expm1(p * np.log1p(gap)) / gap
        shear[k] += factor[a] / square[a] * slope


@in_threads()
def _stress_and_tangent(start, stop, cauchy_green, k, alpha, beta, isochoric, stress, tangent):  # type: ignore[no-untyped-def]
    c, vector, block, basis, image = (
        np.empty((3, 3)),
        np.empty((3, 3)),
        np.empty((3, 3)),
        np.empty((6, 6)),
        np.empty((6, 6)),
    )
    square, log, x, g, h, shear = np.empty(3), np.empty(3), np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    for n in range(start, stop):
        _principal(cauchy_green[n], c, square, vector)
        for a in range(3):
            log[a] = 0.5 * np.log(square[a])
            g[a] = h[a] = shear[a] = 0.0
        dilation, t, t_slope = log[0] + log[1] + log[2], 0.0, 0.0
        for i in range(len(k)):
            for a in range(3):
                x[a] = k[i] * np.exp(alpha[i] * (log[a] - dilation / 3.0 if isochoric else log[a]))
                g[a] += x[a]
                h[a] += alpha[i] * x[a]
                x[a] /= square[a]
            _add_divided_differences(square, 0.5 * alpha[i] - 1.0, x, shear)
            if not isochoric:
                y = k[i] * np.exp(-alpha[i] * beta[i] * dilation)
                t += y
                t_slope += alpha[i] * beta[i] * y
        if isochoric:
            t, t_slope = (g[0] + g[1] + g[2]) / 3.0, (h[0] + h[1] + h[2]) / 9.0
        for a in range(3):
            shear[a] += t / (square[PAIR_A[a]] * square[PAIR_B[a]])
            for b in range(3):
                w = t_slope - (h[a] + h[b]) / 3.0 if isochoric else t_slope
                if a == b:
                    w += h[a] - 2.0 * (g[a] - t)
                block[a, b] = w / (square[a] * square[b])
        for a in range(3):
            g[a] = (g[a] - t) / square[a]
        _turn_back(vector, g, block, shear, basis, image, stress[n], tangent[n])


@in_threads()
def _principal_squares(start, stop, cauchy_green, squares):  # type: ignore[no-untyped-def]
    c, vector = np.empty((3, 3)), np.empty((3, 3))
    for n in range(start, stop):
        _principal(cauchy_green[n], c, squares[n], vector)


def log_stretches(cauchy_green: Floats) -> Floats:
    """Logarithms (n, 3) of the principal stretches at C (n, 3, 3), in no order."""
    squares = np.empty((len(cauchy_green), 3))
    _principal_squares(np.ascontiguousarray(cauchy_green), squares)
    logarithms: Floats = 0.5 * np.log(squares)
    return logarithms


def principal_stress(
    cauchy_green: Floats, k: Floats, alpha: Floats, beta: Floats | None = None
) -> tuple[Floats, Floats]:
    """S (n, 6) and tangent (n, 6, 6) at C (n, 3, 3) for the terms k, alpha; isochoric unless beta is given."""
    stress, tangent = np.empty((len(cauchy_green), 6)), np.empty((len(cauchy_green), 6, 6))
    c = np.ascontiguousarray(cauchy_green)  # of another layout the kernel would be compiled once more
    _stress_and_tangent(c, k, alpha, alpha if beta is None else beta, beta is None, stress, tangent)
    return stress, tangent

"""Energy, stress and tangent of laws in the isochoric invariants: a polynomial, or a power of the first (Knowles).

With A = dI1/dC = J^(-2/3) (1 - I1/3 C^-1) and B = dI2/dC = J^(-4/3) (I1 1 - C - 2/3 I2 C^-1):
    S = 2 (W1 A + W2 B),     CC = 4 (W11 A x A + W1 dA/dC + W2 dB/dC)
(Holzapfel, Nonlinear Solid Mechanics, 2000, eqs. 6.116 and 6.168 ff.) In x = I1 - 3 the slope W1 of the polynomial is
c10 + 2 c20 x + 3 c30 x^2, that of the power c10 (1 + b x / n)^(n - 1) (Knowles, Int. J. Fract. 13, 1977).
"""

import numpy as np

from foundation.arrays import Floats
from solve.compiled import in_threads, piece
from solve.tensors import I_OF, J_OF, inverse

Power = tuple[float, float]
NO_POWER: Power = (0.0, 1.0)
"""b = 0: the slope of the first invariant's linear term is constant."""


@piece()
def _power(x, b, n):  # type: ignore[no-untyped-def]
    """Power (1 + b x / n)^(n - 1), and its slope in x; exp(b x) for an infinite n."""
    if np.isinf(n):
        value = np.exp(b * x)
        return value, b * value
    base = 1.0 + b * x / n
    return base ** (n - 1.0), b * (n - 1.0) / n * base ** (n - 2.0)


@in_threads()
def _stress_and_tangent(start, stop, cauchy_green, c10, c01, c20, c30, b1, n1, stress, tangent):  # type: ignore[no-untyped-def]
    ci, a, b = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    for n in range(start, stop):
        c = cauchy_green[n]
        j23 = inverse(c, ci) ** (-1.0 / 3.0)
        trace = c[0, 0] + c[1, 1] + c[2, 2]
        square = 0.0
        for i in range(3):
            for j in range(3):
                square += c[i, j] * c[i, j]
        i1, i2 = j23 * trace, j23 * j23 * 0.5 * (trace * trace - square)
        x = i1 - 3.0
        w1 = c10 + x * (2.0 * c20 + 3.0 * c30 * x)
        w11 = 2.0 * c20 + 6.0 * c30 * x
        if b1 > 0.0:
            value, slope = _power(x, b1, n1)
            w1, w11 = w1 + c10 * (value - 1.0), w11 + c10 * slope
        for i in range(3):
            for j in range(3):
                d = 1.0 if i == j else 0.0
                a[i, j] = j23 * d - i1 / 3.0 * ci[i, j]
                b[i, j] = j23 * j23 * (trace * d - c[i, j]) - 2.0 / 3.0 * i2 * ci[i, j]
        for v in range(6):
            i, j = I_OF[v], J_OF[v]
            stress[n, v] = 2.0 * (w1 * a[i, j] + c01 * b[i, j])
            dij = 1.0 if i == j else 0.0
            for w in range(6):
                k, m = I_OF[w], J_OF[w]
                dkm = 1.0 if k == m else 0.0
                # C^-1 (.) C^-1 and the fourth-order identity, symmetrised
                odot = 0.5 * (ci[i, k] * ci[j, m] + ci[i, m] * ci[j, k])
                unit = (1.0 if v == w else 0.0) * (1.0 if v < 3 else 0.5)
                both = ci[i, j] * ci[k, m]
                da = -j23 / 3.0 * (dij * ci[k, m] + ci[i, j] * dkm) + i1 * (both / 9.0 + odot / 3.0)
                tij = j23 * j23 * (trace * dij - c[i, j])
                tkm = j23 * j23 * (trace * dkm - c[k, m])
                db = (
                    j23 * j23 * (dij * dkm - unit)
                    - 2.0 / 3.0 * (tij * ci[k, m] + ci[i, j] * tkm)
                    + i2 * (4.0 / 9.0 * both + 2.0 / 3.0 * odot)
                )
                tangent[n, v, w] = 4.0 * (w11 * a[i, j] * a[k, m] + w1 * da + c01 * db)


def isochoric_stress(cauchy_green: Floats, constants: Floats, power: Power = NO_POWER) -> tuple[Floats, Floats]:
    """S (n, 6) and tangent (n, 6, 6) at C (n, 3, 3) for the constants (c10, c01, c20, c30) and the power (b, n)."""
    stress = np.empty((len(cauchy_green), 6))
    tangent = np.empty((len(cauchy_green), 6, 6))
    c10, c01, c20, c30 = constants
    c = np.ascontiguousarray(cauchy_green)  # of another layout the kernel would be compiled once more
    _stress_and_tangent(c, c10, c01, c20, c30, *power, stress, tangent)
    return stress, tangent


def isochoric_energy(cauchy_green: Floats, constants: Floats, power: Power = NO_POWER) -> Floats:
    """W_iso (n,) at C (n, 3, 3), real or complex, for the constants (c10, c01, c20, c30) and the power (b, n)."""
    j23 = np.linalg.det(cauchy_green) ** (-1.0 / 3.0)
    trace = np.trace(cauchy_green, axis1=1, axis2=2)
    square = np.einsum("nij,nij->n", cauchy_green, cauchy_green)
    c10, c01, c20, c30 = constants
    x, y = j23 * trace - 3.0, 0.5 * j23**2 * (trace**2 - square) - 3.0
    b, n = power
    linear = x if b == 0.0 else (np.expm1(b * x) if np.isinf(n) else np.expm1(n * np.log1p(b * x / n))) / b
    energy: Floats = c10 * linear + x * x * (c20 + x * c30) + c01 * y
    return energy

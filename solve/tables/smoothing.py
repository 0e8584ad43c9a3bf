"""A press's answers over depth, freed from the waves that a contact surface of few nodes adds.

A mesh touches node by node: its force waves about that of smooth bodies, most where few nodes touch. The true answer is
smooth and close to a power of the depth (3/2 for a ball on a half-space, Hertz 1882). So the logarithms of force and
contact area over that of depth, and charge per force over depth, are polynomials fitted by weighted least squares;
leave-one-out errors choose their degree (Allen, Technometrics 16, 1974).
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial import Polynomial, chebyshev

from foundation.arrays import Floats

PRESSED = tuple(float(k / 16) ** 1.5 for k in range(2, 17))
"""Of the depth, at which a press is seen that is to be smoothed: closer where the contact is small."""
DEGREES = range(3, 7)
SMALL_CHARGE_SHARE = 0.1  # of the largest charge per force: a charge that changes sign is not relative to itself


@dataclass(frozen=True)
class Smooth:
    """Smooth curves of a press over its depth. logarithms : of force and of area over that of the share. per_force :
    each charge over the share, C per N.

    first : share below which the power law goes on. error : (2 + e,) one standard error of the curves, relative, of
    charges to the largest of them.
    """

    logarithms: tuple[Polynomial, Polynomial]
    per_force: tuple[Polynomial, ...]
    first: float
    error: Floats

    def at(self, shares: Floats) -> Floats:
        """Outputs (m, 2 + e) at shares (m,) of the depth, all above 0."""
        known = np.log(np.maximum(shares, self.first))
        below = np.log(shares) - known
        logs = [curve(known) + curve.deriv()(np.log(self.first)) * below for curve in self.logarithms]
        force, area = np.exp(logs)
        return np.column_stack([force, area, *(curve(shares) * force for curve in self.per_force)])


def smooth(shares: Sequence[float], outputs: Floats) -> Smooth:
    """Curves through outputs (n, 2 + e) at shares (n,); those without contact are left out."""
    touching = (outputs[:, 0] > 0.0) & (outputs[:, 1] > 0.0)
    x, y = np.asarray(shares)[touching], outputs[touching]
    weight = np.sqrt(x)  # waves are largest where few nodes touch
    logarithms = [_fit_polynomial(np.log(x), np.log(y[:, n]), weight) for n in (0, 1)]
    per_force = [_fit_polynomial(x, charge / y[:, 0], weight) for charge in y[:, 2:].T]
    found = Smooth((logarithms[0], logarithms[1]), tuple(per_force), float(x[0]), np.zeros(y.shape[1]))
    curves = found.at(x)
    size = np.abs(curves)
    size[:, 2:] = size[:, 2:].max(axis=1, keepdims=True)
    largest_C_per_N = np.abs(curves[:, 2:] / curves[:, :1]).max()
    size[:, 2:] = np.maximum(size[:, 2:], SMALL_CHARGE_SHARE * size[:, :1] * largest_C_per_N)
    waves = ((weight[:, None] * (y - curves) / np.maximum(size, 1e-300)) ** 2).sum(axis=0) / (weight**2).sum()
    terms = np.array([len(curve) for curve in (*logarithms, *per_force)])
    return replace(found, error=np.sqrt(waves * terms / len(x)))


def _fit_polynomial(x: Floats, y: Floats, weight: Floats) -> Polynomial:
    """Polynomial of the degree with the least leave-one-out error."""
    return min((_fit_of_degree(x, y, weight, degree) for degree in DEGREES), key=lambda found: found[0])[1]


def _fit_of_degree(x: Floats, y: Floats, weight: Floats, degree: int) -> tuple[float, Polynomial]:
    """Leave-one-out error of a polynomial of this degree, and the polynomial."""
    curve = Polynomial.fit(x, y, degree, w=weight)
    offset, scale = curve.mapparms()
    basis = np.linalg.qr(weight[:, None] * chebyshev.chebvander(offset + scale * x, degree))[0]
    left_out = weight * (y - curve(x)) / (1.0 - np.minimum((basis**2).sum(axis=1), 0.999))
    return float((left_out**2).sum()), curve

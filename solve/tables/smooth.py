"""A press's answers over depth, freed from the waves that a contact surface of few nodes adds.

A mesh touches node by node: its force waves about that of smooth bodies, most where few nodes touch. The true answer is
smooth and close to a power of the depth (3/2 for a ball on a half-space, Hertz 1882). So the logarithms of force and
contact area over that of depth, and charge per force over depth, are polynomials fitted by weighted least squares;
leave-one-out errors choose their degree (Allen, Technometrics 16, 1974).

How far the baseline's table is off, which is a smoothed press on a finer mesh.

The table of the reduced model, changed by what other presses showed.

Against the baseline at the same depth, force and contact area change by a factor, and charges by a difference per
baseline force. Both are smooth over depth where force and charge themselves have kinks, and several changes go
together: factors multiply, differences add. What layers remember is scaled alike.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial import Polynomial, chebyshev
from scipy.interpolate import make_interp_spline

from geometry.arrays import Floats
from solve.reduced.fit import CELLS, ResponseTable

PRESSED = tuple(float(k / 16) ** 1.5 for k in range(2, 17))
"""Of the depth, at which a press is seen that is to be smoothed: closer where the contact is small."""
DEGREES = range(3, 7)
LITTLE = 0.1  # of the largest charge per force: a charge that changes sign is not relative to itself


@dataclass(frozen=True)
class Smooth:
    """logarithms : of force and of area over that of the share. per_force : each charge over the share, C per N.

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
    logarithms = [_fitted(np.log(x), np.log(y[:, n]), weight) for n in (0, 1)]
    per_force = [_fitted(x, charge / y[:, 0], weight) for charge in y[:, 2:].T]
    found = Smooth((logarithms[0], logarithms[1]), tuple(per_force), float(x[0]), np.zeros(y.shape[1]))
    curves = found.at(x)
    size = np.abs(curves)
    size[:, 2:] = size[:, 2:].max(axis=1, keepdims=True)
    size[:, 2:] = np.maximum(size[:, 2:], LITTLE * size[:, :1] * np.abs(curves[:, 2:] / curves[:, :1]).max())
    waves = ((weight[:, None] * (y - curves) / np.maximum(size, 1e-300)) ** 2).sum(axis=0) / (weight**2).sum()
    terms = np.array([len(curve) for curve in (*logarithms, *per_force)])
    return replace(found, error=np.sqrt(waves * terms / len(x)))


def _fitted(x: Floats, y: Floats, weight: Floats) -> Polynomial:
    """Of the degree with the least leave-one-out error."""
    return min((_of_degree(x, y, weight, degree) for degree in DEGREES), key=lambda found: found[0])[1]


def _of_degree(x: Floats, y: Floats, weight: Floats, degree: int) -> tuple[float, Polynomial]:
    curve = Polynomial.fit(x, y, degree, w=weight)
    offset, scale = curve.mapparms()
    basis = np.linalg.qr(weight[:, None] * chebyshev.chebvander(offset + scale * x, degree))[0]
    left_out = weight * (y - curve(x)) / (1.0 - np.minimum((basis**2).sum(axis=1), 0.999))
    return float((left_out**2).sum()), curve


LEAST_ERROR = 0.003
"""What the table and its interpolation add: see tests/diagnose/segment."""
SMALL_CHARGE = 0.02
"""Of the largest charge: one that changes sign is not relative to itself there."""
SEEN: Floats = np.linspace(0.2, 1.0, 9)
"""Shares of the depth at which both meshes are compared."""


def accuracy(middle: Smooth, fine: Smooth, ratio: float) -> dict[str, float]:
    """One sigma of force, voltage and displacement, each relative to itself; voltages to the largest of them.

    middle, fine : presses on two meshes; ratio : finer over coarser element size. Where the error falls with the
    square of the size, that of the finer mesh is r^2 / (1 - r^2) of the difference (Richardson); beside it stands the
    standard error of the smoothing.
    """
    left = ratio**2 / (1.0 - ratio**2)
    at_middle, at_fine = middle.at(SEEN), fine.at(SEEN)
    size = np.abs(at_fine)
    size[:, 2:] = size[:, 2:].max(axis=1, keepdims=True)
    size = np.maximum(size, SMALL_CHARGE * size.max(axis=0))
    off = np.hypot(left * (np.abs(at_fine - at_middle) / np.maximum(size, 1e-300)).max(axis=0), fine.error)
    steepness = np.log(at_fine[-1, 0] / at_fine[0, 0])  # over the depths seen: a force error is a smaller one of depth
    errors = {"force_N": off[0], "voltage_V": off[2:].max(), "displacement_mm": off[0] / max(steepness, 1.0)}
    return {name: max(LEAST_ERROR, float(error)) for name, error in errors.items()}


LEAST_FACTOR = 1e-3  # factor of force and area where contact is all but lost
TRUSTED = 0.5, 2.0  # by which a finer mesh may change an answer


def change(base: Floats, other: Floats) -> Floats:
    """(n, 2 + e) from outputs of two presses at the same depths: logarithms of factors, and C per N."""
    factors = np.log(np.maximum(other[:, :2] / np.maximum(base[:, :2], 1e-300), LEAST_FACTOR))
    return np.concatenate([factors, (other[:, 2:] - base[:, 2:]) / np.maximum(base[:, :1], 1e-300)], axis=1)


class Depths:
    """From shares (n,) of the depth to the rows of a table: one matrix."""

    def __init__(self, shares: tuple[float, ...]) -> None:
        knots = np.array([0.0, *shares])
        unit = np.vstack([np.eye(len(shares))[:1], np.eye(len(shares))])  # at touch as at the first share
        self.to_rows: Floats = make_interp_spline(knots, unit, min(3, len(shares)))(np.linspace(0.0, 1.0, CELLS + 1))


def changed(fit: ResponseTable, depths: Depths, change: Floats, charge_factor: float) -> ResponseTable:
    """The table with the summed changes (n, 2 + e), and every charge times a factor."""
    rows = depths.to_rows @ change
    elastic = fit.table[:, 0, : change.shape[1]]
    factors = np.exp(rows[:, :2])
    found = np.concatenate([elastic[:, :2] * factors, elastic[:, 2:] + elastic[:, :1] * rows[:, 2:]], axis=1)
    return _with_elastic(fit, found, factors, charge_factor)


def replaced(fit: ResponseTable, outputs: Floats) -> ResponseTable:
    """The table with other elastic outputs (cells + 1, 2 + e), of a dot that touches at once."""
    own = fit.table[:, 0, :2]
    factors = np.clip(np.divide(outputs[:, :2], own, out=np.ones_like(own), where=own > 0.0), *TRUSTED)
    return _with_elastic(replace(fit, touch=np.array([0.0, *fit.touch[1:]])), outputs, factors, 1.0)


def _with_elastic(fit: ResponseTable, outputs: Floats, factors: Floats, charge_factor: float) -> ResponseTable:
    """What layers remember of force and area goes by factors (cells + 1, 2), of charges in proportion on the whole."""
    table, charges = fit.table.copy(), slice(2, outputs.shape[1])
    own = table[:, 0, charges]
    size = np.maximum((own**2).sum(axis=0), 1e-300)
    table[:, 1:, :2] *= factors[:, None]
    table[:, 1:, charges] *= (outputs[:, charges] * own).sum(axis=0) / size
    table[:, 0, : outputs.shape[1]] = outputs
    table[:, :, charges] *= charge_factor
    return replace(fit, table=table)

"""The table of the reduced model, changed by what other presses showed.

Against the baseline at the same depth, force and contact area change by a factor, and charges by a difference per
baseline force. Both are smooth over depth where force and charge themselves have kinks, and several changes go
together: factors multiply, differences add. What layers remember is scaled alike.
"""

from dataclasses import replace

import numpy as np
from scipy.interpolate import make_interp_spline

from mesh.types import Floats
from solve.reduced.fit import CELLS, Fit

LEAST = 1e-3  # factor of force and area where contact is all but lost


def change(base: Floats, other: Floats) -> Floats:
    """(n, 2 + e) from outputs of two presses at the same depths: logarithms of factors, and C per N."""
    factors = np.log(np.maximum(other[:, :2] / np.maximum(base[:, :2], 1e-300), LEAST))
    return np.concatenate([factors, (other[:, 2:] - base[:, 2:]) / np.maximum(base[:, :1], 1e-300)], axis=1)


class Depths:
    """From shares (n,) of the depth to the rows of a table: one matrix."""

    def __init__(self, shares: tuple[float, ...]) -> None:
        knots = np.array([0.0, *shares])
        unit = np.vstack([np.eye(len(shares))[:1], np.eye(len(shares))])  # at touch as at the first share
        self.to_rows: Floats = make_interp_spline(knots, unit, min(3, len(shares)))(np.linspace(0.0, 1.0, CELLS + 1))


def changed(fit: Fit, depths: Depths, change: Floats, charge_factor: float) -> Fit:
    """The table with the summed changes (n, 2 + e), and every charge times a factor."""
    table, charges = fit.table.copy(), slice(2, change.shape[1])
    rows = depths.to_rows @ change
    table[:, :, :2] *= np.exp(rows[:, None, :2])
    own = fit.table[:, 0, charges]
    added = fit.table[:, 0, :1] * rows[:, charges]
    size = np.maximum((own**2).sum(axis=0), 1e-300)
    table[:, 1:, charges] *= 1.0 + (added * own).sum(axis=0) / size
    table[:, 0, charges] += added
    table[:, :, charges] *= charge_factor
    return replace(fit, table=table)

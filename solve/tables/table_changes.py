"""The table of the reduced model, changed by what other presses showed.

Against the baseline at the same depth, force and contact area change by a factor, and charges by a difference per
baseline force. Both are smooth over depth where force and charge themselves have kinks, and several changes go
together: factors multiply, differences add. What layers remember is scaled alike.
"""

from dataclasses import replace

import numpy as np
from scipy.interpolate import make_interp_spline

from foundation.arrays import Floats
from solve.reduced.fit import CELLS, ResponseTable

LEAST_FACTOR = 1e-3  # factor of force and area where contact is all but lost
TRUSTED = 0.5, 2.0  # by which a finer mesh may change an answer


def change(base: Floats, other: Floats) -> Floats:
    """Change (n, 2 + e) between outputs of two presses at the same depths: logarithms of factors, and C per N."""
    factors = np.log(np.maximum(other[:, :2] / np.maximum(base[:, :2], 1e-300), LEAST_FACTOR))
    return np.concatenate([factors, (other[:, 2:] - base[:, 2:]) / np.maximum(base[:, :1], 1e-300)], axis=1)


class Depths:
    """Matrix from values at shares (n,) of the depth to those at the rows of a table."""

    def __init__(self, shares: tuple[float, ...]) -> None:
        knots = np.array([0.0, *shares])
        unit = np.vstack([np.eye(len(shares))[:1], np.eye(len(shares))])  # at touch as at the first share
        self.to_rows: Floats = make_interp_spline(knots, unit, min(3, len(shares)))(np.linspace(0.0, 1.0, CELLS + 1))


def with_changes(fit: ResponseTable, depths: Depths, change: Floats, charge_factor: float) -> ResponseTable:
    """The table with the summed changes (n, 2 + e) at the depths, and every charge times a factor."""
    rows = depths.to_rows @ change
    elastic = fit.table[:, 0, : change.shape[1]]
    factors = np.exp(rows[:, :2])
    found = np.concatenate([elastic[:, :2] * factors, elastic[:, 2:] + elastic[:, :1] * rows[:, 2:]], axis=1)
    return _with_elastic(fit, found, factors, charge_factor)


def with_elastic_outputs(fit: ResponseTable, outputs: Floats) -> ResponseTable:
    """The table with other elastic outputs (cells + 1, 2 + e), of a dot that touches at once."""
    own = fit.table[:, 0, :2]
    factors = np.clip(np.divide(outputs[:, :2], own, out=np.ones_like(own), where=own > 0.0), *TRUSTED)
    return _with_elastic(replace(fit, touch=np.array([0.0, *fit.touch[1:]])), outputs, factors, 1.0)


def _with_elastic(fit: ResponseTable, outputs: Floats, factors: Floats, charge_factor: float) -> ResponseTable:
    """The table with other elastic outputs. What layers remember of force and area goes by factors (cells + 1, 2), of
    charges in proportion on the whole.
    """
    table, charges = fit.table.copy(), slice(2, outputs.shape[1])
    own = table[:, 0, charges]
    size = np.maximum((own**2).sum(axis=0), 1e-300)
    table[:, 1:, :2] *= factors[:, None]
    table[:, 1:, charges] *= (outputs[:, charges] * own).sum(axis=0) / size
    table[:, 0, : outputs.shape[1]] = outputs
    table[:, :, charges] *= charge_factor
    return replace(fit, table=table)

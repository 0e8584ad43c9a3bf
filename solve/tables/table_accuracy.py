"""How far the baseline's table is off, which is a smoothed press on a finer mesh."""

import numpy as np

from foundation.arrays import Floats
from solve.tables.smoothing import Smooth

LEAST_ERROR = 0.003
"""What the table and its interpolation add: see tests/diagnose/segment."""
SMALL_CHARGE = 0.02
"""Of the largest charge: one that changes sign is not relative to itself there."""
COMPARED_SHARES: Floats = np.linspace(0.2, 1.0, 9)
"""Shares of the depth at which both meshes are compared."""


def accuracy(middle: Smooth, fine: Smooth, ratio: float) -> dict[str, float]:
    """Standard deviation of force, voltage and displacement, each relative to itself; voltages to the largest of them.

    middle, fine : presses on two meshes; ratio : finer over coarser element size. Where the error falls with the
    square of the size, that of the finer mesh is r^2 / (1 - r^2) of the difference (Richardson); beside it stands the
    standard error of the smoothing.
    """
    left = ratio**2 / (1.0 - ratio**2)
    at_middle, at_fine = middle.at(COMPARED_SHARES), fine.at(COMPARED_SHARES)
    size = np.abs(at_fine)
    size[:, 2:] = size[:, 2:].max(axis=1, keepdims=True)
    size = np.maximum(size, SMALL_CHARGE * size.max(axis=0))
    off = np.hypot(left * (np.abs(at_fine - at_middle) / np.maximum(size, 1e-300)).max(axis=0), fine.error)
    steepness = np.log(at_fine[-1, 0] / at_fine[0, 0])  # over the depths seen: a force error is a smaller one of depth
    errors = {"force_N": off[0], "voltage_V": off[2:].max(), "displacement_mm": off[0] / max(steepness, 1.0)}
    return {name: max(LEAST_ERROR, float(error)) for name, error in errors.items()}

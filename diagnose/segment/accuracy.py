"""How far the table is off once it is corrected by a press on a finer mesh."""

import numpy as np

from mesh.types import Floats

LEAST = 0.003
"""What the table and its interpolation add: see tests/diagnose/segment."""


def accuracy(coarse: Floats, fine: Floats, ratio: float) -> dict[str, float]:
    """One sigma of force, voltage and displacement, each relative to itself at full depth.

    coarse, fine : outputs (n, 2 + e) on both meshes; ratio : finer over coarser element size. Where the error falls
    with the square of the size, that of the finer mesh is r^2 / (1 - r^2) of the difference (Richardson).
    """
    left = ratio**2 / (1.0 - ratio**2)
    off = left * np.abs(fine - coarse).max(axis=0) / np.maximum(np.abs(fine).max(axis=0), 1e-300)
    steepness = np.log(fine[-1, 0] / fine[0, 0])  # over the depths seen: a force error is a smaller error of depth
    errors = {"force_N": off[0], "voltage_V": off[2:].max(), "displacement_mm": off[0] / max(steepness, 1.0)}
    return {name: max(LEAST, float(error)) for name, error in errors.items()}

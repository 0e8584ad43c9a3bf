"""The step of an analogue-to-digital converter, seen in the values it gave."""

import numpy as np

from foundation.arrays import Floats

FEWEST_LEVELS = 3  # fewer different values show no step
LEAST_SHARE_OF_MULTIPLES = 0.99  # of the differences that must be whole multiples


def quantisation_step(values: Floats) -> float | None:
    """Step of which all differences of the finite values (n,) are whole multiples; None for a fine or dense scale."""
    levels = np.unique(values[np.isfinite(values)])
    span = float(np.ptp(levels)) if len(levels) else 0.0
    if len(levels) < FEWEST_LEVELS:
        return None
    distance = np.diff(levels)
    distance = distance[distance > 1e-9 * span]
    smallest = float(distance.min())
    step = float(np.median(distance[distance < 1.5 * smallest]))
    multiples = distance / step
    near = np.abs(multiples - np.round(multiples)) < 0.05 * np.maximum(1.0, np.log10(multiples + 1.0))
    return step if float(near.mean()) >= LEAST_SHARE_OF_MULTIPLES else None

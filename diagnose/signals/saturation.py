"""Samples that stand at a limit of the recorder."""

import numpy as np

from foundation.arrays import Bools, Floats, Ints

SHORTEST_PLATEAU_SAMPLES = 4  # equal samples in a row
PLATEAU_LENGTH_RATIO = 3  # times the longest such row elsewhere


def saturation_mask(values: Floats, limit: float | None = None) -> Bools:
    """Flags (t,) of samples that stay at the largest or smallest value, or at a known limit.

    Noise makes neighbours differ, a limit makes them equal. A converter coarser than the noise makes them equal too,
    but at rest as well: a row of equal samples counts only when it is far longer than those elsewhere.
    """
    at_limit = np.zeros(len(values), dtype=bool)
    if limit is not None:
        at_limit |= np.abs(values) >= 0.999 * limit
    finite = values[np.isfinite(values)]
    if len(finite) == 0:
        return at_limit
    first, length, level = _plateaus(values)
    extreme = ((level == finite.max()) | (level == finite.min())) & (level != finite[0])
    needed = max(SHORTEST_PLATEAU_SAMPLES, PLATEAU_LENGTH_RATIO * int(length[~extreme].max()))
    for n in np.flatnonzero(extreme & (length >= needed)):
        at_limit[first[n] : first[n] + length[n]] = True
    return at_limit


def _plateaus(values: Floats) -> tuple[Ints, Ints, Floats]:
    """First sample, length and value of each row of equal samples."""
    edges = np.concatenate([[True], values[1:] != values[:-1]])
    first = np.flatnonzero(edges)
    return first, np.diff(np.append(first, len(values))), values[first]

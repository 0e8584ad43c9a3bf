"""The fewest samples of a curve whose straight lines follow it (Ramer 1972; Douglas and Peucker 1973)."""

import numpy as np

from foundation.arrays import Bools, Floats


def samples_to_keep(time: Floats, values: Floats, tolerance: float, most: int) -> Bools:
    """Whether each sample (t,) is to be kept so that straight lines stay within a tolerance of all values.

    The sample farthest from its line is added until none is too far, or until there are as many as allowed.
    """
    kept = np.zeros(len(time), dtype=np.bool_)
    kept[[0, -1]] = True
    spans = [_farthest(time, values, 0, len(time) - 1)]
    while spans and int(kept.sum()) < most:
        worst = max(range(len(spans)), key=lambda n: spans[n][0])
        distance, place, first, last = spans.pop(worst)
        if distance <= tolerance:
            break
        kept[place] = True
        spans += [_farthest(time, values, *part) for part in ((first, place), (place, last)) if part[1] - part[0] > 1]
    return kept


def _farthest(time: Floats, values: Floats, first: int, last: int) -> tuple[float, int, int, int]:
    """Largest distance from the line between two samples, where, and these samples."""
    inner = slice(first + 1, last)
    line = np.interp(time[inner], time[[first, last]], values[[first, last]])
    off = np.abs(values[inner] - line)
    worst = int(np.argmax(off)) if len(off) else 0
    return (float(off[worst]) if len(off) else 0.0), first + 1 + worst, first, last

"""The fewest times at which the 3D model must be solved to follow a drive."""

from itertools import pairwise

import numpy as np

from mesh.types import Bools, Floats, Ints

SLOPE = 0.06, 0.2, 0.4, 0.6, 0.8, 0.94  # of a slope: closest where softened rubber leaves its first curve
STEEP = 0.2  # of the largest drive: a lesser rise needs no point between
HOLD = 0.03, 0.1, 0.3  # of a stretch without much change: what relaxes does so at first


def knots(time: Floats, share: Floats, tolerance: float, most: int) -> Ints:
    """Samples (k,) to solve at, for a drive in shares (t,) of its largest: corners, and between them by SLOPE or HOLD.

    What is clear of the segment has no points of its own.
    """
    kept = np.flatnonzero(corners(time, share, tolerance, most // 2))
    more: list[int] = []
    for first, last in pairwise(kept):
        rise = abs(share[last] - share[first])
        if max(share[first], share[last]) <= tolerance:
            continue
        places = SLOPE if rise > STEEP else HOLD
        more += [int(np.searchsorted(time, time[first] + p * (time[last] - time[first]))) for p in places]
    found = np.unique([*kept, *more])
    return found if len(found) <= most else kept


def corners(time: Floats, values: Floats, tolerance: float, most: int) -> Bools:
    """Which samples (t,) to keep so that straight lines between them stay within a tolerance of all values.

    The sample farthest from its line is added until none is too far (Ramer 1972; Douglas and Peucker 1973), or until
    there are as many as allowed.
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

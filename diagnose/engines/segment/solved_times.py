"""The fewest times at which the 3D model must be solved to follow a drive."""

from itertools import pairwise

import numpy as np

from foundation.arrays import Floats, Ints
from solve.solution.thinning import samples_to_keep

SLOPE_FRACTIONS = 0.06, 0.2, 0.4, 0.6, 0.8, 0.94  # of a slope: closest where softened rubber leaves its first curve
STEEP_RISE_SHARE = 0.2  # of the largest drive: a lesser rise needs no point between
HOLD_FRACTIONS = 0.03, 0.1, 0.3  # of a stretch without much change: what relaxes does so at first


def solved_samples(time: Floats, share: Floats, tolerance: float, most: int) -> Ints:
    """Numbers (k,) of samples to solve at, for a drive in shares (t,) of its largest, at most `most` of them.

    Corners, and between them points by SLOPE_FRACTIONS or HOLD_FRACTIONS. What is clear of the segment has no points of
    its own.
    """
    kept = np.flatnonzero(samples_to_keep(time, share, tolerance, most // 2))
    more: list[int] = []
    for first, last in pairwise(kept):
        rise = abs(share[last] - share[first])
        if max(share[first], share[last]) <= tolerance:
            continue
        places = SLOPE_FRACTIONS if rise > STEEP_RISE_SHARE else HOLD_FRACTIONS
        more += [int(np.searchsorted(time, time[first] + p * (time[last] - time[first]))) for p in places]
    found = np.unique([*kept, *more])
    return found if len(found) <= most else kept

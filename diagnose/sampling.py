"""Even stretches of a time axis."""

from itertools import pairwise

import numpy as np
from scipy.ndimage import median_filter

from mesh.types import Floats

WINDOW = 9  # steps of the running median: a single late sample is a gap, five in a row are another rate
GAP, OTHER_RATE = 1.5, 1.2  # ratios to the running median, and of the running median to the one before


def even_pieces(time_s: Floats) -> tuple[slice, ...]:
    """Slices of a time axis (t,), together all of it, each without a gap and at one rate."""
    step = np.diff(time_s)
    usual = median_filter(step, WINDOW, mode="nearest")
    other_rate = np.abs(np.diff(np.log(usual))) > np.log(OTHER_RATE)
    edges = {0, *(np.flatnonzero(step > GAP * usual) + 1), *(np.flatnonzero(other_rate) + 1), len(time_s)}
    return tuple(slice(int(a), int(b)) for a, b in pairwise(sorted(edges)))


def gaps(time_s: Floats) -> list[int]:
    """Samples before which the time jumps."""
    step = np.diff(time_s)
    return [int(n) + 1 for n in np.flatnonzero(step > GAP * median_filter(step, WINDOW, mode="nearest"))]


def rates_Hz(time_s: Floats) -> list[float]:
    """The sampling rates that occur, one after the other, without equal neighbours; short pieces do not count."""
    found: list[float] = []
    for piece in even_pieces(time_s):
        if piece.stop - piece.start <= WINDOW:
            continue
        rate = 1.0 / float(np.median(np.diff(time_s[piece])))
        if not found or abs(np.log(rate / found[-1])) > np.log(OTHER_RATE):
            found.append(rate)
    return found


def is_even(time_s: Floats) -> bool:
    """Whether steps differ from their median by less than a tenth, as noise models in discrete time need."""
    step = np.diff(time_s)
    return bool(len(step) > 0 and np.abs(step / np.median(step) - 1.0).max() < 0.1)

"""Acceleration of a measured path, which second differences would drown in the noise of the column.

A quintic smoothing spline with as few knots as leave a residual of the root mean square of that noise (Dierckx, Curve
and Surface Fitting with Splines, 1993, chapter 5).
"""

from math import comb
from warnings import catch_warnings, simplefilter

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from scipy.interpolate import UnivariateSpline

from diagnose.signals.phases import sigma_of_differences
from foundation.arrays import Floats
from solve.reduced.recording import second_differences

SPLINE_DEGREE = 5  # its second derivative is smooth
NEGLIGIBLE_NOISE_SHARE = 0.01  # of the root mean square of differences, what noise makes of them
DIFFERENCE_ORDER = 6  # of differences in which a smooth motion hardly shows
FEWEST_SAMPLES = 4 * DIFFERENCE_ORDER


def acceleration_mm_per_s2(time_s: Floats, path_mm: Floats) -> Floats:
    """Acceleration (t,) in mm/s2 of a path (t,) in mm.

    By second differences where their noise is too small to matter, else by a smoothing spline.
    """
    return _derivative(time_s, path_mm, 2, second_differences(time_s, path_mm), np.sqrt(comb(4, 2)))


def velocity_mm_per_s(time_s: Floats, path_mm: Floats) -> Floats:
    """First derivative (t,) of a path (t,) in mm, in the same way."""
    return _derivative(time_s, path_mm, 1, np.gradient(path_mm, time_s), np.sqrt(0.5))


def _derivative(time_s: Floats, path_mm: Floats, order: int, raw: Floats, grown: float) -> Floats:
    """raw : by differences, which make of a noise of 1 that of grown over the step to the power of the order."""
    if len(path_mm) < FEWEST_SAMPLES:
        return raw
    noise = path_noise_mm(path_mm)
    of_raw = grown * noise / float(np.median(np.diff(time_s))) ** order
    if of_raw <= NEGLIGIBLE_NOISE_SHARE * float(np.sqrt(np.mean(raw**2))):
        return raw
    largest = len(path_mm) + np.sqrt(2.0 * len(path_mm))  # of its range by chance: noise is no motion
    with catch_warnings():
        simplefilter("ignore")  # where no knots meet that residual exactly, it gives those that come near
        spline = UnivariateSpline(time_s, path_mm, k=SPLINE_DEGREE, s=largest * noise**2)
    return np.asarray(spline.derivative(order)(time_s))


def path_noise_mm(path_mm: Floats) -> float:
    """One sigma, in mm, of what a column (t,) adds to a smooth path while it changes: noise, or its last digit."""
    moves = np.ptp(sliding_window_view(path_mm, DIFFERENCE_ORDER + 1), axis=1) > 0.0
    return sigma_of_differences(np.diff(path_mm, DIFFERENCE_ORDER)[moves], DIFFERENCE_ORDER)

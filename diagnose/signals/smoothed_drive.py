"""The motion behind a noisy measured drive: local parabolas over as many samples as they fit.

A model that is pressed with the noise of an encoder answers to it, and whatever smooths or delays that answer would
seem to explain a recording. Each sample is therefore the middle of a parabola through a window about it (Savitzky and
Golay, Anal. Chem. 36 (1964) 1627), the widest one that agrees with all narrower ones within their own noise: wide in a
hold and on a ramp, narrow at a corner (intersection of confidence intervals: Goldenshluger and Nemirovski, Math.
Methods Stat. 6 (1997) 135; Katkovnik, IEEE Trans. Signal Process. 47 (1999) 2567).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.signal import freqz, savgol_coeffs, savgol_filter

from diagnose.signals.phases import sigma_of_differences
from foundation.arrays import Floats, Ints

HALF_WIDTHS = (2, 3, 5, 8, 12, 18, 27, 40, 60, 90, 135)
DEGREE = 2
DEVIATIONS = 2.0
"""Half an interval of confidence; wider ones round corners more, narrower ones leave more noise."""
DIFFERENCES = 4  # in which a motion of finite jerk hardly shows


@dataclass(frozen=True)
class SmoothedDrive:
    """values (t,) : as the drive. half_width (t,) : samples on each side in a window. sigma : of the white noise."""

    values: Floats
    half_width: Ints
    sigma: float

    def noise_left(self, own: Ints, cycles_per_sample: Floats) -> Floats:
        """Share (f,) of the density of the white noise that is left at frequencies (f,), a mean over some samples."""
        left = np.zeros(len(cycles_per_sample))
        for half, count in zip(*np.unique(self.half_width[own], return_counts=True), strict=True):
            window = savgol_coeffs(2 * half + 1, DEGREE) if half else np.ones(1)
            left += count * np.abs(freqz(window, worN=2.0 * np.pi * cycles_per_sample)[1]) ** 2
        return left / len(own)


def smoothed_drive(drive: Floats, pieces: Sequence[slice]) -> SmoothedDrive:
    """Smoothed drive (t,) within each piece of even sampling; as it is where it has no noise."""
    sigma = sigma_of_differences(np.diff(drive, DIFFERENCES), DIFFERENCES)
    values, half_width = drive.astype(float), np.zeros(len(drive), dtype=np.int64)
    for piece in pieces if sigma > 0.0 else ():
        values[piece], half_width[piece] = _widest_windows(drive[piece], sigma)
    return SmoothedDrive(values, half_width, sigma)


def _widest_windows(drive: Floats, sigma: float) -> tuple[Floats, Ints]:
    """Values (t,) over the widest windows that agree with the narrower ones, and half widths (t,) of these."""
    found, half_width = drive.astype(float), np.zeros(len(drive), dtype=np.int64)
    low, high = drive - DEVIATIONS * sigma, drive + DEVIATIONS * sigma
    growing = np.ones(len(drive), dtype=np.bool_)
    for half in HALF_WIDTHS:
        length = 2 * half + 1
        if length > len(drive):
            break
        growing[:half] = growing[len(drive) - half :] = False
        value = savgol_filter(drive, length, DEGREE)
        spread = DEVIATIONS * sigma * float(np.linalg.norm(savgol_coeffs(length, DEGREE)))
        low, high = np.maximum(low, value - spread), np.minimum(high, value + spread)
        growing &= low <= high
        found, half_width = np.where(growing, value, found), np.where(growing, half, half_width)
    return found, half_width

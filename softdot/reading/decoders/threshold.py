"""Decoder "threshold": a dot is raised where the charge of the electrode under its place is above one threshold.

The charge of each electrode is restored from its voltages, less its least value within a cell pitch. Crosstalk,
neighbours and shapes, which the model knows, are not used; speed and place are those of the track.
"""

import numpy as np
from scipy.ndimage import maximum_filter1d, minimum_filter1d

from foundation.arrays import Floats
from softdot.reading.cells import DOTS
from softdot.reading.decoders.fitted import Track
from softdot.reading.decoders.model import DecodedCells, trim_blanks
from softdot.reading.decoders.pressing import PressedCells
from softdot.reading.line import cell_pitch_mm, cells_from, dot_places_mm
from softdot.reading.voltages import Reader, restored_charge_pC

LEVEL_STEP_MM, PEAK_WIDTH_MM = 0.1, 1.0
"""Step of the grid of charges along the line, and the width within which a peak is taken."""
LARGE_QUANTILE, THRESHOLD_SHARE = 0.95, 0.5
"""The threshold is half of the level that one of twenty places exceeds."""


def decode(reader: Reader, seen: Track | PressedCells) -> DecodedCells:
    """The cells whose electrodes are above the threshold."""
    level = _pressed_levels(reader, seen) if isinstance(seen, PressedCells) else _slid_levels(reader, seen)
    dots = level > THRESHOLD_SHARE * np.quantile(level, LARGE_QUANTILE)
    return trim_blanks(cells_from(dots), seen.passed_s)


def _pressed_levels(reader: Reader, seen: PressedCells) -> Floats:
    """Charge (c, 6) of the electrode nearest to each dot."""
    gap = dot_places_mm(reader.standard)[:, None] - reader.kernel.centres_mm[None]
    return seen.charge_pC[:, np.argmin((gap**2).sum(axis=2), axis=1)]


def _slid_levels(reader: Reader, seen: Track) -> Floats:
    """Peaks (c, 6) of the charge as the dot passes under the electrodes of its row, their mean."""
    charge, place = restored_charge_pC(reader, seen.heard), seen.place_mm(seen.heard.time_s)
    grid = np.arange(place[0], place[-1], LEVEL_STEP_MM)
    pitch, dots = cell_pitch_mm(reader.standard), dot_places_mm(reader.standard)
    centres = reader.kernel.centres_mm
    middles = pitch * np.arange(len(seen.passed_s))
    level = np.zeros((len(middles), DOTS))
    for dot in range(DOTS):
        across = np.abs(centres[:, 1] - dots[dot, 1])
        own = np.flatnonzero(across < across.min() + LEVEL_STEP_MM)
        for electrode in own:
            even = np.interp(grid, place, charge[:, electrode])
            above = even - minimum_filter1d(even, round(pitch / LEVEL_STEP_MM) | 1)
            peak = maximum_filter1d(above, round(PEAK_WIDTH_MM / LEVEL_STEP_MM) | 1)
            level[:, dot] += np.interp(middles + dots[dot, 0] - centres[electrode, 0], grid, peak) / len(own)
    return level

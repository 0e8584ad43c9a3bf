"""The place of the array at each time, from the voltages alone: speed, offset across the line, yaw, cell after cell.

1. A first speed from the frequency below which half of the power lies, beside that of templates at several speeds
   (softdot.reading.decoders.onset).
2. Around it, speed, place, offset and yaw over the first cells (softdot.reading.decoders.first_cells).
3. Along the line in blocks of cells: each block begins where the last ones lead to, and is moved to where its dots
   explain most.
"""

import numpy as np

from foundation.arrays import Floats
from softdot.reading.cells import DOTS
from softdot.reading.decoders.first_cells import SHIFT_STEP_MM, fit_first_cells
from softdot.reading.decoders.fitted import CellFit, Track, cell_fit, explained_squares
from softdot.reading.decoders.onset import active_interval, first_speed
from softdot.reading.decoders.templates import average_samples, templates
from softdot.reading.voltages import Reader, Voltages

BLOCK_CELLS, MOST_SHIFT_MM = 8, 0.7
"""Cells in a block, and how far it may be moved from where the last blocks lead to."""
MOST_STRETCH = 0.01
"""Largest relative change of the pitch within a block."""
HOP_CELLS, SPEED_BLOCKS, LEAST_BLOCK_SHARE = 4, 6, 0.05
"""Cells from block to block, blocks that give the speed, and the share of the largest score that a block must reach."""


def track_slide(reader: Reader, heard: Voltages) -> Track:
    """The track of a sliding array from its voltages. NoDotError where nothing stands out of their noise."""
    onset, end = active_interval(heard)
    speed = first_speed(reader, heard, onset, end)
    coarse, many = average_samples(heard, speed)
    posture, middle = fit_first_cells(reader, coarse, many, (onset, end), speed)
    fit = cell_fit(reader, templates(reader, posture, heard.step_s, many), coarse)
    return Track(fit, coarse, many, _passing_times(fit, middle, onset, end))


def _passing_times(fit: CellFit, middle: float, onset: float, end: float) -> Floats:
    """Time (c,) at which each cell with any signal, and those between, is passed; linear between middles of blocks."""
    while middle - fit.pitch_s > onset - 0.5 * fit.pitch_s:
        middle -= fit.pitch_s
    pitch, speed = fit.pitch_s, fit.templates.posture.speed_mm_per_s
    matrix = fit.matrix(BLOCK_CELLS)
    shifts = np.arange(-MOST_SHIFT_MM, MOST_SHIFT_MM + 1e-9, SHIFT_STEP_MM) / speed
    stretch = 1.0 + MOST_STRETCH * np.linspace(-1.0, 1.0, 5)
    cells = np.arange(BLOCK_CELLS) - 0.5 * (BLOCK_CELLS - 1)
    number, centre, most = 0.5 * (BLOCK_CELLS - 1), middle + 0.5 * (BLOCK_CELLS - 1) * pitch, 0.0
    known: list[tuple[float, float]] = []
    while centre < end + 0.5 * BLOCK_CELLS * pitch:
        times = centre + shifts[None, :, None] + pitch * stretch[:, None, None] * cells
        score = explained_squares(matrix, fit.products(times).reshape(-1, BLOCK_CELLS * DOTS))[0].reshape(
            times.shape[:2]
        )
        most = max(most, float(score.max()))
        if score.max() > LEAST_BLOCK_SHARE * most:
            centre = centre + _peak(shifts, score.max(axis=0))
            known.append((number, centre))
            pitch = _pitch_s(known[-SPEED_BLOCKS:], pitch)
        number, centre = number + HOP_CELLS, centre + HOP_CELLS * pitch
    numbers, centres = np.array(known).T
    first, last = _pitch_s(known[:SPEED_BLOCKS], fit.pitch_s), _pitch_s(known[-SPEED_BLOCKS:], fit.pitch_s)
    cell = np.arange(numbers[-1] + BLOCK_CELLS + 1)
    time = np.interp(cell, numbers, centres)
    time += first * np.minimum(cell - numbers[0], 0.0) + last * np.maximum(cell - numbers[-1], 0.0)
    return np.asarray(time[time < end + 0.5 * fit.pitch_s])


def _pitch_s(known: list[tuple[float, float]], before: float) -> float:
    """Time from cell to cell by a straight line through the middles of blocks; the earlier value for one block."""
    if len(known) < 2:
        return before
    numbers, centres = np.array(known).T
    return float(np.polyfit(numbers - numbers[0], centres - centres[0], 1)[0])


def _peak(at: Floats, score: Floats) -> float:
    """The place where a parabola through the largest value and its neighbours is largest."""
    k = int(np.argmax(score))
    if not 0 < k < len(at) - 1:
        return float(at[k])
    left, mid, right = score[k - 1], score[k], score[k + 1]
    bend = left - 2.0 * mid + right
    return float(at[k] + (0.5 * (left - right) / bend * (at[1] - at[0]) if bend < 0.0 else 0.0))

"""The noise of a measured drive, which adds to the variance of what a model predicts from it, band by band.

In a piece of a press the answer changes by s times the change of the drive. White noise of the drive then has the
density 2 dt (s sigma)^2, of which the smoothed drive keeps what passes its running means, and each whitened
coefficient the ratio of that to the density of the channel's own noise.
"""

from collections.abc import Sequence

import numpy as np

from diagnose.fit.samples import Samples
from diagnose.forward import Signals
from diagnose.signals.phases import rest_level
from foundation.arrays import Floats


def drive_noise_variance(samples: Samples, signals: Sequence[Signals]) -> Floats:
    """Variance (n,) that noise of the drive adds to each coefficient; 0 where the drive is a command without noise."""
    rest = [rest_level(run.drive_values)[1] for run in samples.recording.runs]
    added = np.zeros(len(samples))
    for block in samples.blocks:
        run = samples.recording.runs[block.run]
        if rest[block.run] == 0.0:
            continue
        place = np.flatnonzero(block.observed_mask)
        answer = signals[block.run][block.channel][place]
        first = block.rows.start
        for piece in samples.pieces_of(block):
            rows, own = piece.samples, slice(piece.samples.start - first, piece.samples.stop - first)
            taken = 1.0 - run.smoothed_drive.noise_left(place[own], samples.frequency_Hz[rows] * piece.step_s)
            variance = np.maximum(rest[block.run] ** 2 - run.smoothed_drive.sigma**2 * taken, 0.0)
            slope = _rms_slope(run.smoothed_drive.values[place[own]], answer[own])
            added[rows] = 2.0 * piece.step_s * slope**2 * variance / samples.noise_density[rows]
    return added


def _rms_slope(drive: Floats, answer: Floats) -> float:
    """Root mean square change of the answer over that of the drive."""
    moved = float(np.sum(np.diff(drive) ** 2))
    return float(np.sqrt(np.sum(np.diff(answer) ** 2) / moved)) if moved > 0.0 else 0.0

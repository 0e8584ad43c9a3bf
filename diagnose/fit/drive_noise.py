"""The noise of a measured drive, which adds to the variance of what a model predicts from it, band by band.

In a piece of a press the answer changes by s times the change of the drive. White noise of the drive then has the
density 2 dt (s sigma)^2, and each whitened coefficient the ratio of that to the density of the channel's own noise.
"""

from collections.abc import Sequence

import numpy as np

from diagnose.fit.samples import Samples
from diagnose.forward import Signals
from diagnose.signals.phases import rest_level
from foundation.arrays import Floats


def drive_noise_variance(samples: Samples, signals: Sequence[Signals]) -> Floats:
    """Variance (n,) that noise of the drive adds to each coefficient; 0 where the drive is a command without noise."""
    sigma = [rest_level(run.drive_values)[1] for run in samples.recording.runs]
    added = np.zeros(len(samples))
    for block in samples.blocks:
        run = samples.recording.runs[block.run]
        if sigma[block.run] == 0.0:
            continue
        drive, answer = run.drive_values[block.observed_mask], signals[block.run][block.channel][block.observed_mask]
        first = block.rows.start
        for piece in samples.pieces_of(block):
            own = slice(piece.samples.start - first, piece.samples.stop - first)
            slope = _rms_slope(drive[own], answer[own])
            density = samples.noise_density[piece.samples]
            added[piece.samples] = 2.0 * piece.step_s * (slope * sigma[block.run]) ** 2 / density
    return added


def _rms_slope(drive: Floats, answer: Floats) -> float:
    """Root mean square change of the answer over that of the drive."""
    moved = float(np.sum(np.diff(drive) ** 2))
    return float(np.sqrt(np.sum(np.diff(answer) ** 2) / moved)) if moved > 0.0 else 0.0

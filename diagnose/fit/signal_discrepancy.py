"""The discrepancy that an explanation may leave: proportional to the signal, of one size per channel.

Laws of real parts differ from ours, and every rig has flaws of its own: jitter of the drive, softness at first touch,
hysteresis of the tester. Of each channel the discrepancy is white over a press, with a mean square that is a fixed
share of the signal's: fits then weigh errors as a reader does, by their squares, and not by how little noise there is.

It is no noise that averages out: each phase of a press errs as one, however many samples it has. So the variance is
that of a sample times the samples per phase.
"""

from collections.abc import Sequence

import numpy as np

from diagnose.fit.samples import Samples, noise_degrees
from diagnose.noise.repeats import repeat_groups
from foundation.arrays import Floats, Ints

SMALLEST_SQUARE = np.finfo(float).tiny ** 0.5
VISIBLE_ERROR = 0.01
"""Root mean square error over the signal, above noise, up to which flaws of an ordinary rig may explain it."""


def with_white_noise(samples: Samples) -> Samples:
    """Samples with their noise taken as white: sums of squares are then those of the errors themselves."""
    white = {id(law): law.white_equivalent() for law in samples.noise.values()}
    laws = {key: white[id(law)] for key, law in samples.noise.items()}
    return Samples(samples.recording, laws, samples.shared)


class SignalDiscrepancy:
    """Discrepancies of samples with white noise.

    unit : (n,) variance of each where the discrepancy is as large as the signal.

    channel : (n,) number of the channel. share : (n,) by which the squares of each count in the mean over its channel.
    """

    def __init__(self, samples: Samples) -> None:
        self.samples = samples
        self.channel: Ints = samples.kind[samples.block_of]
        labels = np.column_stack([samples.block_of, samples.press, samples.phase])
        _, first, piece, count = np.unique(labels, axis=0, return_index=True, return_inverse=True, return_counts=True)
        self.unit, self._blur = np.empty(len(samples)), np.empty(len(samples))
        for block in samples.blocks:
            rows, law = block.rows, block.whitening.noise
            values = samples.recording.runs[block.run].channels[block.channel][block.observed_mask]
            self._blur[rows] = np.sqrt(2.0 / noise_degrees(law))
            for press in np.unique(samples.press[rows]):
                own = samples.press[rows] == press
                phases = len(np.unique(samples.phase[rows][own]))
                square = float(((values[own] - values[own].mean()) ** 2).sum())
                self.unit[rows.start + np.flatnonzero(own)] = max(
                    square / phases / law.autoregression.variance, SMALLEST_SQUARE
                )
        weight = _phase_weights(count, self.unit[first], self._blur[first])
        total = np.bincount(self.channel[first], weight)
        self.share: Floats = (weight / total[self.channel[first]])[piece.ravel()] / self.unit

    def variance(self, sizes: Floats) -> Floats:
        """Variance (n,) that discrepancies of sizes (c,), relative to the signals, add to each coefficient."""
        return np.asarray(sizes[self.channel] ** 2 * self.unit)

    def squares(self, residual: Floats) -> Floats:
        """Squares (n,) of a whitened residual (n,) above noise; they sum to its mean square relative to the signal."""
        return np.asarray((residual**2 - 1.0) * self.share)

    def noise_errors(self, place: Ints) -> Floats:
        """One sigma of the sums of squares of noise alone, which have the mean 0, over each place (n,) from 0 on.

        The power of the noise is itself known from a limited number of samples only.
        """
        drawn, known = np.bincount(place, 2.0 * self.share**2), np.bincount(place, self.share * self._blur)
        return np.asarray(np.sqrt(drawn + known**2))

    @property
    def noise_error(self) -> float:
        """One sigma of the sum of squares of noise alone over all coefficients."""
        return float(self.noise_errors(np.zeros(len(self.unit), dtype=np.int64))[0])

    def sizes(self, residual: Floats) -> Floats:
        """Root mean square (c,) of each channel of a whitened residual (n,) relative to its signal, above noise."""
        squares = np.bincount(self.channel, self.squares(residual), len(self.samples.channels))
        return np.asarray(np.sqrt(np.maximum(squares, 0.0)))


def _phase_weights(count: Ints, unit: Floats, blur: Floats) -> Floats:
    """Weights (p,) of phases of presses: alike, but less where noise hides a discrepancy that is just visible.

    The inverse variance of an estimate of its mean square from one degree of freedom beside noise of count
    coefficients, whose power is off by blur.
    """
    noise = (2.0 * count + (count * blur) ** 2) / unit**2
    return np.asarray(1.0 / (2.0 * VISIBLE_ERROR**4 + noise))


def condition_labels(samples: Samples) -> Ints:
    """Labels (n,) of what is held out together: runs that repeat each other; where all do, presses or phases."""
    home = {number: number for number in range(len(samples.recording.runs))}
    for group in repeat_groups(samples.recording.runs, samples.recording.phases):
        home |= dict.fromkeys(group, group[0])
    labels = np.array([home[number] for number in range(len(home))])[samples.run]
    return np.asarray(labels if len(np.unique(labels)) > 1 else samples.fold, dtype=np.int64)


def phase_shares(samples: Samples, squares: Floats, names: Sequence[str]) -> dict[str, float]:
    """Shares of squares (n,) above noise, by name of the phase."""
    total = np.maximum(np.bincount(samples.phase, squares, len(names)), 0.0)
    return {
        name: float(part) for name, part in zip(names, total / max(float(total.sum()), SMALLEST_SQUARE), strict=True)
    }

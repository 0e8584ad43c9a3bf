"""Errors of predictions relative to the signal of their channel, above noise."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from diagnose.fit.samples import Samples
from foundation.arrays import Bools, Floats, Ints


@dataclass(frozen=True)
class RelativeErrors:
    """noise : (n,) variance of the noise of each coefficient, in the square of its unit. signal : (n,) squares whose
    sum over a channel is that of its signal. channel : (n,) number of its channel. counted : (n,) whether it is looked
    at.
    """

    noise: Floats
    signal: Floats
    channel: Ints
    counted: Bools

    @cached_property
    def _scale(self) -> Floats:
        total = np.bincount(self.channel, self.signal * self.counted)
        return np.where(self.counted, self.noise / np.maximum(total, np.finfo(float).tiny)[self.channel], 0.0)

    def squares(self, whitened: Floats) -> Floats:
        """Squares (n,) of whitened numbers (n,), relative to the signal of their channel."""
        return np.asarray(whitened**2 * self._scale)

    def above_noise(self, residual: Floats) -> Floats:
        """The same of a whitened residual (n,), less what noise alone makes of it."""
        return self.squares(residual) - self._scale

    @property
    def noise_sigma(self) -> Floats:
        """One sigma (c,) of the sum of above_noise in each channel, of noise alone."""
        return np.asarray(np.sqrt(2.0 * np.bincount(self.channel, self._scale**2)))

    def share_taken(self, before: Floats, after: Floats, sigmas: float = 0.0) -> float:
        """Share of what one prediction leaves above noise, before (n,), that another takes away; it leaves after (n,).

        The noise drops out of the difference, and a channel whose noise was estimated too large counts as one without
        excess and hides that of no other. sigmas : of the noise in a channel that may be left in it and count as taken.
        """
        excess = np.maximum(np.bincount(self.channel, before), 0.0)
        taken = np.bincount(self.channel, before - after) + sigmas * self.noise_sigma
        left = np.maximum(excess - taken, 0.0)
        return 1.0 - float(left.sum() / excess.sum()) if excess.any() else 0.0

    def largest(self, squares: Floats) -> float:
        """Root of the sum of squares (n,) of the worst channel."""
        return float(np.sqrt(max(float(np.bincount(self.channel, squares).max()), 0.0)))


def plain_noise_variance(samples: Samples) -> Floats:
    """Variance (n,) of the noise of each coefficient before whitening, in the square of the channel's unit."""
    found = np.empty(len(samples))
    for block in samples.blocks:
        for piece in samples.pieces_of(block):
            density = block.whitening.density_in_piece(
                piece.labels["piece"], samples.frequency_Hz[piece.samples], piece.step_s
            )
            found[piece.samples] = density / (2.0 * piece.step_s)
    return found

"""The noise of one channel: an autoregression, mains lines of random amplitude and phase, and rounding.

Covariance of n samples: C = C_ar + B B', B (n, 2 l) the sinusoids of the lines. With C_ar = L D L' by one-step
prediction (innovations.py) and W = (L D^(1/2))^-1 B, whitening is (1 + W W')^(-1/2) (L D^(1/2))^-1, its root by the
singular values of W. So the whitened samples are independent of unit variance, and log_density is exact.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.signal import lfilter, lfiltic

from diagnose.noise.autoregression import Autoregression
from diagnose.noise.innovations import innovations
from diagnose.noise.mains_lines import Line, line_basis
from diagnose.signals.recording import even_pieces, is_evenly_sampled
from foundation.arrays import Bools, Floats

SAME_RATE_TOLERANCE = 0.1  # relative: at another rate the autoregression says only how large the noise is


@dataclass(frozen=True)
class NoiseModel:
    """Noise of one channel. step_s : sampling step at which it was fitted. source : what the samples come from.

    samples : number of samples that it was fitted to, 0 where it is stated. quantisation : step of the converter in the
    unit of the channel, None where none was seen; its variance, a twelfth of the square, is the least that the
    innovations can have.
    """

    autoregression: Autoregression
    step_s: float
    source: str
    samples: int
    lines: tuple[Line, ...] = ()
    quantisation: float | None = None

    @property
    def rms(self) -> float:
        """Standard deviation of one sample in the unit of the channel, lines included."""
        own = float(self.autoregression.autocovariance(1)[0])
        return float(np.sqrt(own + sum(0.5 * line.amplitude**2 for line in self.lines)))

    def without_lines(self) -> "NoiseModel":
        """This noise without the mains lines, for the question whether hum is what the model lacks."""
        return replace(self, lines=())

    def whitening(self, observed: Bools, time_s: Floats | None = None) -> "Whitening":
        """Map that whitens samples at times (n,), of which only the observed ones, (n,) flags, are there.

        time_s : None for even times.
        """
        time = self._even_times(len(observed)) if time_s is None else time_s
        return Whitening(self, observed, time)

    def whiten(self, residual: Floats, time_s: Floats | None = None) -> Floats:
        """Independent samples (m,) of unit variance from the m finite samples of a residual (n,)."""
        return self.whitening(np.isfinite(residual), time_s)(residual)

    def log_density(self, residual: Floats, time_s: Floats | None = None) -> float:
        """Natural logarithm of the normal density of the finite samples of a residual (n,)."""
        whitening = self.whitening(np.isfinite(residual), time_s)
        white = whitening(residual)
        return -0.5 * float(white @ white) - 0.5 * len(white) * float(np.log(2.0 * np.pi)) - whitening.log_scale

    def draw(self, rng: np.random.Generator, count: int, time_s: Floats | None = None) -> Floats:
        """One realisation (count,), stationary from its first sample; every even piece of time_s starts anew."""
        time = self._even_times(count) if time_s is None else time_s
        lines = line_basis(self.lines, time)
        values = lines @ rng.standard_normal(lines.shape[1])
        for piece in even_pieces(time):
            values[piece] += _draw_autoregression(
                _autoregression_at_rate(self, time[piece]), rng, piece.stop - piece.start
            )
        return np.asarray(values)

    def _even_times(self, count: int) -> Floats:
        """Even times (count,) in s, from 0."""
        return np.asarray(self.step_s * np.arange(count), dtype=np.float64)

    def summary(self) -> Mapping[str, Any]:
        """Numbers of the model for a verdict, by name; amplitudes in the unit of the channel."""
        return {
            "source": self.source,
            "samples": self.samples,
            "rms": self.rms,
            "order": len(self.autoregression.coefficients),
            "innovation_rms": float(np.sqrt(self.autoregression.variance)),
            "coefficients": self.autoregression.coefficients.tolist(),
            "lines": [{"frequency_Hz": line.frequency_Hz, "amplitude": line.amplitude} for line in self.lines],
            "quantisation_step": self.quantisation,
            "sampling_Hz": 1.0 / self.step_s,
        }


class Whitening:
    """A map that whitens any number of signals which share their times and missing samples.

    log_scale : half the logarithm of the determinant of the covariance.
    """

    def __init__(self, noise: NoiseModel, observed: Bools, time_s: Floats) -> None:
        self.noise, self.observed, self.time_s = noise, observed, time_s
        self._pieces = even_pieces(time_s)
        laws = [_autoregression_at_rate(noise, time_s[piece]) for piece in self._pieces]
        self._laws = [(law, law.start_covariance()) for law in laws]
        lines = line_basis(noise.lines, time_s)
        white, deviations = self._innovations(lines)
        self.log_scale = float(np.log(deviations).sum())
        self._directions, self._shrink = np.zeros((len(white), 0)), np.zeros(0)
        if lines.shape[1] and len(white):
            self._directions, spread, _ = np.linalg.svd(white, full_matrices=False)
            self._shrink = 1.0 / np.sqrt(1.0 + spread**2) - 1.0
            self.log_scale += 0.5 * float(np.log1p(spread**2).sum())

    def __call__(self, values: Floats) -> Floats:
        """Whitened signals (m,) or (m, k) from (n,) or (n, k); only the m observed rows come back."""
        columns = values.reshape(len(values), -1)
        white, _ = self._innovations(columns)
        white = white + self._directions @ (self._shrink[:, None] * (self._directions.T @ white))
        return white.reshape(-1, *values.shape[1:])

    def density_in_piece(self, number: int, frequency_Hz: Floats, step_s: float) -> Floats:
        """One-sided power spectral density (k,) at which an even piece, by its number, is whitened, without lines."""
        return self._laws[number][0].spectral_density(frequency_Hz, step_s)

    def _innovations(self, columns: Floats) -> tuple[Floats, Floats]:
        """Prediction errors over their standard deviations (m, k), and the deviations (m,), without the lines."""
        filled = np.where(self.observed[:, None], columns, 0.0)
        errors, deviations = np.empty_like(filled), np.empty(len(filled))
        for piece, (model, start) in zip(self._pieces, self._laws, strict=True):
            errors[piece], deviations[piece] = innovations(
                np.ascontiguousarray(filled[piece]),
                self.observed[piece],
                model.coefficients if len(model.coefficients) else np.zeros(1),
                model.variance,
                start,
            )
        spread = deviations[self.observed]
        return errors[self.observed] / spread[:, None], spread


def _autoregression_at_rate(noise: NoiseModel, time_s: Floats) -> Autoregression:
    """Autoregression for samples at times (t,): the fitted one at its own rate, white of equal power at another."""
    own = noise.autoregression
    if len(time_s) < 2:
        return own
    same = abs(float(np.median(np.diff(time_s))) / noise.step_s - 1.0) < SAME_RATE_TOLERANCE
    if len(own.coefficients) == 0 or (same and is_evenly_sampled(time_s)):
        return own
    return Autoregression(np.zeros(0), float(own.autocovariance(1)[0]))


def _draw_autoregression(model: Autoregression, rng: np.random.Generator, count: int) -> Floats:
    """Stationary samples (count,) of an autoregression."""
    order = len(model.coefficients)
    driven = np.sqrt(model.variance) * rng.standard_normal(count)
    if order == 0:
        return np.asarray(driven)
    before = np.linalg.cholesky(model.start_covariance()) @ rng.standard_normal(order)
    denominator = np.concatenate([[1.0], -model.coefficients])
    values, _ = lfilter([1.0], denominator, driven, zi=lfiltic([1.0], denominator, before))
    return np.asarray(values)


def white_noise(sigma: float, step_s: float, source: str) -> NoiseModel:
    """Model of independent samples of standard deviation sigma, every step_s; source : who states it."""
    return NoiseModel(Autoregression(np.zeros(0), sigma**2), step_s, source, 0)

"""Autoregressive noise, y_t = a_1 y_(t-1) + ... + a_p y_(t-p) + e_t, from several stretches of samples.

Burg's method (Burg, PhD thesis, Stanford 1975; Kay, Modern Spectral Estimation, 1988, section 7.5), with the sums over
all stretches: the estimate is always stable. The order minimises AIC = n ln(variance) + 2 p (Akaike 1974).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import toeplitz

from foundation.arrays import Floats

LARGEST_ORDER = 30
SAMPLES_PER_ORDER = 10


@dataclass(frozen=True)
class Autoregression:
    """An autoregressive model of order p. coefficients : (p,), none for white noise.

    variance : of the innovations e, in the square of the channel's unit.
    """

    coefficients: Floats
    variance: float

    def autocovariance(self, lags: int) -> Floats:
        """Covariances (lags,) of samples 0, 1, ..., lags - 1 apart, by the Yule-Walker equations."""
        order = len(self.coefficients)
        rows = np.eye(order + 1)
        for i in range(order + 1):
            for j, a in enumerate(self.coefficients, start=1):
                rows[i, abs(i - j)] -= a
        known = np.linalg.solve(rows, np.concatenate([[self.variance], np.zeros(order)]))
        values = list(known)
        while len(values) < lags:
            values.append(float(self.coefficients @ np.array(values[: -order - 1 : -1])) if order else 0.0)
        return np.array(values[:lags])

    def start_covariance(self) -> Floats:
        """Covariance (p, p) of p neighbouring samples; (1, 1) for white noise."""
        return np.asarray(toeplitz(self.autocovariance(max(len(self.coefficients), 1))))

    def spectral_density(self, frequency_Hz: Floats, step_s: float) -> Floats:
        """One-sided power spectral density (k,) at frequencies (k,), in the square of the channel's unit per hertz."""
        turns = np.exp(-2j * np.pi * np.outer(frequency_Hz * step_s, np.arange(1, len(self.coefficients) + 1)))
        return np.asarray(2.0 * step_s * self.variance / np.abs(1.0 - turns @ self.coefficients) ** 2)


def fit_autoregression(stretches: Sequence[Floats], least_variance: float = 0.0) -> Autoregression:
    """Fit an autoregression to stretches (n_i,) of zero mean, sampled alike, with the order of least AIC.

    least_variance : the least that the innovations can have, such as the variance of rounding. ValueError when there is
    no sample.
    """
    longest, count = max((len(s) for s in stretches), default=0), sum(len(s) for s in stretches)
    if count == 0:
        raise ValueError("no samples of noise")
    largest = min(LARGEST_ORDER, count // SAMPLES_PER_ORDER, longest - 2)
    best, lowest = Autoregression(np.zeros(0), _mean_square(stretches)), np.inf
    for model in _burg_models(stretches, max(largest, 0)):
        criterion = count * np.log(max(model.variance, np.finfo(float).tiny)) + 2 * len(model.coefficients)
        if criterion < lowest:
            best, lowest = model, criterion
    return _with_least_variance(best, least_variance)


def _with_least_variance(model: Autoregression, least_variance: float) -> Autoregression:
    """The model, or white noise of the least variance where a silent channel would promise less."""
    if model.variance >= least_variance:
        return model
    total = max(least_variance, float(model.autocovariance(1)[0]))
    return Autoregression(np.zeros(0), total)


def _mean_square(stretches: Sequence[Floats]) -> float:
    return float(sum(s @ s for s in stretches) / sum(len(s) for s in stretches))


def _burg_models(stretches: Sequence[Floats], largest: int) -> list[Autoregression]:
    """Models of order 0 to largest by Burg's method; fewer where the innovations vanish."""
    forward, backward = [s.copy() for s in stretches], [s.copy() for s in stretches]
    coefficients, variance = np.zeros(0), _mean_square(stretches)
    models = [Autoregression(coefficients, variance)]
    for _ in range(largest):
        pairs = [(f[1:], b[:-1]) for f, b in zip(forward, backward, strict=True) if len(f) > 1]
        power = sum(float(f @ f + b @ b) for f, b in pairs)
        if power <= 0.0 or variance <= 0.0:
            break
        reflection = 2.0 * sum(float(f @ b) for f, b in pairs) / power
        forward = [f - reflection * b for f, b in pairs]
        backward = [b - reflection * f for f, b in pairs]
        coefficients = np.concatenate([coefficients - reflection * coefficients[::-1], [reflection]])
        variance *= 1.0 - reflection**2
        models.append(Autoregression(coefficients, variance))
    return models

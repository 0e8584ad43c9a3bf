"""Autoregressive noise, y_t = a_1 y_(t-1) + ... + a_p y_(t-p) + e_t, from several stretches of samples.

Burg's method (Burg, PhD thesis, Stanford 1975; Kay, Modern Spectral Estimation, 1988, section 7.5), with the sums over
all stretches: the estimate is always stable. The order minimises AIC = n ln(variance) + 2 p (Akaike 1974).

Exact one-step prediction of an autoregression with missing samples: the Kalman filter of its companion form.

Jones, Technometrics 22 (1980) 389. After p samples in a row the state is known and the filter is the recurrence.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numba as nb
import numpy as np
from scipy.linalg import toeplitz

from geometry.arrays import Bools, Floats

LARGEST_ORDER = 30
SAMPLES_PER_ORDER = 10


@dataclass(frozen=True)
class Autoregression:
    """coefficients : (p,), none for white noise. variance : of the innovations e."""

    coefficients: Floats
    variance: float

    def autocovariance(self, lags: int) -> Floats:
        """Covariances (lags,) at distances 0, 1, ..., lags - 1, by the Yule-Walker equations."""
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
        """Covariance (p, p) of p neighbouring samples."""
        return np.asarray(toeplitz(self.autocovariance(max(len(self.coefficients), 1))))

    def density(self, frequency_Hz: Floats, step_s: float) -> Floats:
        """One-sided power spectral density (k,), in the square of the unit per hertz."""
        turns = np.exp(-2j * np.pi * np.outer(frequency_Hz * step_s, np.arange(1, len(self.coefficients) + 1)))
        return np.asarray(2.0 * step_s * self.variance / np.abs(1.0 - turns @ self.coefficients) ** 2)


def fit_autoregression(stretches: Sequence[Floats], least_variance: float = 0.0) -> Autoregression:
    """Fit to stretches (n_i,) of zero mean, sampled alike. least_variance : of the innovations, as of rounding.

    ValueError when there is no sample.
    """
    longest, count = max((len(s) for s in stretches), default=0), sum(len(s) for s in stretches)
    if count == 0:
        raise ValueError("no samples of noise")
    largest = min(LARGEST_ORDER, count // SAMPLES_PER_ORDER, longest - 2)
    best, lowest = Autoregression(np.zeros(0), _mean_square(stretches)), np.inf
    for model in _burg(stretches, max(largest, 0)):
        criterion = count * np.log(max(model.variance, np.finfo(float).tiny)) + 2 * len(model.coefficients)
        if criterion < lowest:
            best, lowest = model, criterion
    return _no_less_than(best, least_variance)


def _no_less_than(model: Autoregression, least_variance: float) -> Autoregression:
    """The model, or white noise of the least variance where a silent channel would promise better."""
    if model.variance >= least_variance:
        return model
    total = max(least_variance, float(model.autocovariance(1)[0]))
    return Autoregression(np.zeros(0), total)


def _mean_square(stretches: Sequence[Floats]) -> float:
    return float(sum(s @ s for s in stretches) / sum(len(s) for s in stretches))


def _burg(stretches: Sequence[Floats], largest: int) -> list[Autoregression]:
    """The models of order 0 to largest."""
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


@nb.njit(cache=True)
def innovations(
    values: Floats, observed: Bools, coefficients: Floats, variance: float, start: Floats
) -> tuple[Floats, Floats]:
    """Prediction errors (n, k) of the columns of values (n, k), and their standard deviations (n,).

    observed : (n,) False where a sample is missing; its error and deviation are 0. coefficients : (p,), p at least 1.
    start : (p, p) covariance of the p samples before a stretch.
    """
    count, columns = values.shape
    order = len(coefficients)
    errors, deviations = np.zeros((count, columns)), np.zeros(count)
    state, covariance = np.zeros((order, columns)), start.copy()  # of y_n, y_(n-1), ... given all that was seen
    known = 0  # samples seen without a gap up to this one
    deviation = np.sqrt(variance)
    for n in range(count):
        if known >= order and observed[n]:  # all that the state holds are the samples themselves
            deviations[n] = deviation
            for c in range(columns):
                predicted = 0.0
                for j in range(order):
                    predicted += coefficients[j] * values[n - 1 - j, c]
                errors[n, c] = values[n, c] - predicted
            continue
        if known >= order:
            for j in range(order):
                state[j] = values[n - 1 - j]
        if n > 0:
            _predict(state, coefficients)
            if known < order:
                _predict_covariance(covariance, coefficients, variance)
            else:
                _just_predicted(covariance, variance)
        if not observed[n]:
            known = 0
            continue
        deviations[n] = np.sqrt(covariance[0, 0])
        for c in range(columns):
            errors[n, c] = values[n, c] - state[0, c]
        _condition(state, covariance, errors[n])
        known += 1
    return errors, deviations


@nb.njit(cache=True)
def _predict(state: Floats, coefficients: Floats) -> None:
    """F x for the companion matrix F, in place: x (p, k)."""
    order, columns = state.shape
    for c in range(columns):
        newest = 0.0
        for j in range(order):
            newest += coefficients[j] * state[j, c]
        for j in range(order - 1, 0, -1):
            state[j, c] = state[j - 1, c]
        state[0, c] = newest


@nb.njit(cache=True)
def _predict_covariance(covariance: Floats, coefficients: Floats, variance: float) -> None:
    """F P F' + Q, in place."""
    order = len(coefficients)
    row = np.zeros(order)
    corner = variance
    for j in range(order):
        for i in range(order):
            row[j] += coefficients[i] * covariance[i, j]
        corner += coefficients[j] * row[j]
    for i in range(order - 1, 0, -1):
        for j in range(order - 1, 0, -1):
            covariance[i, j] = covariance[i - 1, j - 1]
    for j in range(1, order):
        covariance[0, j] = row[j - 1]
        covariance[j, 0] = row[j - 1]
    covariance[0, 0] = corner


@nb.njit(cache=True)
def _just_predicted(covariance: Floats, variance: float) -> None:
    """All p samples before are known: only the newest is uncertain."""
    for i in range(len(covariance)):
        for j in range(len(covariance)):
            covariance[i, j] = 0.0
    covariance[0, 0] = variance


@nb.njit(cache=True)
def _condition(state: Floats, covariance: Floats, error: Floats) -> None:
    """What the newest sample says of all p, in place. error : (k,) by which it differs from its prediction."""
    order, columns = state.shape
    spread = covariance[0, 0]
    for i in range(order - 1, -1, -1):
        gain = covariance[i, 0] / spread
        for c in range(columns):
            state[i, c] += gain * error[c]
        for j in range(1, order):
            if i > 0:
                covariance[i, j] -= gain * covariance[0, j]
    for j in range(order):
        covariance[0, j] = 0.0
        covariance[j, 0] = 0.0

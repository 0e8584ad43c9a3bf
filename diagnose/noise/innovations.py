"""Exact one-step prediction of an autoregression with missing samples: the Kalman filter of its companion form.

After p samples in a row the state is known and the filter is the recurrence (Jones, Technometrics 22 (1980) 389), so
that gaps alone cost more.
"""

import numba as nb
import numpy as np

from foundation.arrays import Bools, Floats
from solve.compiled import copy_numbers, piece


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
                copy_numbers(values[n - 1 - j], state[j])
        if n > 0:
            _predict_state(state, coefficients)
            if known < order:
                _predict_covariance(covariance, coefficients, variance)
            else:
                _reset_covariance(covariance, variance)
        if not observed[n]:
            known = 0
            continue
        deviations[n] = np.sqrt(covariance[0, 0])
        for c in range(columns):
            errors[n, c] = values[n, c] - state[0, c]
        _condition_on_sample(state, covariance, errors[n])
        known += 1
    return errors, deviations


@piece()
def _predict_state(state: Floats, coefficients: Floats) -> None:
    """Advance the state x (p, k) by one sample, in place: F x with the companion matrix F."""
    order, columns = state.shape
    for c in range(columns):
        newest = 0.0
        for j in range(order):
            newest += coefficients[j] * state[j, c]
        for j in range(order - 1, 0, -1):
            state[j, c] = state[j - 1, c]
        state[0, c] = newest


@piece()
def _predict_covariance(covariance: Floats, coefficients: Floats, variance: float) -> None:
    """Advance the covariance P (p, p) of the state by one sample, in place: F P F' + Q."""
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


@piece()
def _reset_covariance(covariance: Floats, variance: float) -> None:
    """Covariance (p, p) where all p samples before are known, in place: only the newest is uncertain."""
    for i in range(len(covariance)):
        for j in range(len(covariance)):
            covariance[i, j] = 0.0
    covariance[0, 0] = variance


@piece()
def _condition_on_sample(state: Floats, covariance: Floats, error: Floats) -> None:
    """Kalman update of all p samples of the state by the newest one, in place.

    error : (k,) by which the newest sample differs from its prediction.
    """
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

"""The judge of models: how well each predicts a press that it was not fitted to.

The score of a press is the logarithm of the predictive density at its samples (Good, J. R. Stat. Soc. B 14 (1952) 107;
Gneiting and Raftery, J. Am. Stat. Assoc. 102 (2007) 359), in nats. Gains are differences to a rival on the same press.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import reduce
from operator import add

import numpy as np
from scipy.stats import norm

from diagnose.statistics.linear_gaussian import Sums
from foundation.arrays import Floats, Ints


@dataclass(frozen=True)
class Forecast:
    """Predictions of every press from the others. log_scores : (presses,).

    predictions : (n,) expected whitened residual.
    """

    log_scores: Floats
    predictions: Floats


@dataclass(frozen=True)
class Gain:
    """A held-out gain in nats per press. lower : one-sided confidence bound, corrected for the number of candidates."""

    mean: float
    standard_error: float
    lower: float


def leave_press_out(press: Ints) -> tuple[tuple[Ints, Ints], ...]:
    """Split samples by press: for every press (samples to fit, samples held out); press : (n,) label of each sample."""
    return tuple((np.flatnonzero(press != label), np.flatnonzero(press == label)) for label in np.unique(press))


def sums_by_press(residual: Floats, columns: Floats, press: Ints) -> tuple[Sums, ...]:
    """Sums of each press, in ascending order of its label, from residual (n,), columns (n, k) and labels (n,)."""
    return tuple(Sums.from_columns(columns[held], residual[held]) for _, held in leave_press_out(press))


def forecast(residual: Floats, columns: Floats, press: Ints, prior: Callable[[Sums], Floats]) -> Forecast:
    """Predict every press of a residual (n,) by a linear model on columns (n, k) fitted to the others, all whitened.

    prior : deviations (k,) of the parameters, inf for none, from the sums of the fitted presses. ValueError for fewer
    than two presses or where a parameter without a prior shows in one press only.
    """
    folds, parts = leave_press_out(press), sums_by_press(residual, columns, press)
    if len(folds) < 2:
        raise ValueError("one press cannot be held out: at least two are needed")
    scores, predictions = np.empty(len(folds)), np.empty(len(residual))
    for n, (_, held) in enumerate(folds):
        others = reduce(add, parts[:n] + parts[n + 1 :])
        sigma = prior(others)
        scores[n] = (others + parts[n]).log_evidence(sigma) - others.log_evidence(sigma)
        predictions[held] = columns[held] @ others.mean(sigma)
    return Forecast(scores, predictions)


def gain_over_noise(gains: Floats, separations: Floats, level: float, candidates: int = 1) -> Gain:
    """Mean of the gains (presses,) on just these presses, with the error that noise alone makes.

    separations : (presses,) distance in sigma between the two predictions of each press. With predictions a and b and
    white noise the gain |r - b|^2 / 2 - |r - a|^2 / 2 has the variance |a - b|^2, known before the press. For few
    presses of unlike depth and speed, where the scatter over presses is no error.
    """
    error = float(np.linalg.norm(separations)) / len(gains)
    mean = float(gains.mean())
    return Gain(mean, error, mean - float(norm.isf(level / candidates)) * error)

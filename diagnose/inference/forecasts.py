"""How well each model predicts presses that it was not fitted to."""

from dataclasses import dataclass
from functools import reduce
from operator import add

import numpy as np

from diagnose.fit.descent import coordinates
from diagnose.fit.linearised_system import LinearisedSystem
from diagnose.fit.marginal_likelihood import Quadratic
from diagnose.fit.refit import Fitted
from diagnose.fit.samples import Samples
from diagnose.statistics.error_rates import RATES
from diagnose.statistics.held_out import Gain, gain_over_noise, leave_press_out
from diagnose.statistics.linear_gaussian import Sums
from foundation.arrays import Floats, Ints

FLAT = 1e4  # sigma of the noise: a prior for what has none, where nothing else limits it


@dataclass(frozen=True)
class Forecasted:
    """log_scores : (presses,). predicted : (n,) whitened, of the recording. system : in whose metric.

    spread : per press, columns (n, k) whose unit normal combinations are the uncertainty of the prediction.
    fold : (n,) label of what was held out together: a press, unless told otherwise.
    """

    log_scores: Floats
    predicted: Floats
    system: LinearisedSystem
    spread: tuple[Floats, ...]
    fold: Ints


def forecasted(
    samples: Samples, system: LinearisedSystem, fit: Fitted | None = None, fold: Ints | None = None
) -> Forecasted:
    """Leave one press out, linear about the fit to all; parameters with a normal prior as wide as their range.

    Where there is one press only its phases take the place of presses. Where there is one phase only nothing can be
    left out, and the score is the evidence under the priors: what Bayes' theorem expects of the model beforehand.
    """
    columns, sigma, residual = system.nuisance_design, system.sigma, system.residual
    if fit is not None:
        width = np.array([c.high - c.low for c in coordinates(fit.candidates)])
        columns, sigma = np.column_stack([columns, fit.slopes[system.informative]]), np.concatenate([sigma, width])
        residual = residual + fit.slopes @ fit.values
    return _left_out(
        samples, system, system.weighted_rows(columns), sigma, residual, samples.fold if fold is None else fold
    )


def separation(one: Forecasted, other: Forecasted) -> Floats:
    """Sigma (presses,) between two forecasts, in the predictive covariance of the first."""
    system = one.system
    apart = system.weighted_rows(one.predicted - other.predicted)
    folds = leave_press_out(one.fold[system.informative])
    return np.array([
        np.sqrt(max(Quadratic(spread, np.ones(spread.shape[1])).square(apart[held]), 0.0))
        for spread, (_, held) in zip(one.spread, folds, strict=True)
    ])  # fmt: skip


def gained(one: Forecasted, rival: Forecasted, candidates: int) -> Gain:
    """Nats per fold, with a lower bound that is corrected for the number of candidates."""
    gains = one.log_scores - rival.log_scores
    return gain_over_noise(gains, separation(one, rival), RATES.level, candidates)


def _left_out(
    samples: Samples, system: LinearisedSystem, columns: Floats, sigma: Floats, residual: Floats, fold: Ints
) -> Forecasted:
    kept = sigma > 0.0
    columns, sigma = columns[:, kept], sigma[kept]
    white, informative = system.weighted_rows(residual), np.flatnonzero(system.informative)
    folds = leave_press_out(fold[informative])
    sums = [Sums.from_columns(columns[held], white[held]) for _, held in folds]
    nothing = Sums(np.zeros((len(sigma), len(sigma))), np.zeros(len(sigma)), 0.0, 0)
    if len(folds) < 2:
        sigma = np.minimum(sigma, FLAT / np.maximum(np.linalg.norm(columns, axis=0), 1.0))
    scores, spread, predicted = np.empty(len(folds)), [], np.zeros(len(residual))
    for n, (_, held) in enumerate(folds):
        others = reduce(add, sums[:n] + sums[n + 1 :], nothing)
        rows = informative[held]
        scale = float(np.log(system.weight[rows]).sum())
        scores[n] = (others + sums[n]).log_evidence(sigma) - others.log_evidence(sigma) + scale
        precision = others.gram + np.diag(1.0 / sigma**2)
        length = np.sqrt(np.diag(precision))
        root = np.linalg.cholesky(precision / np.outer(length, length) + 1e-12 * np.eye(len(length)))
        own = columns[held] / length
        half = np.asarray(np.linalg.solve(root, own.T).T, dtype=np.float64)
        spread.append(half)
        mean = half @ np.linalg.solve(root, others.moment / length)
        predicted[rows] = (samples.recorded_vector - residual)[rows] + mean / system.weight[rows]
    return Forecasted(scores, predicted, system, tuple(spread), fold)

"""How well each model predicts presses that it was not fitted to."""

from dataclasses import dataclass
from functools import reduce
from operator import add

import numpy as np

from diagnose.inference.descent import coordinates
from diagnose.inference.quadratic import Quadratic
from diagnose.inference.refit import Fitted
from diagnose.inference.samples import Samples
from diagnose.inference.system import System
from diagnose.statistics.held_out import leave_press_out
from diagnose.statistics.linear_gaussian import Sums
from mesh.types import Floats

FLAT = 1e4  # sigma of the noise: a prior for what has none, where nothing else limits it


@dataclass(frozen=True)
class Forecasted:
    """log_scores : (presses,). predicted : (n,) whitened, of the recording. system : in whose metric.

    spread : per press, columns (n, k) whose unit normal combinations are the uncertainty of the prediction.
    """

    log_scores: Floats
    predicted: Floats
    system: System
    spread: tuple[Floats, ...]


def forecasted(samples: Samples, system: System, fit: Fitted | None = None) -> Forecasted:
    """Leave one press out, linear about the fit to all; parameters with a normal prior as wide as their range.

    Where there is one press only its phases take the place of presses. Where there is one phase only nothing can be
    left out, and the score is the evidence under the priors: what Bayes' theorem expects of the model beforehand.
    """
    columns, sigma, residual = system.excused, system.sigma, system.residual
    if fit is not None:
        width = np.array([c.high - c.low for c in coordinates(fit.candidates)])
        columns, sigma = np.column_stack([columns, fit.slopes[system.live]]), np.concatenate([sigma, width])
        residual = residual + fit.slopes @ fit.values
    return _left_out(samples, system, system.weighted(columns), sigma, residual)


def separation(samples: Samples, one: Forecasted, other: Forecasted) -> Floats:
    """Sigma (presses,) between two forecasts, in the predictive covariance of the first."""
    system = one.system
    apart = system.weighted(one.predicted - other.predicted)
    folds = leave_press_out(samples.fold[system.live])
    return np.array([
        np.sqrt(max(Quadratic(spread, np.ones(spread.shape[1])).square(apart[held]), 0.0))
        for spread, (_, held) in zip(one.spread, folds, strict=True)
    ])  # fmt: skip


def _left_out(samples: Samples, system: System, columns: Floats, sigma: Floats, residual: Floats) -> Forecasted:
    kept = sigma > 0.0
    columns, sigma = columns[:, kept], sigma[kept]
    white, live = system.weighted(residual), np.flatnonzero(system.live)
    folds = leave_press_out(samples.fold[live])
    sums = [Sums.of(columns[held], white[held]) for _, held in folds]
    nothing = Sums(np.zeros((len(sigma), len(sigma))), np.zeros(len(sigma)), 0.0, 0)
    if len(folds) < 2:
        sigma = np.minimum(sigma, FLAT / np.maximum(np.linalg.norm(columns, axis=0), 1.0))
    scores, spread, predicted = np.empty(len(folds)), [], np.zeros(len(residual))
    for n, (_, held) in enumerate(folds):
        others = reduce(add, sums[:n] + sums[n + 1 :], nothing)
        rows = live[held]
        scale = float(np.log(system.weight[rows]).sum())
        scores[n] = (others + sums[n]).log_evidence(sigma) - others.log_evidence(sigma) + scale
        precision = others.gram + np.diag(1.0 / sigma**2)
        length = np.sqrt(np.diag(precision))
        root = np.linalg.cholesky(precision / np.outer(length, length) + 1e-12 * np.eye(len(length)))
        own = columns[held] / length
        half = np.asarray(np.linalg.solve(root, own.T).T, dtype=np.float64)
        spread.append(half)
        mean = half @ np.linalg.solve(root, others.moment / length)
        predicted[rows] = (samples.recorded - residual)[rows] + mean / system.weight[rows]
    return Forecasted(scores, predicted, system, tuple(spread))

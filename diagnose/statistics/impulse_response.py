"""An impulse response with a ridge prior: any linear memory of the drive, fitted to some presses, predicts the others.

residual(t) = sum over lags of h_k times the mean drive over the k-th lag interval: a finite impulse response, constant
over intervals that double, so that a few coefficients reach from one sample to the whole press. Ridge prior
h ~ N(0, s^2), with s from the evidence of the presses it is fitted to (MacKay, Neural Comput. 4 (1992) 415; for impulse
responses Pillonetto and De Nicolao, Automatica 46 (2010) 81).
"""

from itertools import pairwise

import numpy as np
from scipy.optimize import minimize_scalar

from diagnose.statistics.held_out import Forecast, forecast
from diagnose.statistics.linear_gaussian import Sums
from foundation.arrays import Bools, Floats, Ints

STRENGTHS_SIGMA = np.logspace(-2.0, 6.0, 17)
"""Strengths of the response at which s is sought, in sigma of the noise over all samples."""


def doubling_edges(longest: int) -> Ints:
    """Edges (k + 1,) of lag intervals in samples: [0, 1), [1, 2), [2, 4), [4, 8) ... up to at least `longest`."""
    return np.concatenate([[0], 2 ** np.arange(int(np.ceil(np.log2(max(longest, 1)))) + 1)])


def lagged_means(drive: Floats, edges: Ints) -> Floats:
    """Columns (n, k): means of a drive (n,) over lags [edges[k], edges[k + 1]); at rest before the first sample.

    Edges are in samples: runs at other rates need their own, equal in seconds. Give several drives, such as its
    square, or each run apart, for more freedom. Whiten the columns afterwards.
    """
    past = np.concatenate([np.zeros(int(edges[-1])), np.cumsum(drive - drive[0])])
    before = np.concatenate([[0.0], past])  # before[i + 1] is the sum up to and with i
    now = int(edges[-1]) + np.arange(len(drive)) + 1
    return np.column_stack([(before[now - a] - before[now - b]) / (b - a) for a, b in pairwise(edges)])


def ridge_by_evidence(sums: Sums, prior_sigma: Floats, ridge: Bools) -> float:
    """Common prior sigma of the coefficients marked True in ridge (k,) that maximises the evidence.

    prior_sigma : (k,) of all coefficients, read where ridge is False: the nuisances.
    """
    strength = float(np.sqrt(np.trace(sums.gram[np.ix_(ridge, ridge)])))
    if strength == 0.0:
        return 0.0

    def loss(log_sigma: float) -> float:
        return -sums.log_evidence(np.where(ridge, np.exp(log_sigma), prior_sigma))

    grid = np.log(STRENGTHS_SIGMA / strength)
    best = int(np.argmin([loss(value) for value in grid]))
    around = (grid[max(best - 1, 0)], grid[min(best + 1, len(grid) - 1)])
    return float(np.exp(minimize_scalar(loss, bounds=around, method="bounded").x))


def impulse_response_forecast(
    residual: Floats, nuisances: Floats, prior_sigma: Floats, memory: Floats, press: Ints
) -> Forecast:
    """Forecast of every press by nuisances (n, p) plus an impulse response on memory (n, k), fitted to the others.

    All are whitened. prior_sigma : (p,) of the nuisances. The ridge is chosen anew from the presses that are fitted.
    """
    columns = np.column_stack([nuisances, memory])
    ridge = np.arange(columns.shape[1]) >= nuisances.shape[1]
    padded = np.concatenate([prior_sigma, np.zeros(memory.shape[1])])
    return forecast(
        residual, columns, press, lambda sums: np.where(ridge, ridge_by_evidence(sums, padded, ridge), padded)
    )

"""A Gaussian process over the 64 cells: what one axis of a touch is expected to be for each of them.

Its covariance is that of a constant, of one independent part for each raised dot, and of a part that is alike in cells
which differ by few dots. The first two are superposition; the third is what superposition misses.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from scipy.optimize import minimize

from foundation.arrays import Floats, Ints
from softdot.reading.cells import DOTS, KINDS_OF_CELL

LIKENESS_DOTS, LOAD_EXPONENT = 1.5, 0.25
"""Number of dots over which likeness falls by e; an answer to n dots falls as n to the minus exponent, as they share
the load.
"""
USUAL_SHARES, PULL = (0.3, 0.3, 0.5), 0.1
"""Variance of each part over that of the axis where touches do not tell, and how strongly (in logarithms, as 1 over a
variance) they are held there.
"""


@dataclass(frozen=True)
class ExpectedCells:
    """Mean and variance (64,) of the mean touch of each cell along one axis, and the mean by superposition alone."""

    mean: Floats
    variance: Floats
    dot_mean: Floats


def parts_of_covariance() -> Floats:
    """The three parts (3, 64, 64), each of the order of one."""
    dots = (np.arange(KINDS_OF_CELL)[:, None] >> np.arange(DOTS) & 1).astype(float)
    shared = load_shares(np.arange(KINDS_OF_CELL))
    apart = np.abs(dots[:, None] - dots).sum(axis=2)
    load = np.outer(shared, shared)
    return np.array([np.ones_like(load), dots @ dots.T * load, np.exp(-apart / LIKENESS_DOTS) * load])


def load_shares(cells: Ints) -> Floats:
    """By which the answer to each dot of cells (k,) falls, as dots share the load."""
    count = (cells[:, None] >> np.arange(DOTS) & 1).sum(axis=1)
    return np.asarray(np.maximum(count, 1.0) ** -LOAD_EXPONENT)


def expect_cells(parts: Floats, cells: Ints, means: Floats, noise: Floats) -> ExpectedCells:
    """What is expected of all cells, after means (k,) of some cells (k,) whose variance of scatter is noise (k,).

    parts : those of the covariance. Their variances are those of the largest evidence.
    """
    among = parts[:, cells][:, :, cells]
    size = float(means.var()) + 1e-12
    start = np.log(USUAL_SHARES)
    found = minimize(
        _negative_evidence, start, (among, means, noise, size, start), jac=True, method="L-BFGS-B",
        bounds=[(-10.0, 5.0)] * len(start), options={"maxiter": 40},
    )  # fmt: skip
    variances = np.exp(found.x) * size
    factor = cho_factor(np.tensordot(variances, among, 1) + np.diag(noise + 1e-9 * size))
    to_all = variances[:, None, None] * parts[:, :, cells]
    weights = cho_solve(factor, means)
    known = to_all.sum(axis=0)
    variance = np.diagonal(np.tensordot(variances, parts, 1)) - np.einsum("ij,ji->i", known, cho_solve(factor, known.T))
    return ExpectedCells(known @ weights, np.maximum(variance, 1e-12), (to_all[0] + to_all[1]) @ weights)


def _negative_evidence(
    logs: Floats, among: Floats, means: Floats, noise: Floats, size: float, start: Floats
) -> tuple[float, Floats]:
    """Negative logarithm of the evidence, with the pull to the start, and its gradient by the logarithms."""
    shares = np.exp(logs) * size
    factor = cho_factor(np.tensordot(shares, among, 1) + np.diag(noise + 1e-9 * size), lower=True)
    weights = cho_solve(factor, means)
    away = logs - start
    value = 0.5 * means @ weights + np.log(np.diag(factor[0])).sum() + 0.5 * PULL * away @ away
    inner = 0.5 * (cho_solve(factor, np.eye(len(means))) - np.outer(weights, weights))
    return float(value), shares * np.einsum("ij,kij->k", inner, among) + PULL * away

"""A Gaussian process over the 64 cells and the lateral places: what one axis of a touch is expected to be for each.

Its covariance over cells is that of a constant, of one independent part for each raised dot, and of parts that are
alike in cells of which the left column, the right one or both differ by few dots; all of them are alike at places that
are near.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from scipy.optimize import minimize

from foundation.arrays import Floats, Ints
from softdot.reading.cells import DOTS, KINDS_OF_CELL

LIKENESS_DOTS, LOAD_EXPONENT = 1.5, 0.15
"""Number of dots over which likeness falls by e; an answer to a dot falls as the number of dots, and that of those in
its column, to the minus exponent, as they share the load.
"""
USUAL_SHARES, PULL, MOST_STEPS = (0.3, 0.3, 0.25, 0.25, 0.25), 1.0, 8
"""Variance of each part over that of the axis where touches do not tell, how strongly (in logarithms, as 1 over a
variance) they are held there, and steps in which the largest evidence is sought.
"""


@dataclass(frozen=True)
class Expected:
    """Mean and variance (64, p) of the mean touch of each cell at each place along one axis."""

    mean: Floats
    variance: Floats


def parts_of_covariance() -> Floats:
    """The five parts (5, 64, 64), each of the order of one."""
    dots = (np.arange(KINDS_OF_CELL)[:, None] >> np.arange(DOTS) & 1).astype(float)
    answers = answers_to_dots(np.arange(KINDS_OF_CELL))
    shared = np.maximum(dots.sum(axis=1), 1.0) ** (-2.0 * LOAD_EXPONENT)
    load = np.outer(shared, shared)
    apart = np.abs(dots[:, None] - dots).reshape(*load.shape, 2, -1).sum(axis=3)
    alike = [np.exp(-one / LIKENESS_DOTS) * load for one in (*np.moveaxis(apart, 2, 0), apart.sum(axis=2))]
    return np.array([np.ones_like(load), answers @ answers.T, *alike])


def answers_to_dots(cells: Ints) -> Floats:
    """The answer (k, 6) to each dot of cells (k,), 0 where it is not raised, that falls as dots share the load."""
    dots = (cells[:, None] >> np.arange(DOTS) & 1).astype(np.float64)
    of_column = np.repeat(dots.reshape(len(cells), 2, -1).sum(axis=2), DOTS // 2, axis=1)
    count = np.maximum(dots.sum(axis=1, keepdims=True) * of_column, 1.0)
    return np.asarray(dots * count**-LOAD_EXPONENT)


def expect_cells(parts: Floats, alike: Floats, states: Ints, means: Floats, noise: Floats) -> Expected:
    """What is expected of all cells at all places, after means (m,) with a variance of noise (m,) at some states (m,).

    parts : those of the covariance over cells, whose variances are those of the largest evidence. alike (p, p) :
    likeness of places. A state is the number of a cell times p, and that of a place.
    """
    cells, places = np.divmod(states, len(alike))
    among = parts[:, cells][:, :, cells] * alike[places][:, places]
    size = float((means**2).mean()) + 1e-12
    start = np.log(USUAL_SHARES)
    found = minimize(
        _negative_evidence, start, (among, means, noise, size, start), jac=True, method="L-BFGS-B",
        bounds=[(-10.0, 5.0)] * len(start), options={"maxiter": MOST_STEPS},
    )  # fmt: skip
    variances = np.exp(found.x) * size
    factor = cho_factor(np.tensordot(variances, among, 1) + np.diag(noise + 1e-9 * size))
    whole = np.tensordot(variances, parts, 1)
    known = np.kron(whole[:, cells], np.ones((len(alike), 1))) * np.tile(alike[:, places], (KINDS_OF_CELL, 1))
    variance = np.repeat(np.diag(whole), len(alike)) - (known * cho_solve(factor, known.T).T).sum(axis=1)
    shape = (KINDS_OF_CELL, len(alike))
    return Expected((known @ cho_solve(factor, means)).reshape(shape), np.maximum(variance, 1e-12).reshape(shape))


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

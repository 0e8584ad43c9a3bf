"""How touches of one cell scatter: by a few causes whose effect depends on the dots, and by noise.

A cause is drawn anew in each touch, such as the gain of the finger. What it does is the same part
for all cells and a part for each raised dot, so that it is known too for cells that were never touched: factor analysis
by expectation and maximisation (Rubin and Thayer, Psychometrika 47 (1982) 69) with such loadings.
"""

import numpy as np

from foundation.arrays import Floats, Ints
from softdot.reading.cells import DOTS, KINDS_OF_CELL

CAUSES, RIDGE, ROUNDS, SHRINKAGE = 2, 5.0, 40, 0.05
"""Number of causes; touches for which the guess counts that a cause does nothing; rounds; share by which covariances
between axes of the noise are lowered.
"""
START_SHARE, NOISE_SHARE, START_DEVIATION = 0.5, 0.6, 0.03
"""Of the covariance: what the causes and the noise begin with; and by which random dots' parts begin, of its deviation.
"""


def scatter_of_cells(residuals: Floats, cells: Ints) -> Floats:
    """Covariance (64, d, d) of touches of each cell.

    residuals (n, d) : touches less the mean of their own cell, cells (n,).
    """
    count, size = residuals.shape
    causes = min(CAUSES, size)
    residuals = residuals * np.sqrt(count / (count - len(np.unique(cells))))
    dots = (np.arange(KINDS_OF_CELL)[:, None] >> np.arange(DOTS) & 1).astype(float)
    features = np.hstack([np.ones((KINDS_OF_CELL, 1)), dots])
    noise = _shrunk(residuals.T @ residuals / count)
    loadings = _start(noise, causes, features.shape[1])
    noise = NOISE_SHARE * noise
    for _ in range(ROUNDS):
        loadings, noise = _round(residuals, cells, features, loadings, noise)
    of_cells = np.einsum("cf,kfd->cdk", features, loadings)
    return np.asarray(noise + of_cells @ of_cells.transpose(0, 2, 1))


def _start(covariance: Floats, causes: int, features: int) -> Floats:
    """Loadings (k, f, d) to begin with: the largest axes for all cells alike, little by the dots."""
    size, axes = np.linalg.eigh(covariance)
    random = np.random.default_rng(0).standard_normal((causes, features, len(size)))
    loadings = START_DEVIATION * random * np.sqrt(np.diag(covariance))
    loadings[:, 0] = (axes[:, ::-1][:, :causes] * np.sqrt(START_SHARE * size[::-1][:causes])).T
    return np.asarray(loadings)


def _round(residuals: Floats, cells: Ints, features: Floats, loadings: Floats, noise: Floats) -> tuple[Floats, Floats]:
    """Loadings (k, f, d) and covariance (d, d) of the noise after one round."""
    causes, kinds, size = loadings.shape
    of_cells = np.einsum("cf,kfd->cdk", features, loadings)
    weighed = np.linalg.solve(noise, of_cells)
    spread = np.linalg.inv(np.eye(causes) + of_cells.transpose(0, 2, 1) @ weighed)
    drawn = np.einsum("nkl,ndl,nd->nk", spread[cells], weighed[cells], residuals)
    squares = spread[cells] + drawn[:, :, None] * drawn[:, None]
    own = features[cells]
    normal = np.einsum("nkl,nf,ng->kflg", squares, own, own).reshape(causes * kinds, -1)
    right = np.einsum("nk,nf,nd->kfd", drawn, own, residuals).reshape(causes * kinds, size)
    loadings = np.linalg.solve(normal + RIDGE * np.eye(len(normal)), right).reshape(causes, kinds, size)
    of_touches = np.einsum("nf,kfd->nkd", own, loadings)
    cross = residuals.T @ np.einsum("nk,nkd->nd", drawn, of_touches)
    explained = np.einsum("nkl,nkd,nle->de", squares, of_touches, of_touches, optimize=True)
    return loadings, _shrunk((residuals.T @ residuals - cross - cross.T + explained) / len(residuals))


def _shrunk(covariance: Floats) -> Floats:
    """The covariance with smaller values beside its diagonal, on which a trace is added."""
    own = np.diag(np.diag(covariance))
    return np.asarray((1.0 - SHRINKAGE) * covariance + SHRINKAGE * own + 1e-9 * np.eye(len(own)) * np.trace(own))

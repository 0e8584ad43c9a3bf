"""The error of the whole family of cells, by a parametric bootstrap of their maximum.

Draws follow the null exactly: white noise, less the directions that refitted free nuisances take away, over a noise
variance that was itself estimated. They need no samples: in each cell the noise splits into its part along the
nuisances (normal) and the rest (chi-square).
"""

import numpy as np
from scipy.linalg import qr

from diagnose.statistics.hypotheses import Hypotheses
from foundation.arrays import Floats, Ints


def null_energies(hypotheses: Hypotheses, cell: Ints, free: Floats, draws: int, rng: np.random.Generator) -> Floats:
    """Draws (draws, c) of the energies of all cells under noise alone.

    cell : (n,) number of the cell of each coefficient. free : (n, f) coefficients of the orthonormal directions of the
    free nuisances.
    """
    count = len(hypotheses.degrees)
    by_cell = free[np.argsort(cell, kind="stable")]
    roots = [_gram_root(rows) for rows in np.split(by_cell, np.cumsum(np.bincount(cell))[:-1])]
    along = [rng.standard_normal((draws, len(root))) for root in roots]
    fitted = sum((part @ root for part, root in zip(along, roots, strict=True)), np.zeros((draws, free.shape[1])))
    energies = np.empty((draws, count))
    for c, (part, root) in enumerate(zip(along, roots, strict=True)):
        rest = hypotheses.degrees[c] - len(root)
        energies[:, c] = ((part - fitted @ root.T) ** 2).sum(axis=1)
        if rest > 0.0:
            energies[:, c] += rng.chisquare(rest, draws)
    return energies / _estimated_variances(hypotheses.noise_degrees, draws, rng)[:, hypotheses.noise]


def step_down_p_values(observed: Floats, null: Floats) -> Floats:
    """Family-wise p-values (h,) of scores (h,) given null draws (b, h) of all of them.

    Step-down maxT (Westfall and Young, Resampling-Based Multiple Testing, 1993, algorithm 4.1'; Ge, Dudoit and Speed,
    Test 12 (2003) 1). The smallest is the p-value of the maximum statistic. Counts include the observation (Phipson
    and Smyth, Stat. Appl. Genet. Mol. Biol. 9 (2010) 39): no p-value is below 1 / (b + 1).
    """
    order = np.argsort(observed)[::-1]
    largest_left = np.maximum.accumulate(null[:, order[::-1]], axis=1)[:, ::-1]
    exceeded = (1 + (largest_left >= observed[order]).sum(axis=0)) / (1 + len(null))
    adjusted = np.empty(len(observed))
    adjusted[order] = np.maximum.accumulate(exceeded)
    return adjusted


def _gram_root(rows: Floats) -> Floats:
    """Matrix (min(d, f), f) whose columns have the same inner products as those of rows (d, f)."""
    return np.asarray(qr(rows, mode="economic")[1])


def _estimated_variances(degrees: Floats, draws: int, rng: np.random.Generator) -> Floats:
    """Draws (draws, g) of estimates of a unit variance with these degrees of freedom (g,), inf where it is known."""
    known = np.isinf(degrees)
    estimated = np.ones((draws, len(degrees)))
    estimated[:, ~known] = rng.chisquare(degrees[~known], (draws, int((~known).sum()))) / degrees[~known]
    return estimated

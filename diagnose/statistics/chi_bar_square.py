"""The chi-bar-square distribution: that of the score statistic over a cone of allowed signs.

Kudo, Biometrika 50 (1963) 403; Shapiro, Int. Stat. Rev. 56 (1988) 49; Silvapulle and Sen, Constrained Statistical
Inference, 2005, section 3.4. The weight of j degrees of freedom is the chance that just j parameters come out positive:
w_j = sum over faces a, |a| = j, of P(N(0, I_aa^-1) > 0) P(N(0, I_bb - I_ba I_aa^-1 I_ab) > 0), b the others.
Both covariances come from a triangle R with R' R = I, whose square alone would lose what nearly parallel columns differ
by: with a before b they are (R_aa' R_aa)^-1 and R_bb' R_bb, and no rounding makes them indefinite.
"""

from itertools import combinations
from math import comb

import numpy as np
from scipy.linalg import solve_triangular
from scipy.stats import chi2, multivariate_normal
from scipy.stats import f as f_distribution

from foundation.arrays import Floats

MOST_NON_NEGATIVE = 8  # non-negative parameters: 256 faces
LARGEST_CLOSED_FORM = 3  # dimensions of the orthants that have a closed form
ORTHANT_ERROR = 1e-3  # of the others, relative: no level is better known
ROUGH_ERROR, LEAST_ERROR = 1e-3, 1e-5  # absolute, of a first estimate and of what is next to nothing


def chi_bar_weights(columns: Floats) -> Floats:
    """Weights (q + 1,) of 0 to q degrees of freedom for columns (n, q), the sensitivities to non-negative parameters.

    n is at least q, and the columns are independent, in any units. ValueError for more than MOST_NON_NEGATIVE.
    """
    count = columns.shape[1]
    if count > MOST_NON_NEGATIVE:
        raise ValueError(f"{count} non-negative parameters in one candidate; at most {MOST_NON_NEGATIVE}")
    found = np.zeros(count + 1)
    left_out = _degrees_by_difference(count)
    for positive in set(range(count + 1)) - set(left_out):
        for face in combinations(range(count), positive):
            found[positive] += _face_probability(columns, face)
    for positive in left_out:
        found[positive] = max(0.5 - found[positive % 2 :: 2].sum(), 0.0)
    return np.asarray(found / found.sum())  # the sum is one but for the numerical orthants


def _degrees_by_difference(count: int) -> list[int]:
    """Degrees of freedom whose weights follow from the others: one even and one odd, with the most numerical orthants.

    Even weights make one half together, and so do odd ones (Silvapulle and Sen, proposition 3.6.1). None where all
    orthants have a closed form.
    """
    numerical = {j: comb(count, j) for j in range(count + 1) if max(j, count - j) > LARGEST_CLOSED_FORM}
    of_each = [[j for j in numerical if j % 2 == odd] for odd in (0, 1)]
    return [max(some, key=numerical.__getitem__) for some in of_each if some]


def chi_bar_survival(statistic: float, weight: Floats, unbounded: int = 0, noise_degrees: float = np.inf) -> float:
    """P(chi-bar-square >= statistic) for weights (q + 1,).

    unbounded : number of parameters of either sign, which always add a degree of freedom. noise_degrees : degrees of
    freedom of the estimated noise variance, inf when it is known; each term is then d F(d, noise_degrees).
    """
    if statistic <= 0.0:
        return 1.0
    terms = ((w, j + unbounded) for j, w in enumerate(weight))
    return float(sum(w * f_tail(statistic, degrees, noise_degrees) for w, degrees in terms if degrees > 0))


def orthant_probability(covariance: Floats) -> float:
    """P(all components of N(0, covariance) are positive); closed forms up to three (Sheppard 1898, David 1953)."""
    count = len(covariance)
    if count == 0:
        return 1.0
    deviation = np.sqrt(np.diag(covariance))
    correlation = np.clip(covariance / np.outer(deviation, deviation), -1.0, 1.0)
    if count <= LARGEST_CLOSED_FORM:
        above = correlation[np.triu_indices(count, 1)]
        return float(0.5**count + 0.5 ** (count - 1) * np.arcsin(above).sum() / np.pi)
    rough = _numerical_orthant(correlation, ROUGH_ERROR)
    return _numerical_orthant(correlation, max(ORTHANT_ERROR * rough, LEAST_ERROR))


def _numerical_orthant(correlation: Floats, error: float) -> float:
    """P(all components of N(0, correlation) are positive) by quasi-random points, to this absolute error."""
    seed = np.random.default_rng(0)
    law = multivariate_normal(cov=correlation, allow_singular=True, seed=seed, abseps=error, releps=0.0)
    return float(law.cdf(np.zeros(len(correlation))))


def _face_probability(columns: Floats, face: tuple[int, ...]) -> float:
    """Probability that just the parameters of a face come out positive, for columns (n, q)."""
    others = [n for n in range(columns.shape[1]) if n not in face]
    triangle: Floats = np.linalg.qr(columns[:, [*face, *others]])[1]
    first = len(face)
    inverse = solve_triangular(triangle[:first, :first], np.eye(first))
    outer = triangle[first:, first:]
    return orthant_probability(inverse @ inverse.T) * orthant_probability(outer.T @ outer)


def f_tail(statistic: float, degrees: int, noise_degrees: float) -> float:
    """P(F or chi-square >= statistic), the latter where the variance of the noise is known."""
    if np.isinf(noise_degrees):
        return float(chi2.sf(statistic, degrees))
    return float(f_distribution.sf(statistic / degrees, degrees, noise_degrees))

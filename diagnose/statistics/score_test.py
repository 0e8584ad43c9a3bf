"""Screening: does one candidate's sensitivity show in the residual, after all that may float has floated? No refit.

Rao's efficient score test (Proc. Camb. Phil. Soc. 44 (1948) 50; Bera and Bilias, J. Stat. Plan. Inference 97 (2001) 9):
nuisances are taken out of residual and sensitivities beforehand (nuisance.py). With white noise of unit variance the
statistic is the gain in the sum of squares of the linearised fit, over the cone of allowed signs.

residual = tangent @ nuisance + white noise, nuisance ~ N(0, prior_sigma^2). The marginal covariance is
1 + T P T'; its symmetric root is applied through the singular values of T P^(1/2) (Rasmussen and Williams, Gaussian
Processes for Machine Learning, 2006, appendix A.3). An infinite prior_sigma is the orthogonal projection, with the
restricted likelihood (Harville, Biometrika 61 (1974) 383).

Kudo, Biometrika 50 (1963) 403; Shapiro, Int. Stat. Rev. 56 (1988) 49; Silvapulle and Sen, Constrained Statistical
Inference, 2005, section 3.4. The weight of j degrees of freedom is the chance that just j parameters come out positive:
w_j = sum over faces a, |a| = j, of P(N(0, I_aa^-1) > 0) P(N(0, I_bb - I_ba I_aa^-1 I_ab) > 0), b the others.
"""

from dataclasses import dataclass
from itertools import combinations
from math import comb

import numpy as np
from scipy.optimize import nnls
from scipy.stats import chi2, multivariate_normal
from scipy.stats import f as f_distribution

from geometry.arrays import Bools, Floats


def orthonormal(columns: Floats) -> Floats:
    """An orthonormal basis (n, r) of the span of columns (n, k); columns of any length count alike."""
    length = np.linalg.norm(columns, axis=0)
    unit = columns[:, length > 0.0] / length[length > 0.0]
    basis, spread, _ = np.linalg.svd(unit, full_matrices=False)
    return np.asarray(basis[:, spread > np.finfo(float).eps * max(columns.shape)])


class Marginal:
    """Whitens once more, so that the nuisances no longer show.

    free : (n, f) orthonormal directions that are lost to nuisances without a prior.
    degrees : n - f, the directions that are left.
    log_scale : half the logarithm of the determinant of the covariance in those directions.
    """

    def __init__(self, tangent: Floats, prior_sigma: Floats) -> None:
        """tangent : (n, p) whitened sensitivities to the nuisances. prior_sigma : (p,) in their units, inf for free."""
        unbounded = np.isinf(prior_sigma)
        self.free = orthonormal(tangent[:, unbounded])
        self.degrees: int = len(tangent) - self.free.shape[1]
        bounded = self._off_free(tangent[:, ~unbounded] * prior_sigma[~unbounded])
        self._directions, spread, _ = np.linalg.svd(bounded, full_matrices=False)
        self._shrink = 1.0 / np.sqrt(1.0 + spread**2) - 1.0
        self.log_scale = 0.5 * float(np.log1p(spread**2).sum())

    def __call__(self, values: Floats) -> Floats:
        """Values (n,) or (n, k) in units of the marginal noise; a white residual comes out white but for `free`."""
        left = self._off_free(values)
        return np.asarray(left + self._directions @ (self._shrink * (self._directions.T @ left).T).T)

    def log_density(self, residual: Floats) -> float:
        """Natural logarithm of the marginal normal density of a residual (n,), in the directions that are left."""
        white = self(residual)
        return -0.5 * (float(white @ white) + self.degrees * float(np.log(2.0 * np.pi))) - self.log_scale

    def _off_free(self, values: Floats) -> Floats:
        return np.asarray(values - self.free @ (self.free.T @ values))


def posterior(residual: Floats, tangent: Floats, prior_sigma: Floats) -> tuple[Floats, Floats]:
    """Mean (p,) and covariance (p, p) of the nuisances given a residual (n,).

    LinAlgError where a nuisance without a prior leaves no trace.
    """
    covariance = np.asarray(np.linalg.inv(tangent.T @ tangent + np.diag(1.0 / prior_sigma**2)), dtype=np.float64)
    return covariance @ (tangent.T @ residual), covariance


MOST = 8  # non-negative parameters: 256 faces
CLOSED = 3  # dimensions of the orthants that have a closed form
ORTHANT_ERROR = 1e-3  # of the others, relative: no level is better known
ROUGH, LEAST = 1e-3, 1e-5  # absolute, of a first estimate and of what is next to nothing


def weights(information: Floats) -> Floats:
    """Weights (q + 1,) of 0 to q degrees of freedom for an information matrix (q, q) of non-negative parameters.

    ValueError for more than MOST parameters.
    """
    count = len(information)
    if count > MOST:
        raise ValueError(f"{count} non-negative parameters in one candidate; at most {MOST}")
    found = np.zeros(count + 1)
    left_out = _from_the_others(count)
    for positive in set(range(count + 1)) - set(left_out):
        for face in combinations(range(count), positive):
            found[positive] += _chance_of_face(information, list(face))
    for positive in left_out:
        found[positive] = max(0.5 - found[positive % 2 :: 2].sum(), 0.0)
    return np.asarray(found / found.sum())  # the sum is one but for the numerical orthants


def _from_the_others(count: int) -> list[int]:
    """One even and one odd number of degrees, those with the most faces of numerical orthants; none without any.

    Even weights make one half together, and so do odd ones (Silvapulle and Sen, proposition 3.6.1).
    """
    numerical = {j: comb(count, j) for j in range(count + 1) if max(j, count - j) > CLOSED}
    of_each = [[j for j in numerical if j % 2 == odd] for odd in (0, 1)]
    return [max(some, key=numerical.__getitem__) for some in of_each if some]


def survival(statistic: float, weight: Floats, unbounded: int = 0, noise_degrees: float = np.inf) -> float:
    """P(chi-bar-square >= statistic). unbounded : parameters of either sign, which always add a degree of freedom.

    noise_degrees : of the estimated noise variance, inf when it is known; each term is then d F(d, noise_degrees).
    """
    if statistic <= 0.0:
        return 1.0
    terms = ((w, j + unbounded) for j, w in enumerate(weight))
    return float(sum(w * _tail(statistic, degrees, noise_degrees) for w, degrees in terms if degrees > 0))


def orthant(covariance: Floats) -> float:
    """P(all components of N(0, covariance) are positive); closed forms up to three (Sheppard 1898, David 1953)."""
    count = len(covariance)
    if count == 0:
        return 1.0
    deviation = np.sqrt(np.diag(covariance))
    correlation = np.clip(covariance / np.outer(deviation, deviation), -1.0, 1.0)
    if count <= CLOSED:
        above = correlation[np.triu_indices(count, 1)]
        return float(0.5**count + 0.5 ** (count - 1) * np.arcsin(above).sum() / np.pi)
    rough = _numerical(correlation, ROUGH)
    return _numerical(correlation, max(ORTHANT_ERROR * rough, LEAST))


def _numerical(correlation: Floats, error: float) -> float:
    """The same by quasi-random points, of this absolute error."""
    seed = np.random.default_rng(0)
    law = multivariate_normal(cov=correlation, allow_singular=True, seed=seed, abseps=error, releps=0.0)
    return float(law.cdf(np.zeros(len(correlation))))


def _chance_of_face(information: Floats, face: list[int]) -> float:
    others = [n for n in range(len(information)) if n not in face]
    inner = np.asarray(np.linalg.inv(information[np.ix_(face, face)]), dtype=np.float64)
    across = information[np.ix_(others, face)]
    return orthant(inner) * orthant(information[np.ix_(others, others)] - across @ inner @ across.T)


def _tail(statistic: float, degrees: int, noise_degrees: float) -> float:
    if np.isinf(noise_degrees):
        return float(chi2.sf(statistic, degrees))
    return float(f_distribution.sf(statistic / degrees, degrees, noise_degrees))


CERTAIN = 1e-12  # where the chance that all degrees of freedom give is as small, the weights of fewer do not matter
PARALLEL = 1e-6  # of its length: what is left of a sensitivity that others in the same candidate already make


@dataclass(frozen=True)
class ScoreTest:
    """statistic : twice the gain in log-likelihood of the linearised fit. estimate : (q,) its parameters."""

    statistic: float
    p_value: float
    estimate: Floats


def score_test(
    residual: Floats, sensitivities: Floats, non_negative: Bools, noise_degrees: float = np.inf
) -> ScoreTest:
    """Test one candidate of q parameters, each counted from its off value.

    residual : (n,), sensitivities : (n, q), both free of nuisances. non_negative : (q,) True for a parameter whose off
    value is the lower end of its range (change the sign of one at an upper end). noise_degrees : of the estimated
    noise variance. ValueError for too many non-negative parameters.
    """
    basis = orthonormal(sensitivities[:, ~non_negative])
    along = basis.T @ residual
    bounded = _independent(sensitivities[:, non_negative], basis)
    columns = (sensitivities[:, non_negative] - basis @ (basis.T @ sensitivities[:, non_negative]))[:, bounded]
    rotation, triangle = np.linalg.qr(columns)
    target = rotation.T @ residual
    positive, misfit = nnls(triangle, target) if bounded else (np.zeros(0), 0.0)
    statistic = float(along @ along + target @ target - misfit**2)
    p_value = _tail(statistic, len(bounded) + basis.shape[1], noise_degrees) if statistic > 0.0 else 1.0
    if p_value > CERTAIN:
        p_value = survival(statistic, weights(_unit(triangle.T @ triangle)), basis.shape[1], noise_degrees)
    estimate = np.zeros(len(non_negative))
    estimate[np.flatnonzero(non_negative)[bounded]] = positive
    left = residual - sensitivities @ estimate
    estimate[~non_negative] = _least_squares(sensitivities[:, ~non_negative], left)
    return ScoreTest(statistic, p_value, estimate)


def _least_squares(columns: Floats, target: Floats) -> Floats:
    """Coefficients (q,), the same fit in any units of the columns (n, q)."""
    length = np.linalg.norm(columns, axis=0)
    length[length == 0.0] = 1.0
    return np.asarray(np.linalg.lstsq(columns / length, target, rcond=None)[0] / length)


def _independent(columns: Floats, basis: Floats) -> list[int]:
    """Columns that show beyond the basis (n, f) and the columns before them."""
    kept: list[int] = []
    for n, column in enumerate(columns.T):
        left = column - basis @ (basis.T @ column)
        if np.linalg.norm(left) > PARALLEL * np.linalg.norm(column):
            kept.append(n)
            basis = np.column_stack([basis, left / np.linalg.norm(left)])
    return kept


def _unit(information: Floats) -> Floats:
    """Scaled to a unit diagonal: weights do not depend on units."""
    scale = np.sqrt(np.diag(information))
    return np.asarray(information / np.outer(scale, scale))


def holm(p_values: Floats) -> Floats:
    """Step-down Bonferroni p-values (k,) of p-values (k,) (Holm, Scand. J. Stat. 6 (1979) 65)."""
    count = len(p_values)
    order = np.argsort(p_values)
    stepped = np.maximum.accumulate(p_values[order] * np.arange(count, 0, -1))
    adjusted = np.empty(count)
    adjusted[order] = np.minimum(stepped, 1.0)
    return adjusted

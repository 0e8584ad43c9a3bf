"""Screening of candidates: whether the sensitivity of one shows in the residual once nuisances have floated. No refit.

Rao's efficient score test (Proc. Camb. Phil. Soc. 44 (1948) 50; Bera and Bilias, J. Stat. Plan. Inference 97 (2001) 9):
nuisances are taken out of residual and sensitivities beforehand (nuisance_projection.py). With white noise of unit
variance the statistic is the gain in the sum of squares of the linearised fit, over the cone of allowed signs.
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import nnls

from diagnose.statistics.chi_bar_square import chi_bar_survival, chi_bar_weights, f_tail
from diagnose.statistics.nuisance_projection import orthonormal_basis
from foundation.arrays import Bools, Floats

NEGLIGIBLE_P_VALUE = 1e-12
"""p-value with all degrees of freedom below which the weights of fewer degrees do not matter."""
LEAST_INDEPENDENT_SHARE = 1e-6
"""Share of a sensitivity's length below which the rest is round-off of the others in the same candidate."""


@dataclass(frozen=True)
class ScoreTest:
    """Result of a score test. statistic : twice the gain in log-likelihood of the linearised fit.

    estimate : (q,) parameters.
    """

    statistic: float
    p_value: float
    estimate: Floats


def score_test(
    residual: Floats, sensitivities: Floats, non_negative: Bools, noise_degrees: float = np.inf
) -> ScoreTest:
    """Test one candidate of q parameters, each counted from its off value.

    residual : (n,), sensitivities : (n, q), both free of nuisances. non_negative : (q,) True for a parameter whose off
    value is the lower end of its range (change the sign of one at an upper end). noise_degrees : degrees of freedom of
    the estimated noise variance. ValueError for too many non-negative parameters.
    """
    basis = orthonormal_basis(sensitivities[:, ~non_negative])
    along = basis.T @ residual
    bounded = _independent_columns(sensitivities[:, non_negative], basis)
    columns = (sensitivities[:, non_negative] - basis @ (basis.T @ sensitivities[:, non_negative]))[:, bounded]
    rotation, triangle = np.linalg.qr(columns)
    target = rotation.T @ residual
    positive, misfit = nnls(triangle, target) if bounded else (np.zeros(0), 0.0)
    statistic = float(along @ along + target @ target - misfit**2)
    p_value = f_tail(statistic, len(bounded) + basis.shape[1], noise_degrees) if statistic > 0.0 else 1.0
    if p_value > NEGLIGIBLE_P_VALUE:
        p_value = chi_bar_survival(statistic, chi_bar_weights(triangle), basis.shape[1], noise_degrees)
    estimate = np.zeros(len(non_negative))
    estimate[np.flatnonzero(non_negative)[bounded]] = positive
    left = residual - sensitivities @ estimate
    estimate[~non_negative] = _least_squares(sensitivities[:, ~non_negative], left)
    return ScoreTest(statistic, p_value, estimate)


def _least_squares(columns: Floats, target: Floats) -> Floats:
    """Least-squares coefficients (q,), the same fit in any units of the columns (n, q)."""
    length = np.linalg.norm(columns, axis=0)
    length[length == 0.0] = 1.0
    return np.asarray(np.linalg.lstsq(columns / length, target, rcond=None)[0] / length)


def _independent_columns(columns: Floats, basis: Floats) -> list[int]:
    """Numbers of the columns (n, k) that show beyond the basis (n, f) and the columns before them."""
    kept: list[int] = []
    for n, column in enumerate(columns.T):
        left = column - basis @ (basis.T @ column)
        if np.linalg.norm(left) > LEAST_INDEPENDENT_SHARE * np.linalg.norm(column):
            kept.append(n)
            basis = np.column_stack([basis, left / np.linalg.norm(left)])
    return kept


def holm_p_values(p_values: Floats) -> Floats:
    """Step-down Bonferroni p-values (k,) of p-values (k,) (Holm, Scand. J. Stat. 6 (1979) 65)."""
    count = len(p_values)
    order = np.argsort(p_values)
    stepped = np.maximum.accumulate(p_values[order] * np.arange(count, 0, -1))
    adjusted = np.empty(count)
    adjusted[order] = np.minimum(stepped, 1.0)
    return adjusted

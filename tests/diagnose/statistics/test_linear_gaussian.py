"""Evidence from sums, against the dense normal density."""

import numpy as np
import pytest
from scipy.stats import multivariate_normal

from diagnose.statistics.linear_gaussian import Sums
from diagnose.statistics.nuisance_projection import Marginal
from tests.cases import for_each

RNG = np.random.default_rng(41)
COLUMNS, RESIDUAL = RNG.standard_normal((25, 3)), 2.0 * RNG.standard_normal(25)


@for_each("sigma", [[0.5, 2.0, 0.0], [0.0, 0.0, 0.0], [3.0, 1e-4, 40.0]])
def test_the_evidence_is_the_dense_normal_density(sigma):
    covariance = np.eye(25) + (COLUMNS * np.square(sigma)) @ COLUMNS.T
    dense = multivariate_normal(np.zeros(25), covariance).logpdf(RESIDUAL)
    assert Sums.from_columns(COLUMNS, RESIDUAL).log_evidence(np.array(sigma)) == pytest.approx(dense, rel=1e-10)


def test_sums_of_parts_are_the_sums_of_the_whole():
    parts = Sums.from_columns(COLUMNS[:9], RESIDUAL[:9]) + Sums.from_columns(COLUMNS[9:], RESIDUAL[9:])
    sigma = np.array([1.0, np.inf, 0.2])
    assert parts.log_evidence(sigma) == pytest.approx(
        Sums.from_columns(COLUMNS, RESIDUAL).log_evidence(sigma), rel=1e-12
    )


def test_a_free_parameter_is_the_restricted_likelihood_but_for_a_constant():
    """The flat prior and the projection differ by half log det X'X of the free columns, whatever the residual."""
    sigma = np.array([np.inf, 0.7, np.inf])
    restricted = Marginal(COLUMNS, sigma)
    constant = 0.5 * np.linalg.slogdet(COLUMNS[:, [0, 2]].T @ COLUMNS[:, [0, 2]])[1]
    for residual in (RESIDUAL, RNG.standard_normal(25)):
        difference = restricted.log_density(residual) - Sums.from_columns(COLUMNS, residual).log_evidence(sigma)
        assert difference == pytest.approx(constant, rel=1e-9)


def test_the_mean_is_that_of_ridge_regression():
    sigma = np.array([np.inf, 0.7, 0.0])
    kept = COLUMNS[:, :2]
    expected = np.linalg.solve(kept.T @ kept + np.diag([0.0, 1.0 / 0.49]), kept.T @ RESIDUAL)
    np.testing.assert_allclose(Sums.from_columns(COLUMNS, RESIDUAL).mean(sigma), [*expected, 0.0], atol=1e-13)


def test_an_undetermined_free_parameter_is_refused():
    with pytest.raises(ValueError, match="not determined"):
        Sums.from_columns(np.zeros((25, 1)), RESIDUAL).log_evidence(np.array([np.inf]))

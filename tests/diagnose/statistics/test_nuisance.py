"""Integrating nuisances out, against dense Gaussian algebra."""

import numpy as np
import pytest
from scipy.stats import multivariate_normal

from diagnose.statistics.nuisance_projection import Marginal, orthonormal_basis

RNG = np.random.default_rng(11)
TANGENT, SIGMA = RNG.standard_normal((30, 4)) * [1.0, 5.0, 0.1, 2.0], np.array([0.3, 2.0, 1.0, 0.05])
RESIDUAL = RNG.standard_normal(30)
COVARIANCE = np.eye(30) + (TANGENT * SIGMA**2) @ TANGENT.T


def test_the_marginal_map_is_a_root_of_the_inverse_covariance():
    root = Marginal(TANGENT, SIGMA)(np.eye(30))
    np.testing.assert_allclose(root @ root.T, np.linalg.inv(COVARIANCE), atol=1e-12)
    np.testing.assert_allclose(root, root.T, atol=1e-12)


def test_the_marginal_density_is_the_dense_one():
    dense = multivariate_normal(np.zeros(30), COVARIANCE).logpdf(RESIDUAL)
    assert Marginal(TANGENT, SIGMA).log_density(RESIDUAL) == pytest.approx(dense, rel=1e-12)


def test_a_nuisance_without_prior_is_projected_out_exactly():
    sigma = np.array([np.inf, 2.0, np.inf, 0.05])
    marginal = Marginal(TANGENT, sigma)
    np.testing.assert_allclose(marginal(TANGENT[:, [0, 2]]), 0.0, atol=1e-12)
    wide = Marginal(TANGENT, np.where(np.isinf(sigma), 1e8, sigma))
    np.testing.assert_allclose(marginal(RESIDUAL), wide(RESIDUAL), atol=1e-7)
    assert marginal.degrees == 28


def test_without_nuisances_nothing_changes():
    np.testing.assert_array_equal(Marginal(np.zeros((30, 0)), np.zeros(0))(RESIDUAL), RESIDUAL)


def test_units_of_a_column_do_not_decide_whether_it_counts():
    columns = RNG.standard_normal((20, 2)) * [1.0, 1e-12]
    assert orthonormal_basis(columns).shape == (20, 2)
    assert orthonormal_basis(np.column_stack([columns, columns.sum(axis=1), np.zeros(20)])).shape[1] == 2

"""Inner products with nuisances integrated out are those of the dense covariance."""

import numpy as np
import pytest

from diagnose.fit.marginal_likelihood import Quadratic

RNG = np.random.default_rng(1)
COLUMNS, SIGMA = RNG.standard_normal((30, 3)), np.array([0.5, 3.0, 1e4])
DENSE = np.linalg.inv(np.eye(30) + (COLUMNS * SIGMA**2) @ COLUMNS.T)
RESIDUAL, OTHERS = RNG.standard_normal(30), RNG.standard_normal((30, 2))


def test_products_are_those_of_the_dense_covariance():
    quadratic = Quadratic(COLUMNS, SIGMA)
    assert quadratic.square(RESIDUAL) == pytest.approx(RESIDUAL @ DENSE @ RESIDUAL)
    np.testing.assert_allclose(quadratic.inner_products(OTHERS, OTHERS), OTHERS.T @ DENSE @ OTHERS, rtol=1e-6)
    np.testing.assert_allclose(quadratic.apply_inverse(OTHERS), DENSE @ OTHERS, atol=1e-6)


def test_the_determinant_is_that_of_the_dense_covariance():
    _, log_determinant = np.linalg.slogdet(DENSE)
    assert Quadratic(COLUMNS, SIGMA).log_scale == pytest.approx(-0.5 * log_determinant)


def test_posterior_is_that_of_ridge_regression():
    precision = COLUMNS.T @ COLUMNS + np.diag(1.0 / SIGMA**2)
    quadratic = Quadratic(COLUMNS, SIGMA)
    np.testing.assert_allclose(quadratic.mean(RESIDUAL), np.linalg.solve(precision, COLUMNS.T @ RESIDUAL), rtol=1e-6)
    np.testing.assert_allclose(quadratic.variances(), np.diag(np.linalg.inv(precision)), rtol=1e-6)


def test_a_column_without_prior_leaves_no_trace():
    free = Quadratic(COLUMNS, np.array([0.5, np.inf, 1.0]))
    assert free.square(COLUMNS[:, 1]) == pytest.approx(0.0, abs=1e-6)


def test_a_column_of_no_size_changes_nothing():
    nothing = Quadratic(np.column_stack([COLUMNS, np.zeros(30)]), np.append(SIGMA, 1.0))
    none = Quadratic(np.column_stack([COLUMNS, RESIDUAL]), np.append(SIGMA, 0.0))
    assert nothing.square(RESIDUAL) == pytest.approx(Quadratic(COLUMNS, SIGMA).square(RESIDUAL))
    assert none.square(RESIDUAL) == pytest.approx(Quadratic(COLUMNS, SIGMA).square(RESIDUAL))

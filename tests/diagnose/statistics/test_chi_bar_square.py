"""The chi-bar-square law against closed forms and against projection by brute force."""

import numpy as np
import pytest
from scipy.optimize import nnls
from scipy.stats import chi2, f

from diagnose.statistics.chi_bar_square import chi_bar_survival, chi_bar_weights, orthant_probability
from tests.cases import for_each


def test_one_parameter_is_half_a_chi_square():
    np.testing.assert_allclose(chi_bar_weights(np.eye(1)), [0.5, 0.5])
    assert chi_bar_survival(2.7055, chi_bar_weights(np.eye(1))) == pytest.approx(0.05, rel=1e-4)


@for_each("correlation", [-0.9, -0.3, 0.0, 0.5, 0.99])
def test_two_parameters_have_the_weights_of_their_angle(correlation):
    """w_2 = arccos(-(correlation of the information)) ... of the estimates: 1/4 + arcsin(-rho) / 2 pi; w_1 = 1/2."""
    both = 0.25 - np.arcsin(correlation) / (2.0 * np.pi)
    np.testing.assert_allclose(
        chi_bar_weights(np.linalg.cholesky([[1.0, correlation], [correlation, 1.0]]).T), [0.5 - both, 0.5, both]
    )


def test_independent_parameters_have_binomial_weights():
    np.testing.assert_allclose(chi_bar_weights(np.eye(4)) * 16.0, [1.0, 4.0, 6.0, 4.0, 1.0], rtol=1e-3)


def like(shared):
    """Six samples of three parameters, alike as more is shared."""
    return np.random.default_rng(3).standard_normal((6, 3)) + shared


def spectrum(branches, quickest=0.1, slowest=30.0):
    """What branches of relaxation lose over sixty seconds."""
    return -np.expm1(-np.linspace(0.0, 60.0, 200)[:, None] / np.geomspace(quickest, slowest, branches))


def assert_weights_are_counted(design, draws):
    rng, (samples, count) = np.random.default_rng(4), design.shape
    positive = [int((nnls(design, rng.standard_normal(samples))[0] > 0.0).sum()) for _ in range(draws)]
    counted = np.bincount(positive, minlength=count + 1) / draws
    found = chi_bar_weights(design)
    np.testing.assert_allclose(found, counted, atol=4.0 * np.sqrt(found * (1.0 - found) / draws).max())


@pytest.mark.press
@for_each("design", [like(0.0), like(0.8), like(3.0), spectrum(4), spectrum(6), spectrum(8)])
def test_weights_against_projection_by_brute_force(design):
    assert_weights_are_counted(design, 8000)


def test_weights_of_branches_that_are_alike_to_a_millionth():
    """The square of what they differ by is below round-off, where an information matrix is no longer definite."""
    assert_weights_are_counted(spectrum(5, 30.0, 90.0), 2000)


def test_even_and_odd_weights_share_equally():
    """The Gauss-Bonnet relation of polyhedral cones (Shapiro 1988), of weights that all have a closed form."""
    assert chi_bar_weights(like(0.5))[::2].sum() == pytest.approx(0.5, abs=1e-12)


def test_orthants_of_equal_correlation_one_half():
    """P = 1 / (n + 1)."""
    for count in (1, 2, 3, 4, 5):
        covariance = np.full((count, count), 0.5) + 0.5 * np.eye(count)
        assert orthant_probability(covariance) == pytest.approx(1.0 / (count + 1), rel=2e-3)


def test_free_parameters_and_estimated_noise_change_the_terms():
    assert chi_bar_survival(4.0, np.array([1.0]), unbounded=2) == pytest.approx(chi2.sf(4.0, 2))
    mixed = 0.5 * f.sf(4.0, 1, 30) + 0.5 * f.sf(2.0, 2, 30)
    assert chi_bar_survival(4.0, np.array([0.5, 0.5]), 1, 30.0) == pytest.approx(mixed)


def test_too_many_parameters_are_refused():
    with pytest.raises(ValueError, match="at most 8"):
        chi_bar_weights(np.eye(9))

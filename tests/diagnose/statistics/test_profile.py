"""Profile-likelihood intervals: closed forms, bounds, coverage."""

import numpy as np
import pytest
from scipy.stats import chi2

from diagnose.statistics.profile import Profile
from tests.diagnose.statistics.rejections import is_fair

OPEN = np.array([[-np.inf, np.inf], [-np.inf, np.inf]])
Z90 = 1.644854


def test_a_quadratic_has_the_interval_of_its_marginal_deviation():
    """For -ln L = x' H x / 2 the profile's half width is 1.645 sqrt((H^-1)_ii), correlation and units included."""
    information = np.array([[4.0, 1.8e3], [1.8e3, 1e6]])
    deviation = np.sqrt(np.diag(np.linalg.inv(information)))
    centre = np.array([3.0, -0.02])
    nll = lambda x: 0.5 * (x - centre) @ information @ (x - centre)  # noqa: E731
    profile = Profile(nll, centre + 0.1 * deviation, deviation, OPEN)
    for n in range(2):
        found = profile.interval(n)
        assert found.value == pytest.approx(centre[n], abs=0.01 * deviation[n])
        assert found.low == pytest.approx(centre[n] - Z90 * deviation[n], abs=0.03 * deviation[n])
        assert found.high == pytest.approx(centre[n] + Z90 * deviation[n], abs=0.03 * deviation[n])


def test_the_first_guess_of_the_deviation_may_be_far_off():
    for guess in (0.02, 50.0):
        found = Profile(lambda x: 0.5 * float(x[0] ** 2), np.zeros(1), np.array([guess]), OPEN[:1]).interval(0)
        assert found.high == pytest.approx(Z90, abs=0.02 * max(guess, 1.0))


def test_an_exponential_rate_has_its_asymmetric_interval():
    """n exponential times of sum s: -ln L = r s - n ln r; both ends lie z^2 / 2 above the least."""
    count, total = 5, 2.0
    nll = lambda x: x[0] * total - count * np.log(x[0])  # noqa: E731
    found = Profile(nll, np.array([2.4]), np.array([1.1]), np.array([[1e-6, np.inf]])).interval(0)
    assert found.value == pytest.approx(2.5, rel=1e-3)
    for end in (found.low, found.high):
        assert nll([end]) - nll([2.5]) == pytest.approx(0.5 * chi2.ppf(0.9, 1), rel=0.02)
    assert found.high - 2.5 > 2.5 - found.low


def test_an_interval_ends_at_the_bound_that_the_data_do_not_exclude():
    bounds = np.array([[0.0, 10.0]])
    found = Profile(lambda x: 0.5 * float((x[0] - 0.5) ** 2), np.array([0.4]), np.ones(1), bounds).interval(0)
    assert found.at_low
    assert found.low == 0.0
    assert not found.at_high
    assert found.high == pytest.approx(0.5 + Z90, abs=0.02)


def test_a_flat_likelihood_excludes_nothing():
    found = Profile(lambda x: 0.0 * x[0], np.ones(1), np.ones(1), OPEN[:1]).interval(0)
    assert (found.low, found.high) == (-np.inf, np.inf)
    assert found.at_low
    assert found.at_high


def test_a_large_constant_does_not_blur_the_interval():
    found = Profile(lambda x: 1e8 + 0.5 * float(x @ x), np.array([0.3, 0.2]), np.ones(2), OPEN).interval(0)
    assert found.high == pytest.approx(Z90, abs=0.03)


def test_a_minimum_beyond_the_bound_is_put_on_it():
    bounds = np.array([[0.0, 10.0], [-5.0, 5.0]])
    nll = lambda x: 0.5 * float((x[0] + 2.0) ** 2 + (x[1] - x[0]) ** 2)  # noqa: E731
    found = Profile(nll, np.array([1.0, 1.0]), np.ones(2), bounds).interval(0)
    assert found.value == 0.0
    assert found.at_low
    assert nll([found.high, found.high]) - nll([0.0, 0.0]) == pytest.approx(0.5 * Z90**2, rel=0.02)


def test_coverage_of_a_relaxation_time_with_its_amplitude_unknown():
    """Nonlinear: a exp(-t / tau) in white noise; 90 % intervals of tau."""
    rng, time = np.random.default_rng(81), np.linspace(0.0, 3.0, 25)
    truth, covered, trials = np.array([4.0, 0.8]), 0, 150
    bounds = np.array([[0.0, 50.0], [0.01, 50.0]])
    for _ in range(trials):
        data = truth[0] * np.exp(-time / truth[1]) + 0.5 * rng.standard_normal(25)
        profile = Profile(lambda x, d=data: 2.0 * float(np.sum((d - x[0] * np.exp(-time / x[1])) ** 2)),
                          truth, np.array([0.4, 0.12]), bounds)  # fmt: skip
        found = profile.interval(1)
        covered += found.low <= truth[1] <= found.high
    assert is_fair(covered, trials, 0.9)
    assert 0.85 <= covered / trials <= 0.95

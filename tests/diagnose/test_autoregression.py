"""Autoregressive noise is found again from its samples."""

import numpy as np
import pytest
from scipy.integrate import trapezoid
from scipy.signal import lfilter

from diagnose.noise.autoregression import Autoregression, fit_autoregression

TRUE = Autoregression(np.array([1.5, -0.8]), 0.25)


def drawn(count, seed):
    """Samples of TRUE after a long lead."""
    driven = 0.5 * np.random.default_rng(seed).standard_normal(count + 500)
    return lfilter([1.0], [1.0, -1.5, 0.8], driven)[500:]


def test_two_coefficients_are_found_within_their_standard_error():
    found = fit_autoregression([drawn(20_000, 1)])
    error = np.sqrt(TRUE.variance * np.linalg.inv(TRUE.start_covariance()).diagonal() / 20_000)
    assert np.abs(found.coefficients[:2] - TRUE.coefficients) == pytest.approx(0.0, abs=4 * error.max() + 0.01)
    assert found.variance == pytest.approx(0.25, rel=4 * np.sqrt(2 / 20_000))


def test_several_short_stretches_say_the_same_as_a_long_one():
    found = fit_autoregression([drawn(250, seed) for seed in range(40)])
    assert found.autocovariance(3) == pytest.approx(TRUE.autocovariance(3), rel=0.15)


def test_white_noise_mostly_needs_no_coefficient():
    rng = np.random.default_rng(2)
    orders = [len(fit_autoregression([rng.standard_normal(2000)]).coefficients) for _ in range(40)]
    assert np.median(orders) <= 2  # AIC takes too many now and then, by design


def test_autocovariance_of_the_first_order_is_geometric():
    model = Autoregression(np.array([0.6]), 1.0)
    assert model.autocovariance(5) == pytest.approx(0.6 ** np.arange(5) / (1.0 - 0.36), rel=1e-12)


def test_density_integrates_to_the_variance():
    frequency = np.linspace(0.0, 500.0, 20_001)
    power = trapezoid(TRUE.spectral_density(frequency, 1e-3), frequency)
    assert power == pytest.approx(TRUE.autocovariance(1)[0], rel=1e-4)


def test_a_silent_channel_still_rounds():
    found = fit_autoregression([np.zeros(100)], least_variance=0.01**2 / 12.0)
    assert found.variance == pytest.approx(0.01**2 / 12.0)

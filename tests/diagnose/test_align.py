"""A lag is recovered within the uncertainty that is stated with it."""

import numpy as np
import pytest
from scipy.stats import chi2

from diagnose.noise.autoregression import Autoregression
from diagnose.noise.model import NoiseModel
from diagnose.signals.align import lag_between

WHITE = Autoregression(np.zeros(0), 1.0)
SLOW = Autoregression(np.array([0.8]), 0.36)
STEP_S = 1e-3


def presses(time_s, centres=(0.7,)):
    """Smooth presses of 80 ms."""
    return np.sum([np.exp(-(((time_s - centre) / 0.08) ** 2)) for centre in centres], axis=0)


def scores(noise, lag_s=0.01237, trials=60):
    """(found - true) / stated error of many trials."""
    rng, time = np.random.default_rng(1), STEP_S * np.arange(2000)
    model = NoiseModel(noise, STEP_S, "rest", 0)
    found = [
        lag_between(presses(time), 2.0 * presses(time - lag_s) + 0.05 * model.draw(rng, len(time)), STEP_S)
        for _ in range(trials)
    ]
    return np.array([(lag.lag_s - lag_s) / lag.sigma_s for lag in found])


def test_scatter_of_the_lag_is_what_is_stated():
    squared = float((scores(WHITE) ** 2).sum())
    assert chi2.ppf(1e-3, 60) < squared < chi2.ppf(1.0 - 1e-3, 60)


def test_correlated_noise_is_not_taken_for_more_samples():
    squared = float((scores(SLOW) ** 2).sum())
    assert chi2.ppf(1e-3, 60) < squared < chi2.ppf(1.0 - 1e-3, 60)


def test_the_sign_of_the_answer_does_not_matter():
    time = STEP_S * np.arange(2000)
    lag = lag_between(presses(time), -presses(time + 0.0305), STEP_S)
    assert lag.lag_s == pytest.approx(-0.0305, abs=1e-6)
    assert lag.correlation == pytest.approx(-1.0, abs=1e-6)


def test_a_constant_has_no_lag():
    with pytest.raises(ValueError, match="constant"):
        lag_between(np.ones(100), np.arange(100.0), STEP_S)

"""Prediction of presses that were not fitted."""

import numpy as np
import pytest
from scipy.stats import multivariate_normal

from diagnose.statistics.held_out import gain_over_noise, leave_press_out
from tests.diagnose.statistics.forecasts import linear_forecast, separation_by_press, sure_gain
from tests.diagnose.statistics.rejections import fair_range, is_fair

RNG = np.random.default_rng(51)
PRESSES, LENGTH, TRIALS = 8, 25, 400
PRESS = np.repeat(np.arange(PRESSES), LENGTH)
NUISANCE, EFFECT, OTHER = RNG.standard_normal((3, len(PRESS)))
PRIOR = np.array([np.inf, 2.0])
COLUMNS = np.column_stack([NUISANCE, EFFECT])


def gains(residual, column):
    """Over the nuisance alone."""
    with_effect = linear_forecast(residual, np.column_stack([NUISANCE, column]), PRIOR, PRESS)
    return with_effect.log_scores - linear_forecast(residual, NUISANCE[:, None], PRIOR[:1], PRESS).log_scores


def test_every_press_is_held_out_once():
    folds = leave_press_out(PRESS)
    assert len(folds) == PRESSES
    np.testing.assert_array_equal(np.sort(np.concatenate([held for _, held in folds])), np.arange(len(PRESS)))
    assert all(set(fitted).isdisjoint(held) for fitted, held in folds)


def test_the_score_is_the_density_of_the_conditioned_normal():
    """Posterior from the other presses by dense algebra, then the predictive normal of the press held out."""
    residual = RNG.standard_normal(len(PRESS)) + 0.3 * EFFECT + 5.0 * NUISANCE
    found = linear_forecast(residual, COLUMNS, PRIOR, PRESS)
    for (fitted, held), score in zip(leave_press_out(PRESS), found.log_scores, strict=True):
        spread = np.linalg.inv(COLUMNS[fitted].T @ COLUMNS[fitted] + np.diag([0.0, 0.25]))
        mean = spread @ COLUMNS[fitted].T @ residual[fitted]
        covariance = np.eye(LENGTH) + COLUMNS[held] @ spread @ COLUMNS[held].T
        dense = multivariate_normal(COLUMNS[held] @ mean, covariance).logpdf(residual[held])
        assert score == pytest.approx(dense, rel=1e-9)
        np.testing.assert_allclose(found.predictions[held], COLUMNS[held] @ mean)


def test_the_true_effect_gains_and_a_wrong_one_does_not():
    residual = RNG.standard_normal(len(PRESS)) + 0.5 * EFFECT
    assert gains(residual, EFFECT).mean() > 1.0
    assert gains(residual, OTHER).mean() < 0.5


def test_without_effect_the_lower_bound_is_positive_less_often_than_stated():
    rng = np.random.default_rng(52)
    samples = [gains(rng.standard_normal(len(PRESS)), EFFECT) for _ in range(150)]
    positive = sum(sure_gain(sample, 0.05) > 0.0 for sample in samples)
    assert positive <= fair_range(150, 0.05)[1]


def test_the_bound_over_noise_covers_on_presses_of_very_unlike_size():
    """Fixed predictions a and b, truth b: the mean gain of b is |a - b|^2 / 2 per press, from 0.02 to 50 nats."""
    rng = np.random.default_rng(54)
    difference = rng.standard_normal((PRESSES, LENGTH)) * np.geomspace(0.04, 2.0, PRESSES)[:, None]
    separations = separation_by_press(difference.ravel(), np.zeros(len(PRESS)), PRESS)
    missed = 0
    for _ in range(TRIALS):
        noise = rng.standard_normal(difference.shape)
        gain = 0.5 * ((noise + difference) ** 2 - noise**2).sum(axis=1)
        missed += gain_over_noise(gain, separations, 0.05).lower > 0.5 * np.mean(separations**2)
    assert is_fair(missed, TRIALS, 0.05)


def test_more_candidates_lower_the_bound():
    gains, separations = RNG.normal(1.0, 1.0, 10), np.full(10, 2.0)
    assert gain_over_noise(gains, separations, 0.05, 40).lower < gain_over_noise(gains, separations, 0.05).lower
    assert gain_over_noise(gains, separations, 0.05, 40).lower == gain_over_noise(gains, separations, 0.05 / 40).lower


def test_one_press_is_refused():
    with pytest.raises(ValueError, match="at least two"):
        linear_forecast(np.ones(3), np.ones((3, 1)), np.ones(1), np.zeros(3, int))

"""Level and power of the screening test, for either sign and for parameters that start at their bound."""

import numpy as np
import pytest
from scipy.stats import norm

from diagnose.statistics.nuisance_projection import Marginal
from diagnose.statistics.score_test import holm_p_values, score_test
from tests.cases import for_each
from tests.diagnose.statistics.rejections import is_fair

RNG = np.random.default_rng(21)
COUNT, TRIALS, LEVEL = 60, 400, 0.05
TANGENT = RNG.standard_normal((COUNT, 2))
MARGINAL = Marginal(TANGENT, np.array([np.inf, 3.0]))
RAW = RNG.standard_normal((COUNT, 3)) + TANGENT[:, :1]
COLUMNS = MARGINAL(RAW)


def results_of(columns, non_negative, effect, seed, degrees=np.inf):
    rng = np.random.default_rng(seed)
    for _ in range(TRIALS):
        nuisance = TANGENT @ np.array([rng.uniform(-90, 90), rng.normal(0.0, 3.0)])
        scale = 1.0 if np.isinf(degrees) else np.sqrt(rng.chisquare(degrees) / degrees)
        residual = MARGINAL((rng.standard_normal(COUNT) + nuisance + effect) / scale)
        yield score_test(residual, columns, non_negative, degrees)


@pytest.mark.press
@for_each("non_negative", [(False,) * 3, (True,) * 3, (True, False, True), (True, False, False)])
def test_level_under_the_null(non_negative):
    count = sum(t.p_value <= LEVEL for t in results_of(COLUMNS, np.array(non_negative), 0.0, 1))
    assert is_fair(count, TRIALS, LEVEL)


def test_level_with_an_estimated_noise_variance():
    count = sum(t.p_value <= 0.01 for t in results_of(COLUMNS[:, :1], np.array([True]), 0.0, 2, 15.0))
    assert is_fair(count, TRIALS, 0.01)


def test_power_of_one_parameter_is_the_normal_one():
    """An effect of 2.5 sigma after nuisances is found at 5 % one-sided with probability Phi(2.5 - 1.645)."""
    column = COLUMNS[:, :1]
    effect = 2.5 * RAW[:, 0] / np.linalg.norm(column)
    found = sum(t.p_value <= LEVEL for t in results_of(column, np.array([True]), effect, 3))
    assert is_fair(found, TRIALS, norm.cdf(2.5 - norm.isf(LEVEL)))


def test_an_effect_of_the_impossible_sign_is_not_found():
    effect = -6.0 * RAW[:, 0] / np.linalg.norm(COLUMNS[:, 0])
    found = [t.p_value for t in results_of(COLUMNS[:, :1], np.array([True]), effect, 4)]
    assert min(found) == 1.0


def test_either_sign_is_the_gain_of_least_squares_in_any_units():
    residual = MARGINAL(RNG.standard_normal(COUNT))
    fit, *_ = np.linalg.lstsq(COLUMNS, residual)
    result = score_test(residual, COLUMNS * [1e-9, 1.0, 1e6], np.zeros(3, dtype=bool))
    assert result.statistic == pytest.approx(residual @ residual - np.sum((residual - COLUMNS @ fit) ** 2))
    np.testing.assert_allclose(result.estimate * [1e-9, 1.0, 1e6], fit)


def test_the_estimate_without_noise_is_the_truth():
    truth = np.array([0.7, -2.0, 0.0])
    result = score_test(COLUMNS @ truth, COLUMNS, np.array([True, False, True]))
    np.testing.assert_allclose(result.estimate, truth, atol=1e-12)


def test_a_parameter_that_repeats_another_adds_nothing():
    residual = MARGINAL(RNG.standard_normal(COUNT) + RAW[:, 0])
    once = score_test(residual, COLUMNS[:, :1], np.array([True]))
    twice = score_test(residual, np.repeat(COLUMNS[:, :1], 2, axis=1), np.array([True, True]))
    assert twice.p_value == pytest.approx(once.p_value)
    assert score_test(residual, np.zeros((COUNT, 1)), np.array([True])).p_value == 1.0


def test_holm_by_hand():
    np.testing.assert_allclose(holm_p_values(np.array([0.01, 0.04, 0.03, 0.9])), [0.04, 0.09, 0.09, 0.9])
    assert np.all(holm_p_values(np.full(5, 0.5)) == 1.0)


def test_holm_keeps_the_family_wise_level_and_beats_bonferroni():
    p_values = np.random.default_rng(22).uniform(size=(TRIALS, 30))
    assert is_fair(sum(holm_p_values(p).min() <= LEVEL for p in p_values), TRIALS, 1.0 - (1.0 - LEVEL / 30) ** 30)
    assert np.all(holm_p_values(p_values[0]) <= np.minimum(30.0 * p_values[0], 1.0))

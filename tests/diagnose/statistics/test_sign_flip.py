"""Sign flips are exact; sequential scores allow any stop."""

import numpy as np
import pytest

from diagnose.statistics.anytime import anytime_p_value, sequential_log_scores
from diagnose.statistics.linear_gaussian import Sums
from diagnose.statistics.sign_flip import sign_flip_p_values
from tests.diagnose.statistics.rejections import fair_range, is_fair

TRIALS = 400


def p_of(gains, seed=0):
    return sign_flip_p_values(np.atleast_2d(gains), np.random.default_rng(seed))


def test_over_all_patterns_of_one_sample_the_level_is_exact():
    """Among the 2^n sign patterns of any sizes, exactly a share k / 2^n has p <= k / 2^n."""
    sizes = np.array([0.3, 1.1, 2.7, 5.3, 11.9])
    patterns = 1.0 - 2.0 * ((np.arange(32)[:, None] >> np.arange(5)) & 1)
    p_values = np.sort([p_of(sizes * signs)[0] for signs in patterns])
    np.testing.assert_allclose(p_values, np.arange(1, 33) / 32.0)


def test_all_gains_positive_gives_the_least_p_value():
    assert p_of([0.1, 7.0, 2.0, 300.0])[0] == 1 / 16


def test_level_for_a_law_without_variance():
    rng = np.random.default_rng(61)
    assert is_fair(sum(p_of(rng.standard_cauchy(10))[0] <= 1 / 16 for _ in range(TRIALS)), TRIALS, 1 / 16)


def test_random_patterns_agree_with_all():
    gains = np.random.default_rng(62).normal(0.4, 1.0, 16)
    signs = 1.0 - 2.0 * ((np.arange(2**16)[:, None] >> np.arange(16)) & 1)
    exact = (signs @ gains >= gains.sum() - 1e-12).mean()
    assert p_of(gains)[0] == pytest.approx(exact, abs=4.0 * np.sqrt(exact * (1.0 - exact) / 9999))


def test_family_wise_over_correlated_candidates():
    rng = np.random.default_rng(63)
    mix = 0.7 * np.ones((12, 12)) + np.eye(12)
    count = sum(p_of(mix @ rng.standard_normal((12, 9))).min() <= 0.05 for _ in range(TRIALS))
    assert 0 < count <= fair_range(TRIALS, 0.05)[1]


def columns_and_noise(rng):
    return rng.standard_normal((60, 2)), rng.standard_normal(60), np.repeat(np.arange(12), 5)


def test_sequential_scores_add_up_to_the_evidence():
    columns, residual, press = columns_and_noise(np.random.default_rng(64))
    scores = sequential_log_scores(residual, columns, np.array([1.0, 0.3]), press)
    assert scores.sum() == pytest.approx(Sums.of(columns, residual).log_evidence(np.array([1.0, 0.3])))


def test_looking_after_every_press_keeps_the_level():
    """The best moment of each of 150 recordings without the effect, whose nuisance floats."""
    rng, rejected = np.random.default_rng(65), 0
    for _ in range(150):
        columns, residual, press = columns_and_noise(rng)
        residual = residual + columns[:, 0] * rng.standard_normal()
        model = sequential_log_scores(residual, columns, np.ones(2), press)
        rejected += anytime_p_value(model - sequential_log_scores(residual, columns[:, :1], np.ones(1), press)) <= 0.1
    assert rejected <= fair_range(150, 0.1)[1]


def test_the_level_is_nearly_used_up_when_presses_are_many_and_each_tells_little():
    """Simple against simple, d sigma a press: Ville's inequality is an equality but for the last step over the limit,
    exp(-0.583 d) (Siegmund, Sequential Analysis, 1985)."""
    noise = np.random.default_rng(67).standard_normal((TRIALS, 500))
    rejected = sum(anytime_p_value(gains) <= 0.1 for gains in 0.15 * noise - 0.5 * 0.15**2)
    assert is_fair(rejected, TRIALS, 0.1 * np.exp(-0.583 * 0.15))


def test_a_true_effect_is_found_and_many_candidates_cost():
    columns, residual, press = columns_and_noise(np.random.default_rng(66))
    model = sequential_log_scores(residual + columns[:, 1], columns[:, 1:], np.ones(1), press)
    gains = model - sequential_log_scores(residual + columns[:, 1], columns[:, :0], np.zeros(0), press)
    assert anytime_p_value(gains) < 1e-4
    assert anytime_p_value(gains, 60) == pytest.approx(60.0 * anytime_p_value(gains))


def test_a_free_null_is_refused():
    with pytest.raises(ValueError, match="must be finite"):
        sequential_log_scores(np.ones(4), np.ones((4, 1)), np.array([np.inf]), np.arange(4))

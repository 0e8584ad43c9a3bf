"""The flexible rival wins when, and only when, the truth is outside the named models."""

import numpy as np
import pytest

from diagnose.statistics.impulse_response import (
    doubling_edges,
    impulse_response_forecast,
    lagged_means,
    ridge_by_evidence,
)
from diagnose.statistics.linear_gaussian import Sums
from tests.diagnose.statistics.forecasts import linear_forecast, sure_gain

RNG = np.random.default_rng(101)
PRESSES, LENGTH = 8, 100
PRESS = np.repeat(np.arange(PRESSES), LENGTH)
DRIVES = [np.sin(np.pi * np.linspace(0.0, 1.0, LENGTH)) ** p for p in np.linspace(0.5, 8.0, PRESSES)]
EDGES = doubling_edges(60)
MEMORY = np.concatenate([lagged_means(d, EDGES) for d in DRIVES])
OFFSET, PRIOR = np.ones((len(PRESS), 1)), np.array([0.5])


def memory_of(time_constant):
    """Exponential memory of each press's drive: what a named mechanism would give."""
    kernel = np.exp(-np.arange(LENGTH) / time_constant) / time_constant
    return np.concatenate([np.convolve(kernel, d)[:LENGTH] for d in DRIVES])


NAMED = memory_of(4.0)
OUTSIDE = np.concatenate([np.roll(d, 25) * (np.arange(LENGTH) >= 25) for d in DRIVES])  # an echo: no relaxation


def scores(truth):
    residual = RNG.standard_normal(len(PRESS)) + truth + 0.2
    named = linear_forecast(residual, np.column_stack([OFFSET, NAMED]), np.array([0.5, 10.0]), PRESS).log_scores
    return named, impulse_response_forecast(residual, OFFSET, PRIOR, MEMORY, PRESS).log_scores


def test_lags_double_and_reach_the_longest():
    np.testing.assert_array_equal(EDGES, [0, 1, 2, 4, 8, 16, 32, 64])


def test_columns_are_means_of_the_past_drive():
    drive = RNG.standard_normal(40)
    columns = lagged_means(drive, np.array([0, 1, 2, 4]))
    moved = drive - drive[0]
    np.testing.assert_allclose(columns[:, 0], moved)
    np.testing.assert_allclose(columns[10, 2], moved[7:9].mean())
    np.testing.assert_allclose(columns[2, 2], moved[0] / 2.0, atol=1e-15)


def test_the_evidence_finds_the_prior_that_drew_the_response():
    columns = RNG.standard_normal((400, 60))
    drawn = [columns @ RNG.normal(0.0, 0.7, 60) + RNG.standard_normal(400) for _ in range(10)]
    ridge = np.ones(60, dtype=bool)
    found = [ridge_by_evidence(Sums.from_columns(columns, values), np.zeros(60), ridge) for values in drawn]
    assert np.mean(found) == pytest.approx(0.7, rel=0.1)


def test_in_noise_the_response_shrinks_to_nothing():
    residual = RNG.standard_normal(len(PRESS))
    without = linear_forecast(residual, OFFSET, PRIOR, PRESS).log_scores
    box = impulse_response_forecast(residual, OFFSET, PRIOR, MEMORY, PRESS).log_scores
    assert -0.5 < (box - without).mean() < 0.5


def test_a_named_truth_is_not_beaten():
    named, box = scores(2.0 * NAMED)
    assert sure_gain(box - named, 0.05) <= 0.0
    assert (named - box).mean() > 0.0


def test_a_truth_outside_is_better_predicted_by_the_black_box():
    named, box = scores(2.0 * OUTSIDE)
    assert sure_gain(box - named, 0.01) > 0.0

"""Columns of an impulse response hold the memory that they promise."""

import numpy as np
import pytest

from diagnose.statistics.impulse_response import doubling_edges, lagged_means

DRIVE = np.sin(np.pi * np.linspace(0.0, 1.0, 200)) ** 2


def test_edges_double_and_reach_the_longest_lag():
    edges = doubling_edges(60)
    assert edges[:4].tolist() == [0, 1, 2, 4]
    assert edges[-1] >= 60
    assert set(np.diff(edges)[1:] / np.diff(edges)[:-1]) <= {1.0, 2.0}


def test_a_column_is_the_mean_of_the_drive_over_its_lags():
    """At rest before the first sample."""
    found = lagged_means(DRIVE, np.array([0, 1, 3]))
    padded = np.concatenate([np.full(3, DRIVE[0]), DRIVE])
    np.testing.assert_allclose(found[:, 0], DRIVE - DRIVE[0], atol=1e-14)
    np.testing.assert_allclose(found[:, 1], 0.5 * (padded[2:-1] + padded[1:-2]) - DRIVE[0], atol=1e-14)


def test_an_exponential_memory_is_among_them():
    kernel = np.exp(-np.arange(200) / 20.0) / 20.0
    memory = np.convolve(kernel, DRIVE)[:200]
    columns = lagged_means(DRIVE, doubling_edges(200))
    made = columns @ np.linalg.lstsq(columns, memory, rcond=None)[0]
    assert np.linalg.norm(memory - made) < 0.01 * np.linalg.norm(memory)


def test_what_comes_later_changes_nothing_earlier():
    later = DRIVE.copy()
    later[150:] += 1.0
    edges = doubling_edges(100)
    np.testing.assert_allclose(lagged_means(later, edges)[:150], lagged_means(DRIVE, edges)[:150])
    assert lagged_means(later, edges)[150:] != pytest.approx(lagged_means(DRIVE, edges)[150:])

"""Smooth curves through a press whose surface touches node by node."""

import numpy as np
import pytest

from solve.tables.smoothing import PRESSED, smooth

BETWEEN = np.linspace(0.1, 1.0, 50)


def press(shares):
    """A ball whose force stiffens, on a film that bends: force in N, area in m2, charge in C."""
    shares = np.asarray(shares)
    force = 0.2 * shares**1.5 * (1.0 + 0.4 * shares)
    return np.column_stack([force, 1e-6 * shares, 1e-10 * force * (0.1 + shares**2)])


def waves(shares, size, rng):
    """Factors that differ most where few nodes touch."""
    return 1.0 + size * rng.standard_normal((len(shares), 3)) / np.sqrt(np.asarray(shares))[:, None]


def test_a_smooth_press_stays_as_it_is():
    found = smooth(PRESSED, press(PRESSED))
    np.testing.assert_allclose(found.at(BETWEEN), press(BETWEEN), rtol=2e-3)
    assert found.error.max() < 1e-3


def test_below_the_first_share_a_ball_follows_its_power_law():
    shares = np.array([0.01, 0.02])
    light = smooth(PRESSED, press(PRESSED)).at(shares)
    assert light[1, 0] / light[0, 0] == pytest.approx(2.0**1.5, rel=0.03)


def test_waves_are_smoothed_to_within_the_stated_error():
    off, stated = [], []
    for seed in range(40):
        rng = np.random.default_rng(seed)
        found = smooth(PRESSED, press(PRESSED) * waves(PRESSED, 0.01, rng))
        off.append(np.sqrt(np.mean((found.at(BETWEEN)[:, 0] / press(BETWEEN)[:, 0] - 1.0) ** 2)))
        stated.append(found.error[0])
    assert np.mean(stated) == pytest.approx(np.sqrt(np.mean(np.square(off))), rel=0.4)
    assert np.mean(off) < 0.01


def test_a_share_without_contact_says_nothing():
    outputs = press(PRESSED)
    outputs[0] = 0.0
    np.testing.assert_allclose(smooth(PRESSED, outputs).at(BETWEEN), press(BETWEEN), rtol=2e-3)


def test_an_electrode_without_charge_has_none():
    outputs = press(PRESSED)
    outputs[:, 2] = 0.0
    found = smooth(PRESSED, outputs)
    assert np.abs(found.at(BETWEEN)[:, 2]).max() == 0.0
    assert found.error[2] == 0.0

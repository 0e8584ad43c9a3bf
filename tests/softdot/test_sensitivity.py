import numpy as np
import pytest

from softdot.sensitivity import least_detectable


def test_a_linear_signal_is_detected_where_it_crosses_the_noise():
    depth = np.array([0.0, 0.1, 0.2, 0.3])
    assert least_detectable(depth, 5.0 * depth, noise_V=0.01) == pytest.approx(0.002)
    assert least_detectable(depth, -5.0 * depth, noise_V=0.75) == pytest.approx(0.15)


def test_a_membrane_signal_follows_its_power_law_below_the_first_step():
    depth = np.array([0.0, 0.1, 0.2, 0.3])
    assert least_detectable(depth, 100.0 * depth**2, noise_V=1e-2) == pytest.approx(0.01)


def test_a_signal_below_the_noise_is_not_detected():
    depth = np.array([0.0, 0.1, 0.2])
    assert least_detectable(depth, 1e-6 * depth, noise_V=1e-3) is None


def test_a_single_step_is_read_linearly():
    assert least_detectable(np.array([0.0, 0.3]), np.array([0.0, 3.0]), noise_V=1.0) == pytest.approx(0.1)

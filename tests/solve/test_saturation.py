"""An amplifier at its limit."""

import numpy as np
import pytest

from solve.readout.stages import Saturation
from tests.cases import for_each

VOLTAGE = np.linspace(-50.0, 50.0, 2001)
TIME = np.zeros(1)


def test_without_a_knee_it_clips():
    np.testing.assert_array_equal(Saturation(0.5).apply(VOLTAGE, VOLTAGE), np.clip(VOLTAGE, -0.5, 0.5))


def test_a_very_sharp_knee_is_none():
    np.testing.assert_allclose(Saturation(0.5, 1000.0).apply(VOLTAGE, VOLTAGE), np.clip(VOLTAGE, -0.5, 0.5), atol=4e-4)


@for_each("sharpness", [1.0, 2.0, 8.0])
def test_the_knee_lies_between_line_and_limit(sharpness):
    """V_max / 2^(1/p) at V_max, slope one at zero, odd, and the limit far away."""
    law = Saturation(0.5, sharpness)
    assert law.apply(TIME, np.array([0.5]))[0] == pytest.approx(0.5 * 2.0 ** (-1.0 / sharpness))
    assert law.apply(TIME, np.array([1e-6]))[0] == pytest.approx(1e-6, rel=1e-5)
    assert law.apply(TIME, np.array([1e9]))[0] == pytest.approx(0.5)
    found = law.apply(VOLTAGE, VOLTAGE)
    np.testing.assert_allclose(found, -found[::-1])
    assert (np.abs(found) <= np.minimum(np.abs(VOLTAGE), 0.5)).all()


def test_a_sharpness_of_two_and_a_half_is_about_a_hyperbolic_tangent():
    ratio = np.linspace(-3.0, 3.0, 301)
    np.testing.assert_allclose(Saturation(1.0, 2.5).apply(ratio, ratio), np.tanh(ratio), atol=0.03)

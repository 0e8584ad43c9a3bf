"""The acceleration of a path that was measured."""

import numpy as np
import pytest

from diagnose.signals.acceleration import acceleration_mm_per_s2, path_noise_mm
from diagnose.signals.recording import Run
from foundation.arrays import Floats
from tests.cases import for_each

TIME = np.arange(0.0, 3.0, 0.002)
RISE_S, DEPTH_MM = 0.3, 0.5


def quintic(time: Floats) -> tuple[Floats, Floats]:
    """A step of least jerk after one second, back after two, and its acceleration (t,) each."""
    path, acceleration = np.zeros(len(time)), np.zeros(len(time))
    for start, height in ((1.0, DEPTH_MM), (2.0, -DEPTH_MM)):
        s = np.clip((time - start) / RISE_S, 0.0, 1.0)
        path += height * s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
        acceleration += height / RISE_S**2 * s * (60.0 - 180.0 * s + 120.0 * s**2)
    return path, acceleration


@for_each("noise", [0.1e-3, 0.5e-3, 2e-3])
@for_each("seed", range(3))
def test_noise_of_the_encoder_is_no_acceleration(noise: float, seed: int) -> None:
    path, truth = quintic(TIME)
    measured = path + np.random.default_rng(seed).normal(0.0, noise, len(TIME))
    found = acceleration_mm_per_s2(TIME, measured)
    mass = float(found @ truth) / float(found @ found)  # by least squares, of a force that follows the truth
    assert mass == pytest.approx(1.0, abs=0.05)
    assert np.std(found - truth) < 0.2 * np.std(truth)


@for_each("digit_mm", [1e-3, 5e-3])
def test_nor_is_the_last_digit_of_a_scale(digit_mm: float) -> None:
    path, truth = quintic(TIME)
    found = acceleration_mm_per_s2(TIME, np.round(path / digit_mm) * digit_mm)
    assert float(found @ truth) / float(found @ found) == pytest.approx(1.0, abs=0.05)


def test_a_path_without_noise_is_differentiated_as_it_is() -> None:
    path, truth = quintic(TIME)
    at_a_corner = 60.0 * DEPTH_MM / RISE_S**3 * 0.002 / 6.0  # jump of the jerk times step over 6
    np.testing.assert_allclose(acceleration_mm_per_s2(TIME, path), truth, atol=1.01 * at_a_corner)


def test_a_crosshead_that_starts_at_once_passes_on_its_pulse() -> None:
    speed = 2.0
    path = speed * np.maximum(TIME - 1.0, 0.0)
    found = acceleration_mm_per_s2(TIME, path)
    assert float(found.sum()) * 0.002 == pytest.approx(0.0, abs=1e-9)  # it stops again after the last sample
    assert float(found[:-1].sum()) * 0.002 == pytest.approx(speed, rel=1e-6)


@for_each("noise", [0.2e-3, 1e-3])
def test_the_noise_of_a_moving_column_is_told_without_a_rest(noise: float) -> None:
    path = quintic(TIME)[0][(TIME > 1.0) & (TIME < 2.3)]
    measured = path + np.random.default_rng(7).normal(0.0, noise, len(path))
    assert path_noise_mm(measured) == pytest.approx(noise, rel=0.15)


def test_what_is_added_to_a_measured_path_has_no_noise() -> None:
    path, _ = quintic(TIME)
    measured = path + np.random.default_rng(3).normal(0.0, 0.2e-3, len(TIME))
    run = Run("a", "a.csv", TIME, "displacement_mm", {"displacement_mm": measured}, {}, {})
    rate = 2.0 * np.pi * 5.0
    other = run.with_drive(measured + 1e-3 * np.sin(rate * TIME))
    added = other.acceleration_mm_per_s2 - run.acceleration_mm_per_s2
    np.testing.assert_allclose(added[1:-1], -1e-3 * rate**2 * np.sin(rate * TIME)[1:-1], atol=1e-3 * rate**2 * 1e-3)

"""What is said of a recording does not depend on its units, its sign or the clock by which it was made.

Factors are powers of two, so that nothing is rounded.
"""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from diagnose.signals.acceleration import acceleration_mm_per_s2, path_noise_mm
from diagnose.signals.align import lag_between
from diagnose.signals.phases import find_phases, rest_level
from diagnose.signals.recording import even_pieces, is_evenly_sampled, samples_after_gaps, sampling_rates_Hz
from diagnose.signals.saturation import saturation_mask
from diagnose.signals.smoothed_drive import smoothed_drive
from tests.diagnose.rigs import trapezoid

SEVERAL = settings(max_examples=15, deadline=None)
FACTORS = st.integers(-12, 12).map(lambda power: 2.0**power)
TIME_S = np.arange(2000) / 512.0


@st.composite
def drives(draw):
    """One or two presses with noise, at even times of 512 Hz."""
    noise = draw(st.sampled_from([0.0, 1e-4, 2e-3])) * np.random.default_rng(draw(st.integers(0, 9))).normal(size=2000)
    rise, hold = draw(st.floats(0.05, 0.3)), draw(st.sampled_from([0.0, 0.05, 0.5]))
    first, second = (trapezoid(TIME_S, depth, touch, rise, hold) for depth, touch in ((0.3, 0.5), (0.2, 2.5)))
    return (np.maximum(first, second) if draw(st.booleans()) else first) + noise


@SEVERAL
@given(drives(), FACTORS, FACTORS, st.booleans())
def test_phases_do_not_depend_on_units(drive, length, time, from_touch):
    one, other = find_phases(TIME_S, drive, from_touch), find_phases(time * TIME_S, length * drive, from_touch)
    assert one.presses == other.presses
    assert len(one.presses) in (1, 2)
    assert rest_level(length * drive) == tuple(length * part for part in rest_level(drive))


@SEVERAL
@given(drives(), st.integers(-8, 8))
def test_phases_of_a_travel_do_not_depend_on_its_zero(drive, shift):
    """On a grid on which a shift rounds nothing."""
    travel = np.round(drive * 2**20) / 2**20
    assert find_phases(TIME_S, travel, False).presses == find_phases(TIME_S, travel + shift, False).presses


@SEVERAL
@given(st.floats(0.05, 0.5), st.floats(0.1, 1.0), st.floats(-4.0, -2.0), st.integers(0, 99), FACTORS, st.booleans())
def test_a_smoothed_drive_is_nearer_to_the_motion_in_any_unit(rise, hold, exponent, seed, length, sine):
    motion = 0.3 * np.sin(np.pi * TIME_S / (4.0 * rise)) if sine else trapezoid(TIME_S, 0.3, 0.5, rise, hold)
    assert smoothed_drive(motion, [slice(0, 2000)]).values == pytest.approx(motion, abs=1e-6)
    noise = 10.0**exponent * np.random.default_rng(seed).normal(size=2000)
    found, scaled = (smoothed_drive(by * (motion + noise), [slice(0, 2000)]).values for by in (1.0, length))
    assert scaled == pytest.approx(length * found, rel=1e-12, abs=1e-12 * length)
    assert np.std(found - motion) < 0.8 * 10.0**exponent
    assert np.abs(found - motion).max() < 6.0 * 10.0**exponent


@SEVERAL
@given(st.integers(-40, 40), FACTORS, FACTORS, FACTORS, st.sampled_from([1.0, -1.0]))
def test_a_lag_turns_with_its_signals_and_scales_with_the_step(shift, gain, other_gain, step, sign):
    rng, time = np.random.default_rng(4), np.arange(600.0)
    bell, later = (np.exp(-(((time - place) / 30.0) ** 2)) for place in (300.0, 300.25 + shift))
    bell, later = bell + 1e-3 * rng.normal(size=600), later + 1e-3 * rng.normal(size=600)
    there, back = lag_between(bell, later, step), lag_between(gain * later, sign * other_gain * bell, step)
    assert there.lag_s == pytest.approx(step * (shift + 0.25), abs=0.2 * step)
    assert back.lag_s == pytest.approx(-there.lag_s, abs=4.0 * there.sigma_s)
    assert back.correlation == pytest.approx(sign * there.correlation, abs=1e-4)
    assert back.sigma_s == pytest.approx(there.sigma_s, rel=0.3)


def test_no_lag_beyond_the_largest_is_found():
    time = np.arange(600.0)
    bell, later = (np.exp(-(((time - place) / 30.0) ** 2)) for place in (300.0, 340.0))
    assert lag_between(bell, later, 0.01).lag_s == pytest.approx(0.4, abs=1e-3)
    assert lag_between(bell, later, 0.01, 0.5).lag_s == pytest.approx(0.4, abs=1e-3)
    assert lag_between(bell, later, 0.01, 0.1).lag_s == pytest.approx(0.1, abs=1e-9)


@SEVERAL
@given(FACTORS, FACTORS, st.integers(0, 99))
def test_acceleration_has_the_units_of_its_path(length, time, seed):
    path = np.sin(3.0 * TIME_S[:400]) + 1e-4 * np.random.default_rng(seed).normal(size=400)
    found = acceleration_mm_per_s2(TIME_S[:400], path)
    scaled = acceleration_mm_per_s2(time * TIME_S[:400], length * path)
    size = np.abs(found).max()
    np.testing.assert_allclose(scaled * time**2 / length, found, rtol=0, atol=1e-6 * size)
    assert path_noise_mm(length * path) == pytest.approx(1e-4 * length, rel=0.3)


@SEVERAL
@given(st.lists(st.sampled_from([2, 3, 4, 10, 37]), min_size=1, max_size=60), FACTORS)
def test_pieces_of_even_sampling_do_not_depend_on_the_unit_of_time(steps, unit):
    time = np.concatenate([[0.0], np.cumsum(np.repeat(steps, 3))])
    assert even_pieces(time) == even_pieces(unit * time)
    assert samples_after_gaps(time) == samples_after_gaps(unit * time)
    assert sampling_rates_Hz(unit * time) == [rate / unit for rate in sampling_rates_Hz(time)]
    assert is_evenly_sampled(time) == is_evenly_sampled(unit * time) == (len(set(steps)) == 1)


@SEVERAL
@given(st.integers(4, 60), FACTORS, st.sampled_from([1.0, -1.0]), st.integers(0, 9))
def test_samples_at_a_limit_are_found_in_any_unit_and_sign(count, unit, sign, seed):
    values = np.random.default_rng(seed).normal(size=300)
    top = np.abs(values).max() + 0.5
    values[100 : 100 + count] = top
    expected = np.flatnonzero(values == top)
    assert np.flatnonzero(saturation_mask(sign * unit * values)).tolist() == expected.tolist()
    assert np.flatnonzero(saturation_mask(sign * unit * values, unit * top)).tolist() == expected.tolist()
    assert saturation_mask(sign * unit * values[:100]).sum() == 0

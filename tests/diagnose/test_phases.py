"""Phases follow the drive alone."""

import numpy as np
import pytest

from diagnose.signals.phases import PHASES, find_phases
from diagnose.signals.recording import even_pieces, samples_after_gaps, sampling_rates_Hz
from tests.cases import for_each
from tests.diagnose.rigs import trapezoid

TIME = 1e-3 * np.arange(4000)


def seconds(press):
    """Bounds of the phases in s."""
    return [bound * 1e-3 for bound in press.bounds]


@for_each("noise_mm", [0.0, 0.001])
def test_a_trapezoid_has_five_phases(noise_mm):
    drive = trapezoid(TIME, 0.3) + noise_mm * np.random.default_rng(1).standard_normal(len(TIME))
    (press,) = find_phases(TIME, drive).presses
    assert seconds(press) == pytest.approx([0.0, 1.0, 1.2, 1.7, 1.9, 4.0], abs=0.02)


def test_every_sample_has_its_phase():
    phase = find_phases(TIME, trapezoid(TIME, 0.3)).phase
    assert [PHASES[phase[int(t * 1000)]] for t in (0.5, 1.1, 1.5, 1.8, 2.5)] == list(PHASES)


def test_a_hold_that_was_sampled_thinly():
    time = np.concatenate([TIME[:1250], TIME[1250:1650:40], TIME[1650:]])
    (press,) = find_phases(time, trapezoid(time, 0.3)).presses
    assert [float(time[bound]) for bound in press.bounds[1:5]] == pytest.approx([1.0, 1.2, 1.7, 1.9], abs=0.02)


def test_a_half_sine_has_no_hold():
    drive = np.where((TIME > 1.0) & (TIME < 2.0), 0.3 * np.sin(np.pi * (TIME - 1.0)), -0.05)
    (press,) = find_phases(TIME, drive).presses
    assert press.held == press.released == pytest.approx(1500, abs=3)


def test_a_ramp_that_stays_is_never_unloaded():
    (press,) = find_phases(TIME, np.interp(TIME, [1.0, 1.5], [0.0, 0.3])).presses
    assert seconds(press) == pytest.approx([0.0, 1.0, 1.5, 4.0, 4.0, 4.0], abs=0.02)


def test_presses_of_one_run_are_counted():
    drive = np.maximum(trapezoid(TIME, 0.3, 0.5, 0.1, 0.3), trapezoid(TIME, 0.2, 2.5, 0.1, 0.3))
    found = find_phases(TIME, drive)
    assert [seconds(press)[1:5] for press in found.presses] == [
        pytest.approx([0.5, 0.6, 0.9, 1.0], abs=0.02),
        pytest.approx([2.5, 2.6, 2.9, 3.0], abs=0.02),
    ]
    assert found.press[[0, 1000, 3999]].tolist() == [0, 0, 1]


def test_a_force_that_rests_above_zero_and_relaxes_in_the_hold():
    shape = np.clip(trapezoid(TIME, 1.0), 0.0, None)
    relaxing = np.where((TIME > 1.2) & (TIME < 1.7), 0.8 + 0.2 * np.exp(-(TIME - 1.2) / 0.05), 1.0)
    noise = 0.02 * np.random.default_rng(2).standard_normal(len(TIME))
    (press,) = find_phases(TIME, 0.37 + 3.0 * np.minimum(shape, relaxing) + noise, from_touch=False).presses
    assert seconds(press)[1:5] == pytest.approx([1.0, 1.2, 1.7, 1.9], abs=0.06)


def test_hum_at_rest_is_no_touch():
    """Slow against the samples, so that their second differences hardly show it."""
    drive = 3.0 * np.clip(trapezoid(TIME, 1.0), 0.0, None) - 0.05 * np.sin(2.0 * np.pi * 4.0 * TIME)
    (press,) = find_phases(TIME, drive, from_touch=False).presses
    assert seconds(press)[1:5] == pytest.approx([1.0, 1.2, 1.7, 1.9], abs=0.06)


def test_a_spike_is_no_press():
    drive = trapezoid(TIME, 0.3)
    drive[3000:3004] = 0.1
    assert len(find_phases(TIME, drive).presses) == 1


def test_what_bounces_where_a_press_lets_go_is_no_press():
    """A finger that strikes again just after it has let go; a shallow press after a rest is one."""
    press, bounce = trapezoid(TIME, 0.3), trapezoid(TIME, 0.04, 2.0, 0.02, 0.02)
    shallow = trapezoid(TIME, 0.04, 3.0, 0.1, 0.3)
    assert len(find_phases(TIME, np.maximum(press, bounce)).presses) == 1
    assert len(find_phases(TIME, np.maximum(press, shallow)).presses) == 2


def test_a_drive_that_stays_clear_has_no_press():
    assert find_phases(TIME[:100], np.linspace(-0.5, -0.1, 100)).presses == ()


def test_a_gap_and_another_rate_begin_new_pieces():
    time = np.concatenate([0.01 * np.arange(100), 2.0 + 0.01 * np.arange(100), 3.1 + 0.002 * np.arange(100)])
    pieces = [piece for piece in even_pieces(time) if piece.stop - piece.start > 9]
    assert [(piece.start, piece.stop) for piece in pieces] == [(0, 100), (100, 200), (200, 300)]
    assert samples_after_gaps(time)[0] == 100
    assert sampling_rates_Hz(time) == pytest.approx([100.0, 500.0])


def test_an_even_clock_with_jitter_is_one_piece():
    time = 0.01 * (np.arange(500) + 0.1 * np.random.default_rng(3).uniform(-1, 1, 500))
    assert even_pieces(time) == (slice(0, 500),)

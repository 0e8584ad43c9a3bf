"""When what is pressed how far."""

import numpy as np
import pytest

from solve.model import Press
from solve.solution.schedule import Target, load_between, schedule
from solve.system import Load
from solve.waveform import Waveform
from tests.cases import for_each

TRAPEZOID = Waveform(shape="trapezoid", rise_s=0.2, hold_s=0.5, fall_s=0.1)


def times(targets):
    return np.array([t.time for t in targets])


def drives(targets):
    return np.array([t.load.drive for t in targets])


def test_what_does_not_follow_time_is_pressed_once_in_equal_steps():
    targets = schedule(Press(load_steps=4, waveform=TRAPEZOID), 2.0, 1.0, follows_time=False)
    np.testing.assert_allclose(drives(targets), [0.0, 0.5, 1.0, 1.5, 2.0])
    np.testing.assert_allclose(times(targets), [0.0, 0.05, 0.1, 0.15, 0.2])


def test_what_follows_time_goes_along_the_whole_waveform():
    targets = schedule(Press(load_steps=2, waveform=TRAPEZOID), 2.0, 1.0, follows_time=True)
    np.testing.assert_allclose(times(targets), [0.0, 0.1, 0.2, 0.45, 0.7, 0.75, 0.8])
    np.testing.assert_allclose(drives(targets), [0.0, 1.0, 2.0, 2.0, 2.0, 1.0, 0.0], atol=1e-12)


def test_the_rate_jumps_at_the_corners_only():
    targets = schedule(Press(load_steps=2, waveform=TRAPEZOID), 2.0, 1.0, follows_time=True)
    assert [t.kink for t in targets] == [True, False, True, False, True, False, True]


def test_a_release_ends_at_exactly_nothing():
    half_sine = Press(load_steps=3, waveform=Waveform(shape="half-sine", rise_s=0.3))
    assert schedule(half_sine, 2.0, 1.0, follows_time=True)[-1].load.drive == 0.0


@for_each("shape", ["ramp", "half-sine", "raised-cosine", "trapezoid"])
def test_every_waveform_starts_at_rest_and_passes_through_its_peak(shape):
    press = Press(waveform=Waveform(shape=shape))
    targets = schedule(press, 2.0, 1.0, follows_time=True)
    for target in *targets, *schedule(press, 2.0, 1.0, follows_time=False):
        assert target.load.lateral == (0.0, 0.0)
    assert targets[0].load.drive == 0.0
    assert drives(targets).max() == pytest.approx(2.0)
    assert (np.diff(times(targets)) > 0.0).all()


def test_a_file_that_starts_pressed_is_reached_from_rest(tmp_path):
    table = tmp_path / "w.csv"
    table.write_text("time_s,fraction\n0,0.5\n1,1\n", "utf-8")
    targets = schedule(
        Press(load_steps=1, waveform=Waveform(shape="file", file=str(table), rise_s=0.25)), 2.0, 1.0, True
    )
    np.testing.assert_allclose(times(targets), [-0.25, 0.0, 1.0])
    np.testing.assert_allclose(drives(targets), [0.0, 1.0, 2.0])


def test_a_slide_follows_the_press_at_its_load_leg_by_leg():
    press = Press(load_steps=2, path_xy_mm=((1.0, 0.0), (1.0, -2.0)), waveform=Waveform(rise_s=0.2))
    targets = schedule(press, 2.0, 1e-3, follows_time=False)[-4:]
    np.testing.assert_allclose([t.load.lateral for t in targets], [[0.5, 0], [1, 0], [1, -1], [1, -2]])
    np.testing.assert_allclose(times(targets), [0.3, 0.4, 0.5, 0.6])
    np.testing.assert_allclose(drives(targets), 2.0)


def test_in_a_trapezoid_the_dot_is_pressed_slid_in_the_hold_and_lifted():
    waveform = Waveform(shape="trapezoid", rise_s=0.1, hold_s=0.4, fall_s=0.2)
    press = Press(load_steps=1, path_xy_mm=((1.0, 0.0), (0.0, 0.0)), waveform=waveform)
    targets = schedule(press, 2.0, 1e-3, follows_time=False)
    np.testing.assert_allclose(times(targets), [0.0, 0.1, 0.3, 0.5, 0.7])
    np.testing.assert_allclose(drives(targets), [0.0, 2.0, 2.0, 2.0, 0.0])
    np.testing.assert_allclose([t.load.lateral[0] for t in targets], [0, 0, 1, 0, 0])


def test_between_two_targets_the_load_is_linear_or_on_its_waveform():
    start, linear = Target(0.0, Load((0.0, 1.0), 2.0), True), Target(2.0, Load((4.0, 3.0), 6.0), True)
    load, time = load_between(start, linear, 0.25)
    assert (load.lateral, load.drive, time) == ((1.0, 1.5), 3.0, 0.5)
    sine = schedule(Press(load_steps=1, waveform=Waveform(shape="half-sine", rise_s=1.0)), 2.0, 1.0, True)
    assert load_between(sine[0], sine[1], 0.5)[0].drive == pytest.approx(2.0 * np.sin(np.pi / 4))

"""The dots of a line, and how the array moves over them."""

from dataclasses import replace

import numpy as np
import pytest

from foundation.errors import InputError
from geometry.braille_standards import standard
from softdot.reading.cells import cells_of
from softdot.reading.conditions import WIDEST_SIGMA, ReadingConditions, refuse_idle
from softdot.reading.line import manufactured_line, nominal_line
from softdot.reading.motion import ArrayPath, array_path, dots_near, reach_mm
from tests.cases import for_each

MARBURG = standard("marburg-medium")


def test_dots_lie_at_the_pitches_of_the_standard():
    """The letters d and a: dots 1, 4 and 5, then dot 1 a cell pitch later."""
    line = nominal_line(cells_of("da"), MARBURG)
    assert sorted(zip(line.x_mm, line.y_mm, strict=True)) == [(-1.25, -2.5), (1.25, -2.5), (1.25, 0.0), (4.75, -2.5)]


def test_scatter_wear_and_missing_dots_are_as_stated(kernel):
    conditions = ReadingConditions(
        height_scatter_mm=0.01, position_scatter_mm=0.05, worn=0.25, wear_mm=0.1, missing=0.2
    ).with_implied_values(kernel)
    cells = np.full(2000, 63)
    line = manufactured_line(cells, MARBURG, conditions, np.random.default_rng(0))
    assert len(line.x_mm) / 12_000 == pytest.approx(0.8, abs=0.015)
    worn = line.extra_mm < -0.05
    assert worn.mean() == pytest.approx(0.25, abs=0.015)
    assert line.extra_mm[~worn].std() == pytest.approx(0.01, rel=0.1)
    assert np.abs(line.extra_mm[~worn]).max() <= 0.01 * WIDEST_SIGMA
    assert (line.y_mm - np.round(line.y_mm / 2.5) * 2.5).std() == pytest.approx(0.05, rel=0.1)
    assert (np.diff(line.x_mm) >= 0.0).all()


def test_a_standard_with_a_range_scatters_within_it(kernel):
    """UKAAF: 0.4 to 0.6 mm."""
    conditions = ReadingConditions(standard="ukaaf").with_implied_values(kernel)
    assert WIDEST_SIGMA * conditions.height_scatter_mm == pytest.approx(0.1)
    assert conditions.depth_mm + 0.1 < kernel.depth_mm[-1]


def path_of(kernel, cells, **given):
    conditions = ReadingConditions(**given).with_implied_values(kernel)
    random = np.random.default_rng(1)
    line = manufactured_line(cells, MARBURG, conditions, random)
    return line, array_path(kernel, line, len(cells), MARBURG, conditions, random)


def test_a_slide_passes_every_cell_at_its_time(kernel):
    _, path = path_of(kernel, cells_of("touch"), speed_mm_per_s=20.0)
    np.testing.assert_allclose(np.interp(path.reached_s, path.time_s, path.x_mm), 6.0 * np.arange(5), atol=1e-9)
    assert path.x_mm[0] < -1.25 - reach_mm(kernel, 0.0)
    assert path.x_mm[-1] > 24.0 + 1.25 + reach_mm(kernel, 0.0)


def test_a_hand_moves_as_stated(kernel):
    """The logarithm of its speed has its standard deviation; it rests, goes back, and leaves from the other end."""
    _, path = path_of(kernel, np.ones(200, dtype=int), speed_mm_per_s=40.0, speed_cv=0.2, speed_time_s=0.2)
    log_speed = np.log(np.diff(path.x_mm)[:-1] / np.diff(path.time_s)[:-1])
    assert log_speed.std() == pytest.approx(0.2, rel=0.2)
    assert log_speed.mean() == pytest.approx(np.log(40.0), abs=0.08)
    _, path = path_of(kernel, np.ones(20, dtype=int), pauses=2.0, ways_back=3.0, leftward=True)
    moved = np.diff(path.x_mm)
    assert path.x_mm[0] > path.x_mm[-1]
    assert 9.0 <= moved[moved > 0.0].sum() <= 30.0
    assert 0.6 <= (np.abs(moved) < 1e-3).sum() * path.time_s[1] <= 3.0
    assert (np.diff(path.reached_s) < 0.0).all()


def test_a_path_wanders_is_skewed_and_loses_contact(kernel):
    _, path = path_of(kernel, np.ones(400, dtype=int), wander_mm=0.3, tremor_um=0.0, contact_losses=1.0)
    assert path.y_mm.std() == pytest.approx(0.3, rel=0.3)
    assert (path.depth_mm <= 0.0).sum() * path.time_s[1] == pytest.approx(0.2, abs=0.05)
    _, path = path_of(kernel, np.ones(20, dtype=int), skew_deg=1.0, tremor_um=0.0)
    np.testing.assert_allclose(np.ptp(path.y_mm) / np.ptp(path.x_mm), np.tan(np.radians(1.0)))


def test_tremor_has_its_rms_and_bandwidth(kernel):
    _, path = path_of(kernel, cells_of("touch " * 60), tremor_um=5.0, tremor_Hz=2.0)
    wobble = path.depth_mm - path.depth_mm.mean()
    assert 1e3 * wobble.std() == pytest.approx(5.0, rel=0.1)
    power = np.abs(np.fft.rfft(wobble)) ** 2
    frequency = np.fft.rfftfreq(len(wobble), path.time_s[1])
    assert power[frequency < 4.0].sum() > 0.95 * power.sum()


def test_a_held_force_is_that_force(kernel):
    """Wherever the array is above its stop; between words it rests on the stop, with less."""
    line, path = path_of(kernel, cells_of("soft dots"), force_N=0.5, tremor_um=0.0)
    force = kernel.of_many(*dots_near(kernel, line, path, slice(None)))[1]
    stop = path.depth_mm.max()
    held = path.depth_mm < stop - 1e-6
    np.testing.assert_allclose(force[held], 0.5, rtol=2e-3)
    assert (force[path.depth_mm == stop] <= 0.5 + 1e-3).all()
    assert 0.3 < path.held < 1.0
    assert path.held == pytest.approx(np.mean(path.depth_mm < stop), abs=0.01)


def test_a_turned_array_sees_the_line_turned(kernel):
    """A dot under the middle stays there, one on the array's turned x axis has y = 0."""
    angle = np.radians(30.0)
    line = replace(nominal_line(cells_of("d"), MARBURG), x_mm=np.array([1.0, 1.0 + np.cos(angle)]),
                   y_mm=np.array([0.5, 0.5 + np.sin(angle)]), extra_mm=np.zeros(2))  # fmt: skip
    path = ArrayPath(np.zeros(1), np.ones(1), np.full(1, 0.5), np.full(1, 0.2), 30.0, np.zeros(1))
    x, y, depth = dots_near(kernel, line, path, slice(None))
    np.testing.assert_allclose([x[0], y[0]], [[0.0, 1.0], [0.0, 0.0]], atol=1e-12)
    np.testing.assert_allclose(depth, 0.2)


@for_each(
    ("given", "said"),
    [
        ({"depth_mm": 0.29}, r"--depth-mm = 0.29: with scatter .* kernel ends at 0.3 mm; give at most 0.2505"),
        ({"depth_mm": 0.1, "force_N": 1.0}, "--force-N = 1: give either"),
        ({"force_N": 1.0, "mode": "press"}, "--force-N = 1: --mode press is driven by its depth"),
        ({"standard": "nls"}, r"--standard = 'nls': its dots are 2.34 mm apart, the segments of the kernel 2.5 mm"),
        ({"standard": "en-15823"}, r"--depth-mm = 0.22\d*: the plate would touch the array, as its dots are 0.2 mm"),
        ({"speed_mm_per_s": 0.0}, "--speed-mm-per-s = 0: must be from 0.5 to 500"),
        ({"noise_mV": float("nan")}, "--noise-mV = nan: must be from 0"),
    ],
)
def test_conditions_that_cannot_be_are_one_sentence(kernel, given, said):
    with pytest.raises(InputError, match=said):
        ReadingConditions(**given).with_implied_values(kernel)


@for_each(
    ("given", "is_recorded", "said"),
    [
        ({"press_s": 0.2}, False, "--press-s = 0.2: acts only with --mode press"),
        ({"hold_s": 0.1}, True, "--hold-s = 0.1: acts only with --mode press"),
        ({"wear_mm": 0.1}, False, "--wear-mm = 0.1: acts only with --worn above 0"),
        ({"tremor_um": 0.0, "tremor_Hz": 3.0}, False, "--tremor-Hz = 3.0: acts only with --tremor-um above 0"),
        ({"noise_mV": 3.0}, True, "--noise-mV = 3.0: acts only on voltages that are simulated"),
        ({"speed_mm_per_s": 3.0}, True, "--speed-mm-per-s = 3.0: acts only on voltages that are simulated"),
    ],
)
def test_conditions_that_change_nothing_are_refused(given, is_recorded, said):
    with pytest.raises(InputError, match=said):
        refuse_idle(ReadingConditions(**given), given, is_recorded)
    refuse_idle(ReadingConditions(mode="press", press_s=0.1), {"mode", "press_s", "speed_mm_per_s"}, is_recorded=True)
    refuse_idle(ReadingConditions(worn=0.1), {"worn", "wear_mm"}, is_recorded=False)


def test_a_force_that_no_depth_gives_is_refused(kernel):
    with pytest.raises(InputError, match="--force-N = 50: is never reached"):
        path_of(kernel, cells_of("dots"), force_N=50.0)

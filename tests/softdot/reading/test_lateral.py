"""The lateral place of an array: a straight line and a wander, by Kalman's equations, and what is told of its reach."""

import numba as nb
import numpy as np
import pytest

from geometry.braille_standards import standard
from softdot.reading.cells import cells_of
from softdot.reading.decoders.hand import track_hand
from softdot.reading.line_filter.givens import Sensor
from softdot.reading.line_filter.hypothesis_arrays import AHEAD, COLUMNS, LATERAL, LOG_WEIGHT, PLACE, SEEN
from softdot.reading.line_filter.lateral import (
    LEFT,
    LINE_MM,
    SLOPE,
    STEP_ASIDE_MM,
    STEP_SPREAD_MM,
    WANDER_MM,
    move_aside,
    place_spread,
    see,
    seen_at,
)
from softdot.reading.line_filter.merging import merged
from softdot.reading.line_filter.table import OFFSETS_MM, YAWS_DEG, line_table
from softdot.reading.told_line import track_warnings
from tests.cases import for_each
from tests.softdot.reading.lines import simulated

OF_PLACE = np.array([1.0, 0.0, 1.0])
SENSOR = Sensor(*3 * [np.zeros(1)], 2.5, 6.0, *4 * [np.zeros(1)], 1.6)


@nb.njit
def moved_and_seen(aside, way, fade, step, noise, slope, charge):
    """Means and covariances (9,) after a way and a step, and after a charge that changes by slope over the place."""
    memory, found = np.zeros((1, LATERAL + 9)), np.empty(9)
    memory[0, LATERAL:] = aside
    move_aside(memory, 0, way, fade, step, found)
    before = found.copy()
    residual = charge - slope * (found[0] + found[2])
    see(found, slope / (noise + slope * slope * place_spread(found)), residual, slope)
    return before, found


def matrix(aside):
    """Mean (3,) and covariance (3, 3)."""
    whole = np.zeros((3, 3))
    whole[np.triu_indices(3)] = aside[3:]
    return aside[:3], whole + whole.T - np.diag(np.diag(whole))


def test_a_place_that_was_seen_is_that_of_the_prior_given_it():
    """By Gauss's conditional distribution: the limit of an exact look is the prior's regression on the place."""
    mean, spread = matrix(seen_at(1.2, 0.2)[0])
    assert OF_PLACE @ mean == pytest.approx(1.2)
    assert OF_PLACE @ spread @ OF_PLACE == pytest.approx(0.2**2)
    assert mean[2] / mean[0] == pytest.approx(WANDER_MM**2 / LINE_MM**2)
    assert spread[1, 1] == pytest.approx(SLOPE**2)


@pytest.mark.press
@for_each("aside", [0.0, STEP_ASIDE_MM])
def test_it_moves_and_learns_by_the_equations_of_kalman(aside):
    mean, spread = matrix(start := seen_at(-0.8, 0.3)[0])
    way, fade, noise, slope, charge = 1.7, 0.9, 9.0, 40.0, -20.0
    step = np.array([[1.0, way, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, fade]])
    before, after = moved_and_seen(start, way, fade, aside, noise, slope, charge)
    added = [STEP_SPREAD_MM**2 if aside else 0.0, 0.0, (1.0 - fade**2) * WANDER_MM**2]
    mean, spread = step @ mean + [aside, 0.0, 0.0], step @ spread @ step.T + np.diag(added)
    for known, expected in zip(matrix(before), (mean, spread), strict=True):
        np.testing.assert_allclose(known, expected, atol=1e-12)
    row = slope * OF_PLACE
    gain = spread @ row / (row @ spread @ row + noise)
    expected = mean + gain * (charge - row @ mean), spread - np.outer(gain, row @ spread)
    for known, one in zip(matrix(after), expected, strict=True):
        np.testing.assert_allclose(known, one, atol=1e-12)


@pytest.mark.press
@for_each(("aside", "step", "kept"), [(1.7, 0, 1), (1.7, LEFT, 2), (-1.7, 0, 2), (0.5, 0, 2)])
def test_dots_of_a_row_that_is_not_felt_are_not_told_apart(aside, step, kept):
    """Two hypotheses that differ in a dot of the first row of the last column, which an array at 1.7 mm cannot feel.

    They are two where one of them looks for the array elsewhere.
    """
    made, memory = np.zeros((2, 4)), np.zeros((1, LATERAL + 9 + 4))
    made[:, LOG_WEIGHT] = np.log([0.75, 0.25])
    memory[0, LATERAL] = aside
    choice = np.array([[1, 4, 1, 2, 0b0011, 0], [1, 4, 1, 2, 0b0010, 0]])
    fresh = np.array([0, step])
    numbers = merged(made, choice, memory, np.zeros(2, dtype=np.int64), fresh, 2, 0.0, ((1 << 16) - 1, 0), SENSOR)
    assert len(numbers) == kept
    assert made[numbers[0], LOG_WEIGHT] == pytest.approx(0.0 if kept == 1 else np.log(0.75))


@pytest.mark.press
@for_each(("columns", "kept"), [(0x12345, 1), (0x12315, 2)])
def test_a_cell_more_before_what_was_given_out_makes_no_other_hypothesis(columns, kept):
    """The likelier one has seen a cell more, but the last four columns are the same: it is numbered as the other."""
    made, memory = np.zeros((2, 4)), np.zeros((1, LATERAL + 9 + 4))
    made[:, LOG_WEIGHT], made[:, PLACE] = np.log([0.25, 0.75]), [31.0, 37.02]
    choice = np.zeros((2, 6), dtype=np.int64)
    choice[:, SEEN], choice[:, COLUMNS] = [12, 14], [columns, 0x72345]
    numbers = merged(
        made, choice, memory, np.zeros(2, dtype=np.int64), np.zeros(2, dtype=np.int64), 2, 0.0, (0xFFFF, 5), SENSOR
    )
    assert len(numbers) == kept
    if kept == 1:
        assert list(numbers) == [1]
        assert made[1, LOG_WEIGHT] == pytest.approx(0.0)
        assert made[1, PLACE] == pytest.approx(37.0 + 0.75 * 0.02)
        assert choice[1, AHEAD] == -1


def test_the_reach_is_where_a_row_is_not_felt_any_more(kernel):
    """By the kernel itself: the largest charge of a dot of the weakest row, at both sides of the reach."""
    table = line_table(kernel, standard("marburg-medium"), is_mirrored=False)
    step = OFFSETS_MM[1] - OFFSETS_MM[0]
    place, depth = np.linspace(-3.0, 3.0, 61), 0.75 * kernel.depth_mm[-1]

    def weakest(aside):
        rows = [kernel.of_one(place, np.full(61, row - aside), np.full(61, depth))[0] for row in (-2.5, 0.0, 2.5)]
        return min(float(one.max()) for one in rows) / table.largest_pC

    assert 0.0 < table.reach_mm < OFFSETS_MM[-1]
    assert weakest(table.reach_mm) > 0.14
    assert min(weakest(table.reach_mm + step), weakest(-table.reach_mm - step)) < 0.16
    assert len(YAWS_DEG) == table.lone.shape[0]


@pytest.mark.press
def test_cells_beside_the_line_are_told_and_not_certain(kernel):
    """A path that begins and ends where the array does not feel all rows: what is certain is right."""
    true = cells_of("read by touch")
    track = track_hand(*simulated(kernel, true, speed_mm_per_s=50.0, seed=3, skew_deg=-2.0))
    assert len(track.cells) == len(true)
    certain = track.probability >= 0.9
    np.testing.assert_array_equal(track.cells[certain], true[certain])
    assert certain.sum() >= 7
    assert not certain[[0, -1]].any()
    assert track.report.beside >= 2
    assert any("beside the line" in told for told in track_warnings(track, kernel.about["labels"]))

"""Posture and speed of the array over the first cells: those whose dots explain most of the voltages.

Speeds and places of the first cells (softdot.reading.decoders.fitted) around a first speed, then offset across the line
and yaw the same way.
"""

from dataclasses import dataclass, replace

import numpy as np

from foundation.arrays import Bools, Floats
from softdot.reading.cells import DOTS
from softdot.reading.decoders.fitted import Track, cell_fit, explained_squares
from softdot.reading.decoders.model import dots_and_left_share
from softdot.reading.decoders.templates import Posture, templates
from softdot.reading.line import cell_pitch_mm
from softdot.reading.voltages import Reader, Voltages

SPEED_RANGE, LOG_SPEED_STEP = 2.2, 0.02
"""Factor around the first speed within which speeds are tried, and their distance in the logarithm."""
WINDOW_CELLS, LONGER_CELLS = 8, 20
"""Cells in the window of voltages for the first search, and for its refinement."""
PLACE_STEP_MM, SHIFT_STEP_MM = 0.2, 0.05
"""Steps of the first cell's place: over a whole pitch, and around a known place."""
MOST_RIVALS, RIVAL_DISTANCE_MM, LEAST_RIVAL_SHARE = 3, 1.0, 0.85
"""Speeds that are followed, distance of their two places, and the share of the best's score that a rival must reach."""
OFFSET_STEPS_MM, YAW_STEPS_DEG = (0.8, 0.4, 0.2, 0.1), (6.0, 3.0, 1.5)
"""Steps of offset and yaw around the best start, coarse to fine."""
EQUAL_SCORE_SHARE = 0.02
"""Share of the best score by which a place may be worse and still count as equal."""


def fit_first_cells(
    reader: Reader, heard: Voltages, many: int, active: tuple[float, float], speed: float
) -> tuple[Posture, float]:
    """The posture over the first cells, and the time at which the middle of the first one is passed."""
    step = heard.step_s / many
    window = _window(heard, active[0], WINDOW_CELLS * cell_pitch_mm(reader.standard) / speed, active[1])
    speeds = speed * np.exp(np.arange(-np.log(SPEED_RANGE), np.log(SPEED_RANGE), LOG_SPEED_STEP))
    starts = [_best_two_places(reader, window, step, many, Posture(float(one))) for one in speeds]
    rivals = _rival_starts(starts)
    pitch_s = cell_pitch_mm(reader.standard) / rivals[0].posture.speed_mm_per_s
    longer = _window(heard, active[0], LONGER_CELLS * pitch_s, active[1])
    finer = [_best_speed(reader, window, step, many, one, 0.5 * LOG_SPEED_STEP) for one in rivals]
    finer = [_best_speed(reader, longer, step, many, one, 0.25 * LOG_SPEED_STEP) for one in finer]
    best = _best_rival(reader, longer, step, many, finer)
    for offset in OFFSET_STEPS_MM:
        for yaw in YAW_STEPS_DEG[:2] if offset == OFFSET_STEPS_MM[0] else YAW_STEPS_DEG[-1:]:
            best = _best_offset_and_yaw(reader, longer, step, many, best, offset, yaw)
    best = _best_speed(reader, longer, step, many, best, 0.1 * LOG_SPEED_STEP)
    return best.posture, best.middle_s


@dataclass(frozen=True)
class _Start:
    """A posture, the time at which the first cell is passed with it, and the squares that its dots explain."""

    score: float
    posture: Posture
    middle_s: float


def _rival_starts(starts: list[tuple[_Start, ...]]) -> list[_Start]:
    """The best places of those speeds whose neighbours are worse, best first."""
    score = np.array([0.0, *(one[0].score for one in starts), 0.0])
    peaks = [one for k, one in enumerate(starts, 1) if score[k] >= max(score[k - 1], score[k + 1])]
    peaks.sort(key=lambda one: -one[0].score)
    return sorted((place for one in peaks[:MOST_RIVALS] for place in one), key=lambda place: -place.score)


def _best_rival(reader: Reader, window: Voltages, step: float, many: int, rivals: list[_Start]) -> _Start:
    """The rival whose dots leave least of the voltages, among those that explain nearly as much as the best."""
    most = max(one.score for one in rivals)
    near = [one for one in rivals if one.score > LEAST_RIVAL_SHARE * most]
    if len(near) == 1:
        return near[0]
    left, columns = [], []
    for one in near:
        fit = cell_fit(reader, templates(reader, one.posture, step, many), window)
        count = max(2, int(np.ceil((window.time_s[-1] - one.middle_s) / fit.pitch_s)) + 1)
        passed: Floats = one.middle_s + fit.pitch_s * np.arange(count, dtype=np.float64)
        dots, rest = dots_and_left_share(reader, Track(fit, window, many, passed))
        left.append(rest)
        columns.append(_left_column_share(dots.reshape(1, -1))[0])
    return near[_prefer_left_column(1.0 - np.array(left), np.array(columns))]


def _window(heard: Voltages, onset: float, long_s: float, end: float) -> Voltages:
    """The voltages from before the onset, for a duration in s, at most to behind the end."""
    margin = 0.15 * long_s
    inside = (heard.time_s >= onset - margin) & (heard.time_s <= min(onset + long_s, end + margin))
    return Voltages(heard.time_s[inside], heard.voltage_V[inside])


def _best_two_places(reader: Reader, window: Voltages, step: float, many: int, posture: Posture) -> tuple[_Start, ...]:
    """Two places of the first cell, apart, at which the dots of the window explain most."""
    fit = cell_fit(reader, templates(reader, posture, step, many), window)
    first = window.time_s[0]
    count = max(2, int(np.ceil((window.time_s[-1] - first) / fit.pitch_s)) + 1)
    starts = first + np.arange(0.0, fit.pitch_s, PLACE_STEP_MM / posture.speed_mm_per_s) - 0.5 * fit.pitch_s
    products = fit.products(starts[:, None] + fit.pitch_s * np.arange(count))
    score, raised = explained_squares(fit.matrix(count), products.reshape(len(starts), -1))
    first_best = _prefer_left_column(score, _left_column_share(raised))
    apart = np.abs((starts - starts[first_best] + 0.5 * fit.pitch_s) % fit.pitch_s - 0.5 * fit.pitch_s)
    second = int(np.argmax(np.where(apart * posture.speed_mm_per_s > RIVAL_DISTANCE_MM, score, -1.0)))
    return tuple(_Start(float(score[k]), posture, float(starts[k])) for k in (first_best, second))


def _left_column_share(raised: Floats | Bools) -> Floats:
    """Share (m,) of the dots (m, k) of some cells that lie in the left columns."""
    column = raised.reshape(len(raised), -1, 2, DOTS // 2).sum(axis=(1, 3))
    return np.asarray(column[:, 0] / np.maximum(column.sum(axis=1), 1.0))


def _prefer_left_column(score: Floats, share: Floats) -> int:
    """The number of the best place; if all its dots lie in right columns, of one nearly as good with all in left ones.

    A line with dots in one column alone does not show which one it is; letters such as a, b, k, l begin at the left.
    """
    best = int(np.argmax(score))
    left = np.flatnonzero((share == 1.0) & (score >= (1.0 - EQUAL_SCORE_SHARE) * score[best]))
    return int(left[np.argmax(score[left])]) if share[best] == 0.0 and len(left) else best


def _best_speed(reader: Reader, window: Voltages, step: float, many: int, start: _Start, by: float) -> _Start:
    """The best of the starts with speeds on both sides of a start."""
    speed = start.posture.speed_mm_per_s
    speeds = [speed * (1.0 + by * k) for k in range(-3, 4)]
    tried = [replace(start.posture, speed_mm_per_s=one) for one in speeds]
    return max((_best_place(reader, window, step, many, one, start) for one in tried), key=lambda one: one.score)


def _best_offset_and_yaw(
    reader: Reader, window: Voltages, step: float, many: int, start: _Start, offset_mm: float, yaw_deg: float
) -> _Start:
    """The best of the starts with offsets and yaws on both sides of a start."""
    own = start.posture
    turned = [
        replace(own, offset_mm=own.offset_mm + i * offset_mm, yaw_deg=own.yaw_deg + j * yaw_deg)
        for i, j in ((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1))
    ]
    return max((_best_place(reader, window, step, many, one, start) for one in turned), key=lambda one: one.score)


def _best_place(reader: Reader, window: Voltages, step: float, many: int, posture: Posture, start: _Start) -> _Start:
    """The best start with a posture near a known one."""
    fit = cell_fit(reader, templates(reader, posture, step, many), window)
    count = max(2, int(np.ceil((window.time_s[-1] - start.middle_s) / fit.pitch_s)) + 1)
    starts = start.middle_s + np.arange(-8, 9) * SHIFT_STEP_MM / posture.speed_mm_per_s
    products = fit.products(starts[:, None] + fit.pitch_s * np.arange(count))
    score, _ = explained_squares(fit.matrix(count), products.reshape(len(starts), -1))
    number = int(np.argmax(score))
    return _Start(float(score[number]), posture, float(starts[number]))

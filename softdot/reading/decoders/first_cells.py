"""How the array lies and how fast it slides over the first cells: what lets their dots explain most of the voltages.

Speeds and places of the first cells (softdot.reading.decoders.fitted) around a first speed, then offset across the line
and yaw the same way.
"""

from dataclasses import dataclass, replace

import numpy as np

from foundation.arrays import Bools, Floats
from softdot.reading.cells import DOTS
from softdot.reading.decoders.fitted import Track, cell_fit, explained
from softdot.reading.decoders.model import left_over
from softdot.reading.decoders.templates import Posture, templates
from softdot.reading.line import cell_pitch_mm
from softdot.reading.voltages import Reader, Voltages

AROUND, SPEED_STEP = 2.2, 0.02
WINDOW_CELLS, LONGER_CELLS = 8, 20
PLACE_MM, SHIFT_STEP_MM = 0.2, 0.05
RIVALS, APART_MM, NEARLY = 3, 1.0, 0.85
"""Speeds that are followed, how far their two places are apart, and what a rival must explain of the best's."""
OFFSETS_MM, YAWS_DEG = (0.8, 0.4, 0.2, 0.1), (6.0, 3.0, 1.5)
ALIKE = 0.02
"""Places whose dots explain so much less than the best's are as good."""


def first_cells(
    reader: Reader, heard: Voltages, many: int, active: tuple[float, float], speed: float
) -> tuple[Posture, float]:
    """Posture, and when the middle of the first cell of the window is passed."""
    step = heard.step_s / many
    window = _cut(heard, active[0], WINDOW_CELLS * cell_pitch_mm(reader.standard) / speed, active[1])
    speeds = speed * np.exp(np.arange(-np.log(AROUND), np.log(AROUND), SPEED_STEP))
    starts = [_best(reader, window, step, many, Posture(float(one))) for one in speeds]
    rivals = _peaks(starts)
    pitch_s = cell_pitch_mm(reader.standard) / rivals[0].posture.speed_mm_per_s
    longer = _cut(heard, active[0], LONGER_CELLS * pitch_s, active[1])
    finer = [_finer(reader, window, step, many, one, 0.5 * SPEED_STEP) for one in rivals]
    finer = [_finer(reader, longer, step, many, one, 0.25 * SPEED_STEP) for one in finer]
    best = _most_likely(reader, longer, step, many, finer)
    for offset in OFFSETS_MM:
        for yaw in YAWS_DEG[:2] if offset == OFFSETS_MM[0] else YAWS_DEG[-1:]:
            best = _turned(reader, longer, step, many, best, offset, yaw)
    best = _finer(reader, longer, step, many, best, 0.1 * SPEED_STEP)
    return best.posture, best.middle_s


@dataclass(frozen=True)
class _Start:
    """A posture, when the first cell is passed with it, and what its dots explain."""

    score: float
    posture: Posture
    middle_s: float


def _peaks(starts: list[tuple[_Start, ...]]) -> list[_Start]:
    """The best places of those speeds whose neighbours are worse, best first."""
    score = np.array([0.0, *(one[0].score for one in starts), 0.0])
    peaks = [one for k, one in enumerate(starts, 1) if score[k] >= max(score[k - 1], score[k + 1])]
    peaks.sort(key=lambda one: -one[0].score)
    return sorted((place for one in peaks[:RIVALS] for place in one), key=lambda place: -place.score)


def _most_likely(reader: Reader, window: Voltages, step: float, many: int, rivals: list[_Start]) -> _Start:
    """Of rivals that explain nearly as much as the best the one whose dots, all together, leave least."""
    most = max(one.score for one in rivals)
    near = [one for one in rivals if one.score > NEARLY * most]
    if len(near) == 1:
        return near[0]
    left, columns = [], []
    for one in near:
        fit = cell_fit(reader, templates(reader, one.posture, step, many), window)
        count = max(2, int(np.ceil((window.time_s[-1] - one.middle_s) / fit.pitch_s)) + 1)
        passed: Floats = one.middle_s + fit.pitch_s * np.arange(count, dtype=np.float64)
        dots, rest = left_over(reader, Track(fit, window, many, passed))
        left.append(rest)
        columns.append(_left_share(dots.reshape(1, -1))[0])
    return near[_or_left_column(1.0 - np.array(left), np.array(columns))]


def _cut(heard: Voltages, onset: float, long_s: float, end: float) -> Voltages:
    """From before the onset on, as long as said, at most to behind the end."""
    margin = 0.15 * long_s
    inside = (heard.time_s >= onset - margin) & (heard.time_s <= min(onset + long_s, end + margin))
    return Voltages(heard.time_s[inside], heard.voltage_V[inside])


def _best(reader: Reader, window: Voltages, step: float, many: int, posture: Posture) -> tuple[_Start, ...]:
    """Two places of the first cell, apart, at which the dots of the window explain most."""
    fit = cell_fit(reader, templates(reader, posture, step, many), window)
    first = window.time_s[0]
    count = max(2, int(np.ceil((window.time_s[-1] - first) / fit.pitch_s)) + 1)
    starts = first + np.arange(0.0, fit.pitch_s, PLACE_MM / posture.speed_mm_per_s) - 0.5 * fit.pitch_s
    products = fit.products(starts[:, None] + fit.pitch_s * np.arange(count))
    score, raised = explained(fit.matrix(count), products.reshape(len(starts), -1))
    first_best = _or_left_column(score, _left_share(raised))
    apart = np.abs((starts - starts[first_best] + 0.5 * fit.pitch_s) % fit.pitch_s - 0.5 * fit.pitch_s)
    second = int(np.argmax(np.where(apart * posture.speed_mm_per_s > APART_MM, score, -1.0)))
    return tuple(_Start(float(score[k]), posture, float(starts[k])) for k in (first_best, second))


def _left_share(raised: Floats | Bools) -> Floats:
    """Share (m,) of the dots (m, k) of some cells that lie in the left columns."""
    column = raised.reshape(len(raised), -1, 2, DOTS // 2).sum(axis=(1, 3))
    return np.asarray(column[:, 0] / np.maximum(column.sum(axis=1), 1.0))


def _or_left_column(score: Floats, share: Floats) -> int:
    """The best; where all its dots lie in right columns, one nearly as good whose dots all lie in the left ones.

    A line with dots in one column alone does not tell which one it is; letters such as a, b, k, l begin at the left.
    """
    best = int(np.argmax(score))
    left = np.flatnonzero((share == 1.0) & (score >= (1.0 - ALIKE) * score[best]))
    return int(left[np.argmax(score[left])]) if share[best] == 0.0 and len(left) else best


def _finer(reader: Reader, window: Voltages, step: float, many: int, start: _Start, by: float) -> _Start:
    """Speeds on both sides of a start, as long as one is better."""
    speed = start.posture.speed_mm_per_s
    tried = [_at(reader, window, step, many, replace(start.posture, speed_mm_per_s=speed * (1.0 + by * k)), start)
             for k in range(-3, 4)]  # fmt: skip
    return max(tried, key=lambda one: one.score)


def _turned(
    reader: Reader, window: Voltages, step: float, many: int, start: _Start, offset_mm: float, yaw_deg: float
) -> _Start:
    """Offsets and yaws on both sides of a start."""
    own = start.posture
    turned = [
        replace(own, offset_mm=own.offset_mm + i * offset_mm, yaw_deg=own.yaw_deg + j * yaw_deg)
        for i, j in ((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1))
    ]
    return max((_at(reader, window, step, many, one, start) for one in turned), key=lambda one: one.score)


def _at(reader: Reader, window: Voltages, step: float, many: int, posture: Posture, start: _Start) -> _Start:
    """The best start with a posture near a known one."""
    fit = cell_fit(reader, templates(reader, posture, step, many), window)
    count = max(2, int(np.ceil((window.time_s[-1] - start.middle_s) / fit.pitch_s)) + 1)
    starts = start.middle_s + np.arange(-8, 9) * SHIFT_STEP_MM / posture.speed_mm_per_s
    products = fit.products(starts[:, None] + fit.pitch_s * np.arange(count))
    score, _ = explained(fit.matrix(count), products.reshape(len(starts), -1))
    number = int(np.argmax(score))
    return _Start(float(score[number]), posture, float(starts[number]))

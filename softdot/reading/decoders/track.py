"""Where the array is at each time, found from the voltages alone: speed, offset across the line, yaw, cell after cell.

1. A first speed from the frequency below which half of the power lies, beside that of templates at several speeds.
2. Around it, speeds and places of the first cells: those whose dots explain most (softdot.reading.decoders.fitted).
   Then offset across the line and yaw the same way.
3. Along the line in blocks of cells: each block begins where the last ones lead to, and is moved to where its dots
   explain most.
"""

from dataclasses import dataclass, replace

import numpy as np

from geometry.arrays import Bools, Floats
from geometry.base import InputError
from softdot.reading.cells import DOTS
from softdot.reading.decoders.fitted import CellFit, Track, cell_fit, explained
from softdot.reading.decoders.model import left_over
from softdot.reading.decoders.templates import Posture, averaged, templates
from softdot.reading.line import cell_pitch_mm
from softdot.reading.voltages import Reader, Voltages

SLOWEST_MM_PER_S, FASTEST_MM_PER_S, SPEEDS = 0.5, 500.0, 13
AROUND, SPEED_STEP = 2.2, 0.02
WINDOW_CELLS, LONGER_CELLS = 8, 20
PLACE_MM = 0.2
RIVALS, APART_MM, NEARLY = 3, 1.0, 0.85
"""Speeds that are followed, how far their two places are apart, and what a rival must explain of the best's."""
OFFSETS_MM, YAWS_DEG = (0.8, 0.4, 0.2, 0.1), (6.0, 3.0, 1.5)
BLOCK, SHIFT_MM, SHIFT_STEP_MM = 8, 0.7, 0.05
STRETCH = 0.01
HOP, REMEMBERED, LEAST_SHARE = 4, 6, 0.05
"""Cells from block to block, blocks that tell the speed, and what a block must explain of the most to be believed."""
ONSET_SIGMA, STRONG = 6.0, 0.9
AVERAGED, LEAST_GROUPS = (1, 2, 4, 8, 16, 32, 64), 20
ALIKE = 0.02
"""Places whose dots explain so much less than the best's are as good."""


class NoDotError(InputError):
    """Nothing stands out of the noise."""


def tracked(reader: Reader, heard: Voltages) -> Track:
    """Of voltages that a sliding array gave. NoDotError where nothing stands out of their noise."""
    onset, end = _active(heard)
    speed = first_speed(reader, heard, onset, end)
    coarse, many = averaged(heard, speed)
    posture, middle = _first_cells(reader, coarse, many, (onset, end), speed)
    fit = cell_fit(reader, templates(reader, posture, heard.step_s, many), coarse)
    return Track(fit, coarse, many, _along(fit, middle, onset, end))


def noise_V(heard: Voltages) -> Floats:
    """Of each channel (n,): from differences of neighbouring samples, by their median, which signals raise little."""
    return np.asarray(np.median(np.abs(np.diff(heard.voltage_V, axis=0)), axis=0) / (0.6745 * np.sqrt(2.0)))


def _active(heard: Voltages) -> tuple[float, float]:
    """First and last time at which means of samples stand out of their noise, over as many as show it best."""
    noise = np.maximum(noise_V(heard), 1e-6 * np.abs(heard.voltage_V).max() + 1e-15)
    best, first, last = 0.0, 0, 0
    for many in AVERAGED:
        groups = len(heard.time_s) // many
        if groups < LEAST_GROUPS and many > 1:
            break
        mean = heard.voltage_V[: groups * many].reshape(groups, many, -1).mean(axis=1)
        over = (np.abs(mean - np.median(mean, axis=0)) / (noise / np.sqrt(many))).max(axis=1)
        loud = np.flatnonzero(over > ONSET_SIGMA)
        strength = float(np.quantile(over, STRONG))
        if len(loud) and strength > best:
            best, first, last = strength, int(loud[0]) * many, min(int(loud[-1] + 1) * many, len(heard.time_s) - 1)
    if best == 0.0:
        raise NoDotError("voltages: nothing stands out of their noise; there is no dot to read")
    return float(heard.time_s[first]), float(heard.time_s[last])


def first_speed(reader: Reader, heard: Voltages, onset: float, end: float) -> float:
    """The speed at which templates have the same median frequency as the voltages."""
    inside = (heard.time_s >= onset) & (heard.time_s <= end)
    measured = _median_Hz(heard.voltage_V[inside], heard.step_s, noise_V(heard))
    speeds = np.geomspace(SLOWEST_MM_PER_S, FASTEST_MM_PER_S, SPEEDS)
    known = []
    for speed in speeds:
        step = 0.1 / speed
        voltage = templates(reader, Posture(float(speed)), step).voltage_V
        known.append(_median_Hz(voltage.reshape(len(voltage), -1), step, np.zeros(1)))
    return float(np.exp(np.interp(np.log(measured), np.log(np.maximum.accumulate(known)), np.log(speeds))))


def _median_Hz(voltage: Floats, step_s: float, noise: Floats) -> float:
    """Below it lies half of the power of all channels, white noise subtracted."""
    power = (np.abs(np.fft.rfft(voltage - voltage.mean(axis=0), axis=0)) ** 2).sum(axis=1)
    power = power - len(voltage) * float((noise**2).sum()) * (voltage.shape[1] if noise.size == 1 else 1.0)
    total = np.cumsum(power)
    frequency = np.fft.rfftfreq(len(voltage), step_s)
    return max(float(frequency[np.argmax(total >= 0.5 * total.max())]), float(frequency[1]))


def _first_cells(
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


def _along(fit: CellFit, middle: float, onset: float, end: float) -> Floats:
    """When each cell is passed, from the first with anything to the last; linear between middles of blocks."""
    while middle - fit.pitch_s > onset - 0.5 * fit.pitch_s:
        middle -= fit.pitch_s
    pitch, speed = fit.pitch_s, fit.templates.posture.speed_mm_per_s
    matrix = fit.matrix(BLOCK)
    shifts = np.arange(-SHIFT_MM, SHIFT_MM + 1e-9, SHIFT_STEP_MM) / speed
    stretch = 1.0 + STRETCH * np.linspace(-1.0, 1.0, 5)
    cells = np.arange(BLOCK) - 0.5 * (BLOCK - 1)
    number, centre, most = 0.5 * (BLOCK - 1), middle + 0.5 * (BLOCK - 1) * pitch, 0.0
    known: list[tuple[float, float]] = []
    while centre < end + 0.5 * BLOCK * pitch:
        times = centre + shifts[None, :, None] + pitch * stretch[:, None, None] * cells
        score = explained(matrix, fit.products(times).reshape(-1, BLOCK * DOTS))[0].reshape(times.shape[:2])
        most = max(most, float(score.max()))
        if score.max() > LEAST_SHARE * most:
            centre = centre + _peak(shifts, score.max(axis=0))
            known.append((number, centre))
            pitch = _pitch_s(known[-REMEMBERED:], pitch)
        number, centre = number + HOP, centre + HOP * pitch
    numbers, centres = np.array(known).T
    first, last = _pitch_s(known[:REMEMBERED], fit.pitch_s), _pitch_s(known[-REMEMBERED:], fit.pitch_s)
    cell = np.arange(numbers[-1] + BLOCK + 1)
    time = np.interp(cell, numbers, centres)
    time += first * np.minimum(cell - numbers[0], 0.0) + last * np.maximum(cell - numbers[-1], 0.0)
    return np.asarray(time[time < end + 0.5 * fit.pitch_s])


def _pitch_s(known: list[tuple[float, float]], before: float) -> float:
    """From cell to cell, by a straight line through the middles of blocks; what it was before where there is one."""
    if len(known) < 2:
        return before
    numbers, centres = np.array(known).T
    return float(np.polyfit(numbers - numbers[0], centres - centres[0], 1)[0])


def _peak(at: Floats, score: Floats) -> float:
    """Where a parabola through the largest value and its neighbours is largest."""
    k = int(np.argmax(score))
    if not 0 < k < len(at) - 1:
        return float(at[k])
    left, mid, right = score[k - 1], score[k], score[k + 1]
    bend = left - 2.0 * mid + right
    return float(at[k] + (0.5 * (left - right) / bend * (at[1] - at[0]) if bend < 0.0 else 0.0))

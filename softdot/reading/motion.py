"""The motion of the array over a line: it slides at constant depth or force, or is set down cell by cell. Tremor is
white noise behind a Butterworth low-pass of order two, one for the place across the line and one for depth.
"""

from dataclasses import dataclass
from math import cos, radians, sin

import numpy as np

from foundation.arrays import Bools, Floats, Ints
from foundation.errors import InputError
from geometry.braille_standards import BrailleStandard
from softdot.arrays.kernel import ArrayKernel
from softdot.reading.conditions import WIDEST_TREMOR_RMS, ReadingConditions
from softdot.reading.hand import LIFTED_MM, hand_course, lift_share, wander_mm
from softdot.reading.line import DotLine, cell_pitch_mm

PATH_STEP_MM = 0.05
"""Longest way between two states of the array."""
PRESS_STEPS, TREMOR_STEPS = 40, 20
"""States of the array while it goes down, and in a period of the tremor."""
LEAD_MM = 3.0
"""Way before the first dot and behind the last."""
CHUNK_TIMES = 20_000
"""Number of times at which charges are looked up together, which bounds the memory."""
RELATIVE_FORCE_TOLERANCE, DEPTH_TOLERANCE_MM = 1e-4, 1e-9
"""Tolerances within which the depth of a force is found."""


@dataclass(frozen=True)
class ArrayPath:
    """Where the array's middle is at times (t,), and how deep a nominal dot under it would be.

    reached_s (c,) : time at which each cell is read. held : share of the times at which the force was held, None for a
    path of given depth.
    """

    time_s: Floats
    x_mm: Floats
    y_mm: Floats
    depth_mm: Floats
    yaw_deg: float
    reached_s: Floats
    held: float | None = None


@dataclass(frozen=True)
class PressTimes:
    """Times of presses: one begins every period_s, the first at time 0, goes down for down_s and holds for hold_s."""

    period_s: float
    down_s: float
    hold_s: float


def reach_mm(kernel: ArrayKernel, yaw_deg: float) -> float:
    """Largest distance along the line from the array's middle at which a dot touches it, mm."""
    half_x, half_y = np.abs(kernel.x_mm).max(), np.abs(kernel.y_mm).max()
    angle = radians(yaw_deg)
    return float(half_x * cos(angle) + half_y * abs(sin(angle)))


def dots_near(kernel: ArrayKernel, line: DotLine, path: ArrayPath, span: slice) -> tuple[Floats, Floats, Floats]:
    """Places x, y in the frame of the array and depths, each (t, k), of the dots near it at the times of a span.

    NaN where there are fewer than k.
    """
    middle = path.x_mm[span]
    reach = reach_mm(kernel, path.yaw_deg)
    low, high = np.searchsorted(line.x_mm, middle - reach), np.searchsorted(line.x_mm, middle + reach)
    most = max(1, int((high - low).max(initial=0)))
    number = low[:, None] + np.arange(most)
    there = number < high[:, None]
    number = np.where(there, number, 0)
    if not len(line.x_mm):
        empty = np.full((len(middle), 1), np.nan)
        return empty, empty, empty
    along = np.where(there, line.x_mm[number] - middle[:, None], np.nan)
    across = line.y_mm[number] - path.y_mm[span, None]
    angle = radians(path.yaw_deg)
    x = cos(angle) * along + sin(angle) * across
    y = cos(angle) * across - sin(angle) * along
    depth = path.depth_mm[span, None] + line.extra_mm[number]
    return x, np.where(there, y, np.nan), np.where(there, depth, np.nan)


def array_path(
    kernel: ArrayKernel,
    line: DotLine,
    count: int,
    chosen: BrailleStandard,
    conditions: ReadingConditions,
    random: np.random.Generator,
) -> ArrayPath:
    """The path over a line of count cells. conditions : with implied values. InputError for an unreachable force."""
    pitch = cell_pitch_mm(chosen)
    if conditions.mode == "press":
        return _press_path(count, pitch, conditions, random)
    path = _slide_path(count, pitch, reach_mm(kernel, conditions.yaw_deg), conditions, random)
    return path if conditions.force_N is None else _path_at_force(kernel, line, path, conditions.force_N)


def _slide_path(
    count: int, pitch: float, reach: float, conditions: ReadingConditions, random: np.random.Generator
) -> ArrayPath:
    """The path from before the first dot to behind the last; its start within a cell pitch is random."""
    first = -pitch / 2.0 - reach - LEAD_MM - pitch * random.random()
    last = pitch * (count - 0.5) + reach + LEAD_MM
    fastest = conditions.speed_mm_per_s * np.exp(2.0 * conditions.speed_cv)
    step = min(PATH_STEP_MM / fastest, 1.0 / (TREMOR_STEPS * conditions.tremor_Hz))
    course = hand_course(last - first, step, conditions, random)
    time, along = course.time_s, course.place_mm
    y, depth = _tremor(len(time), step, conditions, random)
    y = y + conditions.offset_mm + wander_mm(len(time), step, conditions, random)
    lifted = lift_share(time, conditions, random)
    deep = (conditions.depth_mm or 0.0) + depth
    cells = pitch * np.arange(count, dtype=np.float64) - first
    if conditions.leftward:
        cells = last - first - cells
    farthest = np.maximum.accumulate(along)
    reached = np.interp(cells, farthest, time)
    place = last - along if conditions.leftward else first + along
    y = y + np.tan(np.radians(conditions.skew_deg)) * (place - 0.5 * (first + last))
    return ArrayPath(time, place, y, deep + lifted * (LIFTED_MM - deep), conditions.yaw_deg, reached)


def press_times(conditions: ReadingConditions, pitch_mm: float) -> PressTimes:
    """The times of presses: down, hold, up, and on to the next cell at the speed."""
    down, hold = conditions.press_s, conditions.hold_s
    return PressTimes(2.0 * down + hold + pitch_mm / conditions.speed_mm_per_s, down, hold)


def _press_path(count: int, pitch: float, conditions: ReadingConditions, random: np.random.Generator) -> ArrayPath:
    """The path of an array that is set down once a period and lifted while it moves, always with the same offset."""
    times = press_times(conditions, pitch)
    period, down, hold = times.period_s, times.down_s, times.hold_s
    step = down / PRESS_STEPS
    time: Floats = step * np.arange(int(np.ceil((count + 0.5) * period / step)) + 1, dtype=np.float64)
    number = np.minimum(np.floor(time / period), count - 1)
    within = time - number * period
    moving = np.clip((within - 2.0 * down - hold) / (period - 2.0 * down - hold), 0.0, 1.0)
    share = np.clip(np.minimum(within / down, (2.0 * down + hold - within) / down), 0.0, 1.0)
    y, depth = _tremor(len(time), step, conditions, random)
    lowered = np.where(share > 0.0, share * ((conditions.depth_mm or 0.0) + depth), -1.0)
    x = pitch * np.minimum(number + moving, count - 1)
    reached: Floats = period * np.arange(count, dtype=np.float64) + down + hold
    return ArrayPath(time, x, conditions.offset_mm + y, lowered, conditions.yaw_deg, reached)


def _tremor(
    count: int, step_s: float, conditions: ReadingConditions, random: np.random.Generator
) -> tuple[Floats, Floats]:
    """Wobble across the line and in depth, mm, (t,) each."""
    if conditions.tremor_um == 0.0:
        return np.zeros(count), np.zeros(count)
    from scipy.signal import butter, sosfilt, sosfreqz

    corner = min(conditions.tremor_Hz, 0.45 / step_s)
    filters = butter(2, corner, fs=1.0 / step_s, output="sos")
    warm = int(3.0 / (corner * step_s))
    wobble = sosfilt(filters, random.standard_normal((2, warm + count)), axis=1)[:, warm:]
    rms = float(np.sqrt(np.mean(np.abs(sosfreqz(filters, 65_536)[1]) ** 2)))
    wobble = 1e-3 * conditions.tremor_um * np.clip(wobble / rms, -WIDEST_TREMOR_RMS, WIDEST_TREMOR_RMS)
    return wobble[0], wobble[1]


def _path_at_force(kernel: ArrayKernel, line: DotLine, path: ArrayPath, force_N: float) -> ArrayPath:
    """The path with the depth that gives this force, at most that of the path, where a stop holds the array.

    By the Illinois variant of regula falsi (Dowell and Jarratt, BIT 11 (1971) 168), at all times at once.
    """
    depth, held = np.zeros(len(path.time_s)), np.zeros(len(path.time_s), dtype=bool)
    for begin in range(0, len(depth), CHUNK_TIMES):
        span = slice(begin, begin + CHUNK_TIMES)
        x, y, stop = dots_near(kernel, line, path, span)
        lifted = stop - path.depth_mm[span, None]
        depth[span], held[span] = _depth_of_force(kernel, (x, y, lifted), path.depth_mm[span], force_N)
    if not held.any():
        raise InputError(
            f"--force-N = {force_N:g}: is never reached before a dot would be as deep as the kernel ends; give less"
        )
    return ArrayPath(
        path.time_s, path.x_mm, path.y_mm, depth, path.yaw_deg, path.reached_s, float(held.mean())
    )  # fmt: skip


def _depth_of_force(
    kernel: ArrayKernel, dots: tuple[Floats, Floats, Floats], stop: Floats, force_N: float
) -> tuple[Floats, Bools]:
    """Depth (t,) at which the force is reached, and whether it is above the stop (t,). dots : x, y, extra depth."""
    x, y, extra = dots

    def excess(depth: Floats, rows: Ints) -> Floats:
        return kernel.of_many(x[rows], y[rows], depth[:, None] + extra[rows])[1] - force_N

    at_stop = excess(stop, np.arange(len(stop)))
    rows = np.flatnonzero(at_stop > 0.0)
    depth = stop.copy()
    low, high = np.full(len(rows), -np.nanmax(extra, initial=0.0)), stop[rows].copy()
    f_low, f_high = np.full(len(rows), -force_N), at_stop[rows].copy()
    side = np.zeros(len(rows))
    while len(rows):
        middle = np.clip(high - f_high * (high - low) / (f_high - f_low), low, high)
        found = excess(middle, rows)
        depth[rows] = middle
        above = found > 0.0
        f_low = np.where(above, np.where(side > 0.0, 0.5 * f_low, f_low), found)
        f_high = np.where(above, found, np.where(side < 0.0, 0.5 * f_high, f_high))
        low, high = np.where(above, low, middle), np.where(above, middle, high)
        side = np.where(above, 1.0, -1.0)
        left = (np.abs(found) > RELATIVE_FORCE_TOLERANCE * force_N) & (high - low > DEPTH_TOLERANCE_MM)
        rows = rows[left]
        low, high, f_low, f_high, side = (one[left] for one in (low, high, f_low, f_high, side))
    return depth, at_stop > 0.0

"""Phases of every press (approach, loading, hold, unloading, after), from the drive alone and never from an answer."""

from dataclasses import dataclass
from itertools import pairwise
from math import comb

import numpy as np
from scipy.ndimage import uniform_filter1d

from foundation.arrays import Bools, Floats, Ints

PHASES = ("approach", "loading", "hold", "unloading", "after")
APPROACH, LOADING, HOLD, UNLOADING, AFTER = range(5)
SLOW_RATE_SHARE = 0.1  # of the mean rate of loading: the drive counts as held below it
SHORTEST_HOLD_SHARE = 0.1  # of the press: a half-sine is slow for 6 % of it
FEWEST_REST_SAMPLES = 8
MOVING_DEVIATIONS = 3.0  # change over the lead, in standard deviations about its straight line
SHALLOW_DEPTH_SHARE = 0.05  # of the deepest: what is lower is no press
BRIEF_LENGTH_SHARE = 0.05  # of the longest: what is shorter is a spike
REBOUND_DEPTH_SHARE = 0.2
"""Share of a press's depth below which a press that follows within the length of that press is a rebound."""


@dataclass(frozen=True)
class PressPhases:
    """Numbers of the samples that bound the phases of one press; each phase is [this, next).

    start : of the approach. touch, held, released, clear : of loading, hold, unloading and after. end : of after. A
    phase that does not occur is empty.
    """

    start: int
    touch: int
    held: int
    released: int
    clear: int
    end: int

    @property
    def bounds(self) -> tuple[int, ...]:
        """Numbers of the samples that bound the phases, in order: start, touch, held, released, clear, end."""
        return (self.start, self.touch, self.held, self.released, self.clear, self.end)


@dataclass(frozen=True)
class Segmentation:
    """Presses and phases of one drive. presses : in order, none where the drive never touches.

    phase : (t,) index into PHASES. press : (t,) number of the press to which a sample belongs.
    """

    presses: tuple[PressPhases, ...]
    phase: Ints
    press: Ints


def find_phases(time_s: Floats, drive: Floats, from_touch: bool = True) -> Segmentation:
    """Cut a drive (t,) at times (t,) without missing samples into presses and phases.

    from_touch : the drive is a displacement that counts from the first touch; else (a force, or the travel of a tester)
    rest is where it starts. A press begins where the drive leaves rest by more than its own noise.
    """
    level, noise = rest_level(drive)
    depth = drive - (0.0 if from_touch else level)
    spans = _press_spans(depth, noise)
    bounds = [0, *((b + c) // 2 for (_, b), (c, _) in pairwise(spans)), len(drive)]
    presses = tuple(_press_phases(time_s, depth, span, bounds[n], bounds[n + 1]) for n, span in enumerate(spans))
    phase, number = np.zeros(len(drive), dtype=np.int64), np.zeros(len(drive), dtype=np.int64)
    for n, press in enumerate(presses):
        number[press.start : press.end] = n
        for kind, (first, last) in enumerate(zip(press.bounds[:-1], press.bounds[1:], strict=True)):
            phase[first:last] = kind
    return Segmentation(presses, phase, number)


def rest_level(drive: Floats) -> tuple[float, float]:
    """Level and one sigma of a drive (t,) at rest, from the samples before it leaves a tenth of its range.

    A drive that moves from its first sample has no rest: then the level is that sample and the noise is taken from
    second differences, in whose median a smooth motion hardly shows.
    """
    first = float(np.median(drive[:5]))
    away = np.flatnonzero(np.abs(drive - first) > 0.1 * np.ptp(drive))
    lead = drive[: (int(away[0]) if len(away) else len(drive)) // 2]  # behind may be the foot of a slow rise
    if len(lead) < FEWEST_REST_SAMPLES:
        return float(drive[0]), _white_sigma(drive)
    place = np.arange(len(lead)) / len(lead)
    slope, start = np.polyfit(place, lead, 1)
    spread = float(np.std(lead - start - slope * place))
    if abs(slope) > MOVING_DEVIATIONS * max(spread, 1e-9 * float(np.ptp(drive))):
        return float(drive[0]), _white_sigma(drive)
    return float(np.median(lead)), max(spread, _white_sigma(lead))


def _white_sigma(values: Floats) -> float:
    """One sigma of white noise of values (t,), from their second differences."""
    return sigma_of_differences(np.diff(values, 2), 2)


def sigma_of_differences(differences: Floats, order: int) -> float:
    """One sigma of white noise from the differences (t,) of an order, by their median; 0 without differences."""
    if not len(differences):
        return 0.0
    return float(np.median(np.abs(differences)) / 0.6745 / np.sqrt(float(comb(2 * order, order))))


def _press_spans(depth: Floats, noise: float) -> list[tuple[int, int]]:
    """First sample and one past the last of every press: out of the noise, and to a good part of the deepest one."""
    deepest = float(depth.max())
    touching = depth > max(5.0 * noise, 1e-3 * deepest, 0.0)
    edges = np.flatnonzero(np.diff(np.concatenate([[0], touching.astype(np.int8), [0]])))
    spans = [(int(a), int(b)) for a, b in edges.reshape(-1, 2)]
    deep = [(a, b) for a, b in spans if depth[a:b].max() > max(SHALLOW_DEPTH_SHARE * deepest, 10.0 * noise)]
    longest = max((b - a for a, b in deep), default=0)
    return _without_rebounds(depth, [(a, b) for a, b in deep if b - a > BRIEF_LENGTH_SHARE * longest])


def _without_rebounds(depth: Floats, spans: list[tuple[int, int]]) -> list[tuple[int, int]]:
    """Spans of presses, less those that bounce after a press lets go: they belong to the time after that press."""
    kept: list[tuple[int, int]] = []
    for a, b in spans:
        if kept:
            first, last = kept[-1]
            if a - last < last - first and depth[a:b].max() < REBOUND_DEPTH_SHARE * depth[first:last].max():
                continue
        kept.append((a, b))
    return kept


def _press_phases(time_s: Floats, depth: Floats, span: tuple[int, int], start: int, end: int) -> PressPhases:
    """Bounds of the phases within one press, of which `span` holds the samples that touch."""
    touch, clear = span
    time, course = time_s[touch:clear], depth[touch:clear]
    smooth = _smooth(course)
    peak = float(smooth.max())
    top = int(np.argmax(smooth >= 0.9 * peak))
    down = _last_fall(smooth, peak)
    slow = _absolute_rate(time, smooth) < SLOW_RATE_SHARE * _loading_rate(time, smooth, peak)
    held = top + _first_true(slow[top:])
    released = down - _first_true(slow[: down + 1][::-1]) + 1 if down < len(smooth) else len(smooth)
    if released - held < max(3.0, SHORTEST_HOLD_SHARE * len(course)):
        held = released = min(int(np.argmax(smooth)) + 1, len(smooth))
    return PressPhases(start, touch, touch + held, touch + released, clear, end)


def _smooth(course: Floats) -> Floats:
    """Running mean (t,) over a tenth of the rise."""
    peak = float(course.max())
    rise = int(np.argmax(course >= 0.9 * peak)) - int(np.argmax(course >= 0.1 * peak))
    return np.asarray(uniform_filter1d(course, max(1, rise // 10), mode="nearest"))


def _loading_rate(time: Floats, smooth: Floats, peak: float) -> float:
    """Mean rate of loading from a tenth to nine tenths of the peak; infinite where both are one sample."""
    low, high = int(np.argmax(smooth >= 0.1 * peak)), int(np.argmax(smooth >= 0.9 * peak))
    return float(0.8 * peak / (time[high] - time[low])) if high > low else np.inf


def _absolute_rate(time: Floats, smooth: Floats) -> Floats:
    """Absolute rate of change (t,) of a smooth course, |d smooth / dt|."""
    return np.asarray(np.abs(np.gradient(smooth, time))) if len(smooth) > 1 else np.zeros(1)


def _last_fall(smooth: Floats, peak: float) -> int:
    """Last sample above half the peak that is followed by one below; the length where there is none."""
    above = np.flatnonzero(smooth >= 0.5 * peak)
    return int(above[-1]) if above[-1] < len(smooth) - 1 else len(smooth)


def _first_true(condition: Bools) -> int:
    """Index of the first True; the length where there is none."""
    return int(np.argmax(condition)) if condition.any() else len(condition)

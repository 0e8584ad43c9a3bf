"""The time scales of a recording's drives: what a memory can show in it, whatever the logger does in between.

A logger may be quick while the drive moves and slow while it is held. What counts is how often it looked while the
drive moved: the step by which half of the travel of a loading was covered.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from math import inf

import numpy as np
from scipy.ndimage import uniform_filter1d

from diagnose.signals.phases import PressPhases
from diagnose.signals.recording import Recording, Run
from foundation.arrays import Floats

STAIRCASE_TIME_RATIO = 3.0  # times as long as at the quickest rate: a loading with rests in it
SMOOTHING_SAMPLES = 5  # against the noise of the drive


@dataclass(frozen=True)
class TimeScales:
    """loading_s : the quickest loading. step_s : sampling step while the drive moves, the least of all loadings.

    lasting_s : the longest time from the first touch to the end of a run.
    """

    loading_s: float
    step_s: float
    lasting_s: float


def time_scales(recording: Recording) -> TimeScales:
    """Time scales of the drives of all runs."""
    found = list(_loadings_s(recording))
    loadings = [loading for loading, _ in found if 0.0 < loading < inf]
    step_s = min((step for _, step in found), default=min(run.step_s for run in recording.runs))
    return TimeScales(min(loadings, default=step_s), step_s, max(_lasting_s(recording)))


def _lasting_s(recording: Recording) -> Iterator[float]:
    for run, phases in zip(recording.runs, recording.phases, strict=True):
        first = phases.presses[0].touch if phases.presses else 0
        yield float(run.time_s[-1] - run.time_s[first])


def _loadings_s(recording: Recording) -> Iterator[tuple[float, float]]:
    """Duration of every loading in s, and the sampling step in s in which half of its travel was covered.

    Of a staircase the duration is the time in which its quickest step would go through the whole range.
    """
    for run, phases in zip(recording.runs, recording.phases, strict=True):
        through = _range_time_s(run)
        for press in phases.presses:
            loading = float(run.time_s[max(press.held - 1, press.touch)] - run.time_s[press.touch])
            yield through if loading > STAIRCASE_TIME_RATIO * through else loading, _moving_step_s(run, press)


def _moving_step_s(run: Run, press: PressPhases) -> float:
    """Median sampling step of a loading in s, weighted by the travel in each step."""
    own = slice(max(press.touch - 1, 0), press.held + 1)
    step, moved = np.diff(run.time_s[own]), np.abs(np.diff(run.drive_values[own]))
    if not moved.any():
        return run.step_s
    order = np.argsort(step, kind="stable")
    covered = np.cumsum(moved[order])
    return float(step[order][np.searchsorted(covered, 0.5 * covered[-1])])


def _range_time_s(run: Run) -> float:
    """Range of the drive over its largest rate, in s; infinite where it does not move."""
    course, time = _smooth(run.drive_values), _smooth(run.time_s)
    rate = float(np.max(np.abs(np.gradient(course, time)))) if len(course) > 1 else 0.0
    return float(np.ptp(course)) / rate if rate > 0.0 else inf


def _smooth(values: Floats) -> Floats:
    """Running mean (t,), at the ends over fewer samples so that a time goes on increasing there."""
    short = uniform_filter1d(np.ones(len(values)), SMOOTHING_SAMPLES, mode="constant")
    return np.asarray(uniform_filter1d(values, SMOOTHING_SAMPLES, mode="constant") / short)

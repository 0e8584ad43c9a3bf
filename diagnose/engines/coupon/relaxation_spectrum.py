"""Relaxation as a spectrum: two Prony branches a decade of time, as far as the recording can show it.

The coordinates are the branches' moduli over the long-term one, E_i / E_inf = t_i, so that g_i = t_i / (1 + sum t):
any values that are not negative make a valid series. A material with one time that lies between two branches is met
by their sum within 2 % of what relaxes, root mean square over a hold (5 to 8 % with one branch a decade), so that the
times need not be fitted.
"""

from math import ceil

import numpy as np
from scipy.ndimage import uniform_filter1d

from diagnose.signals.recording import Recording, Run
from diagnose.statistics.chi_bar_square import MOST_NON_NEGATIVE

LARGEST_MODULUS_RATIO = 20.0  # of E_i / E_inf: a tape or a gel may relax by 95 % within a decade
SPACING_DECADES = 0.5  # between branches
STAIRCASE_TIME_RATIO = 3.0  # times as long as at the quickest rate: a loading with rests in it
SMOOTHING_SAMPLES = 5  # against the noise of the drive


def relaxation_times(recording: Recording, others: int = 0) -> tuple[float, ...]:
    """Relaxation times in s of the branches, from a tenth of the quickest loading to three times the longest run.

    They lie half a decade apart, or farther where the score test takes fewer: others is the number of parameters that
    the candidate has besides. What has not come to rest when the longest run ends would else have to relax within it,
    and what flows already while it is loaded as slowly as that.
    """
    longest = 3.0 * max(float(run.time_s[-1] - run.time_s[0]) for run in recording.runs)
    shortest = max(min(_loading_times_s(recording)) / 10.0, min(2.0 * run.step_s for run in recording.runs))
    decades = np.log10(longest / shortest)
    count = int(np.clip(ceil(decades / SPACING_DECADES), 1, MOST_NON_NEGATIVE - others))
    spacing = max(SPACING_DECADES, decades / count)
    first = 0.5 * (decades - spacing * (count - 1))
    return tuple(float(shortest * 10.0 ** (first + spacing * n)) for n in range(count))


def _loading_times_s(recording: Recording) -> list[float]:
    """Duration of every loading in s.

    Of a staircase it is the time in which its quickest step would go through the whole range.
    """
    found = []
    for run, phases in zip(recording.runs, recording.phases, strict=True):
        through = _range_time_s(run)
        for press in phases.presses:
            loading = float(run.time_s[max(press.held - 1, press.touch)] - run.time_s[press.touch])
            found.append(through if loading > STAIRCASE_TIME_RATIO * through else loading)
    return [time for time in found if time > 0.0] or [float(recording.runs[0].step_s)]


def _range_time_s(run: Run) -> float:
    """Range of the drive over its largest rate, in s; infinite where it does not move."""
    course = uniform_filter1d(run.drive_values, SMOOTHING_SAMPLES, mode="nearest")
    rate = float(np.max(np.abs(np.gradient(course, run.time_s)))) if len(course) > 1 else 0.0
    return float(np.ptp(course)) / rate if rate > 0.0 else np.inf

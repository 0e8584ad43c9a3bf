"""Noise from how repeated runs differ. It holds what rest does not show, the scatter of presses.

Runs are repeats when all that the experimenter set is equal and the drives agree. Presses within one run are none: the
second press of a soft material answers otherwise than the first, and that is physics.
"""

from collections.abc import Sequence

import numpy as np

from diagnose.signals.align import lag_between
from diagnose.signals.phases import Segmentation
from diagnose.signals.recording import Run
from foundation.arrays import Floats

LARGEST_DRIVE_DIFFERENCE = 0.03  # root mean square difference of two drives, of their range


def repeat_groups(runs: Sequence[Run], phases: Sequence[Segmentation]) -> list[list[int]]:
    """Groups of runs that repeat each other, as numbers of runs, at least two in a group."""
    groups: list[list[int]] = []
    for number, run in enumerate(runs):
        if not phases[number].presses:
            continue
        same = (g for g in groups if _are_repeats(runs[g[0]], phases[g[0]], run, phases[number]))
        group = next(same, None)
        if group is None:
            groups.append([number])
        else:
            group.append(number)
    return [group for group in groups if len(group) > 1]


def repeat_differences(runs: Sequence[Run], phases: Sequence[Segmentation], channel: str) -> list[Floats]:
    """Independent differences (n,) between k repeats in a channel, k - 1 of them; none for fewer than two.

    Repeats are aligned by the channel itself. The differences are Helmert's: each run against the mean of the j before
    it, times sqrt(j / (j + 1)), has the variance of one run.
    """
    good = [(run, found) for run, found in zip(runs, phases, strict=True) if run.usable(channel).all()]
    if len(good) < 2:
        return []
    before, after = _common_lengths([run for run, _ in good], [found for _, found in good])
    windows = [run.channels[channel][_window(found, before, after)] for run, found in good]
    first = windows[0]
    aligned = [first, *(_align(first, window) for window in windows[1:])]
    apart = [np.sqrt(j / (j + 1.0)) * (aligned[j] - np.mean(aligned[:j], axis=0)) for j in range(1, len(aligned))]
    return [values - values.mean() for values in apart]


def _are_repeats(one: Run, its: Segmentation, other: Run, others: Segmentation) -> bool:
    """Whether two runs were made alike: same settings, same rate, and drives that agree."""
    stated = [(r.drive, r.dot_offset_mm, r.temperature_C, r.readout, tuple(r.channels)) for r in (one, other)]
    if stated[0] != stated[1] or abs(one.step_s / other.step_s - 1.0) > 0.01:
        return False
    if len(one.pieces) > 1 or len(other.pieces) > 1:
        return False
    before, after = _common_lengths([one, other], [its, others])
    first, second = one.drive_values[_window(its, before, after)], other.drive_values[_window(others, before, after)]
    lengths = [found.presses[-1].clear - found.presses[0].touch for found in (its, others)]
    if abs(lengths[0] - lengths[1]) > LARGEST_DRIVE_DIFFERENCE * max(lengths):
        return False
    return float(np.sqrt(np.mean((first - second) ** 2))) < LARGEST_DRIVE_DIFFERENCE * float(np.ptp(first))


def _common_lengths(runs: Sequence[Run], phases: Sequence[Segmentation]) -> tuple[int, int]:
    """Numbers of samples that all runs have before their first touch, and from it on."""
    touches = [found.presses[0].touch for found in phases]
    return min(touches), min(len(run.time_s) - touch for run, touch in zip(runs, touches, strict=True))


def _window(phases: Segmentation, before: int, after: int) -> slice:
    touch = phases.presses[0].touch
    return slice(touch - before, touch + after)


def _align(reference: Floats, values: Floats) -> Floats:
    """Shift values (n,) onto a reference (n,), by at most a twentieth of their length, with a Fourier shift.

    Interpolation would smooth away the noise that is sought; a phase shift keeps its power. The straight line between
    the ends is shifted apart, so that the ends meet.
    """
    if np.ptp(values) == 0.0 or np.ptp(reference) == 0.0:
        return values
    shift = lag_between(reference, values, 1.0, largest_s=0.05 * len(values)).lag_s
    place = np.arange(len(values))
    line = np.interp(place, [0, len(values) - 1], values[[0, -1]])
    turned = np.fft.rfft(values - line) * np.exp(2j * np.pi * np.fft.rfftfreq(len(values)) * shift)
    return np.asarray(np.fft.irfft(turned, len(values)) + line)

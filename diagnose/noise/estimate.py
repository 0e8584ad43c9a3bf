"""The noise of every channel of a recording: from repeated runs, else from rest, else as the experimenter states it.

Never from the residual that is to be explained: a model that is wrong must not widen its own error bars.

Noise from repeated runs: how they differ from their mean. It holds what rest does not show, the scatter of presses.

Runs are repeats when all that the experimenter set is equal and the drives agree. Presses within one run are none:
the second press of a soft material answers otherwise than the first, and that is physics.

Samples at rest: nothing touches, or has touched for a while, so what is recorded is noise.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import isclose

import numpy as np

from diagnose.noise.autoregression import fit_autoregression
from diagnose.noise.model import Line, NoiseModel, find_lines, quantisation_step, white_noise, without_lines
from diagnose.signals.align import lag_between
from diagnose.signals.phases import Segmentation
from diagnose.signals.recording import Recording, Run
from geometry.arrays import Bools, Floats
from geometry.base import InputError

AGREE = 0.03  # root mean square difference of two drives, of their range


def repeated(runs: Sequence[Run], phases: Sequence[Segmentation]) -> list[list[int]]:
    """Numbers of the runs of each group of repeats, at least two in a group."""
    groups: list[list[int]] = []
    for number, run in enumerate(runs):
        if not phases[number].presses:
            continue
        same = (g for g in groups if _equal(runs[g[0]], phases[g[0]], run, phases[number]))
        group = next(same, None)
        if group is None:
            groups.append([number])
        else:
            group.append(number)
    return [group for group in groups if len(group) > 1]


def scatter(runs: Sequence[Run], phases: Sequence[Segmentation], channel: str) -> list[Floats]:
    """Independent differences (n,) of k repeats that were aligned by the channel itself, k - 1 of them.

    Helmert's: each run against the mean of the j before it, times sqrt(j / (j + 1)), has the variance of one run.
    """
    good = [(run, found) for run, found in zip(runs, phases, strict=True) if run.usable(channel).all()]
    if len(good) < 2:
        return []
    before, after = _common([run for run, _ in good], [found for _, found in good])
    windows = [run.channels[channel][_window(found, before, after)] for run, found in good]
    first = windows[0]
    aligned = [first, *(_aligned(first, window) for window in windows[1:])]
    apart = [np.sqrt(j / (j + 1.0)) * (aligned[j] - np.mean(aligned[:j], axis=0)) for j in range(1, len(aligned))]
    return [values - values.mean() for values in apart]


def _equal(one: Run, its: Segmentation, other: Run, others: Segmentation) -> bool:
    """Whether two runs were made alike."""
    stated = [(r.drive, r.dot_offset_mm, r.temperature_C, r.readout, tuple(r.channels)) for r in (one, other)]
    if stated[0] != stated[1] or abs(one.step_s / other.step_s - 1.0) > 0.01:
        return False
    if len(one.pieces) > 1 or len(other.pieces) > 1:
        return False
    before, after = _common([one, other], [its, others])
    first, second = one.drive_values[_window(its, before, after)], other.drive_values[_window(others, before, after)]
    lengths = [found.presses[-1].clear - found.presses[0].touch for found in (its, others)]
    if abs(lengths[0] - lengths[1]) > AGREE * max(lengths):
        return False
    return float(np.sqrt(np.mean((first - second) ** 2))) < AGREE * float(np.ptp(first))


def _common(runs: Sequence[Run], phases: Sequence[Segmentation]) -> tuple[int, int]:
    """How many samples all runs have before their first touch, and from it on."""
    touches = [found.presses[0].touch for found in phases]
    return min(touches), min(len(run.time_s) - touch for run, touch in zip(runs, touches, strict=True))


def _window(phases: Segmentation, before: int, after: int) -> slice:
    touch = phases.presses[0].touch
    return slice(touch - before, touch + after)


def _aligned(reference: Floats, values: Floats) -> Floats:
    """The values (n,) shifted onto the reference, within a twentieth of their length, by a Fourier shift.

    Interpolation would smooth the noise away that is sought; a phase shift keeps its power. The straight line between
    the ends is kept apart, so that the ends meet.
    """
    if np.ptp(values) == 0.0 or np.ptp(reference) == 0.0:
        return values
    shift = lag_between(reference, values, 1.0, largest_s=0.05 * len(values)).lag_s
    place = np.arange(len(values))
    line = np.interp(place, [0, len(values) - 1], values[[0, -1]])
    turned = np.fft.rfft(values - line) * np.exp(2j * np.pi * np.fft.rfftfreq(len(values)) * shift)
    return np.asarray(np.fft.irfft(turned, len(values)) + line)


SHORTEST = 8  # samples of a stretch
GUARD = 0.5


def resting(run: Run, phases: Segmentation) -> Bools:
    """Samples (t,) that are clear of every press: GUARD loading times before it and one whole press behind it.

    The answer to a press goes on after it (charge leaks back, the medium recovers), and begins before the touch is
    seen in a noisy drive or on a clock that lags: all that is signal, not noise.
    """
    rest = np.ones(len(run.time_s), dtype=bool)
    time, last = run.time_s, len(run.time_s) - 1
    for press in phases.presses:
        touch, clear = time[press.touch], time[min(press.clear, last)]
        loading = time[min(press.held, last)] - touch
        rest &= (time < touch - GUARD * loading) | (time >= clear + (clear - touch))
    return rest


def stretches(run: Run, channel: str, rest: Bools) -> list[tuple[Floats, Floats]]:
    """Times and samples, less their mean, of each unbroken stretch of rest in a channel."""
    good = rest & run.usable(channel)
    found = []
    for piece in run.pieces:
        edges = np.flatnonzero(np.diff(np.concatenate([[0], good[piece].astype(np.int8), [0]])))
        for a, b in piece.start + edges.reshape(-1, 2):
            if b - a >= SHORTEST:
                values = run.channels[channel][a:b]
                found.append((run.time_s[a:b], values - values.mean()))
    return found


REPEATS, REST, STATED = "repeated runs", "rest", "stated"
ENOUGH = 50  # samples: their variance is known to 20 %


def noise_models(recording: Recording) -> Mapping[tuple[str, str], NoiseModel]:
    """(label, channel) -> noise, for every channel that is to be explained.

    InputError where neither repeats nor rest nor the rig file tells the noise of a channel.
    """
    repeats = repeated(recording.runs, recording.phases)
    pools: dict[tuple[str, str, tuple[int, ...]], NoiseModel | None] = {}

    def pooled(source: str, channel: str, numbers: tuple[int, ...]) -> NoiseModel | None:
        key = (source, channel, numbers)
        if key not in pools:
            chosen = [(recording.runs[n], recording.phases[n]) for n in numbers]
            pools[key] = _of_repeats(chosen, channel) if source == REPEATS else _of_rest(chosen, channel)
        return pools[key]

    return {
        (run.label, channel): pooled(REPEATS, channel, _group(repeats, number))
        or pooled(REST, channel, _resting_alike(recording, run, channel))
        or _stated(run, channel)
        for number, run in enumerate(recording.runs)
        for channel in run.answers
    }


def _group(repeats: Sequence[Sequence[int]], number: int) -> tuple[int, ...]:
    """Numbers of the runs that repeat a run, itself included; none where it was not repeated."""
    return next((tuple(group) for group in repeats if number in group), ())


def _resting_alike(recording: Recording, run: Run, channel: str) -> tuple[int, ...]:
    """Numbers of the runs whose rest can be pooled: same rate and amplifier. A coupon is held and never rests."""
    if recording.specimen is not None:
        return ()
    return tuple(
        number
        for number, other in enumerate(recording.runs)
        if channel in other.answers and run.readout == other.readout and isclose(run.step_s, other.step_s, rel_tol=0.01)
    )


def _of_repeats(chosen: Sequence[tuple[Run, Segmentation]], channel: str) -> NoiseModel | None:
    """The noise in how repeats differ. No lines are sought: their phases differ."""
    deviations = scatter([run for run, _ in chosen], [found for _, found in chosen], channel)
    return _fitted(chosen[0][0], channel, (), deviations, REPEATS) if _enough(deviations) else None


def _of_rest(chosen: Sequence[tuple[Run, Segmentation]], channel: str) -> NoiseModel | None:
    """The noise at rest, of all runs together."""
    rest = [stretches(run, channel, resting(run, found)) for run, found in chosen]
    if not _enough([values for its in rest for _, values in its]):
        return None
    lines, left = _lines_apart(rest, chosen[0][0].step_s)
    return _fitted(chosen[0][0], channel, lines, left, REST)


def _stated(run: Run, channel: str) -> NoiseModel:
    """White noise as rig.toml states it. InputError where it does not."""
    if channel not in run.noise:
        raise InputError(
            f"recording '{run.file}', column {channel}: its noise is not known; record at least {ENOUGH} samples "
            f"before the touch, repeat the run, or state noise.{channel} of the run in rig.toml"
        )
    white = white_noise(run.noise[channel], run.step_s, STATED)
    return replace(white, quantisation=quantisation_step(run.channels[channel]))


def _enough(values: Sequence[Floats]) -> bool:
    return sum(map(len, values)) >= ENOUGH


def _lines_apart(
    rest: Sequence[Sequence[tuple[Floats, Floats]]], step_s: float
) -> tuple[tuple[Line, ...], list[Floats]]:
    """Mains lines of the run that rests longest, and the stretches of all runs without them; each has its own phase."""
    longest = max(rest, key=lambda its: sum(len(values) for _, values in its))
    lines = find_lines([time for time, _ in longest], [values for _, values in longest], step_s)
    left = [without_lines(lines, [t for t, _ in its], [v for _, v in its]) for its in rest if its]
    return lines, [values for its in left for values in its]


def _fitted(run: Run, channel: str, lines: tuple[Line, ...], values: list[Floats], source: str) -> NoiseModel:
    """An autoregression of samples without lines. InputError for a channel that is silent and states no noise."""
    step = quantisation_step(run.channels[channel])
    model = fit_autoregression(values, step**2 / 12.0 if step is not None else 0.0)
    if model.variance <= 0.0:
        raise InputError(
            f"recording '{run.file}', column {channel}: has no noise at all at rest; state noise.{channel} of the run "
            "in rig.toml"
        )
    return NoiseModel(model, run.step_s, source, sum(map(len, values)), lines, step)

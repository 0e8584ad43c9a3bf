"""The noise of every channel of a recording: from repeated runs, else from rest, else as the experimenter states it.

It is never estimated from the residual that is to be explained: a model that is wrong must not widen its own error
bars.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import isclose

from diagnose.noise.autoregression import fit_autoregression
from diagnose.noise.mains_lines import Line, find_lines, subtract_lines
from diagnose.noise.model import NoiseModel, white_noise
from diagnose.noise.quantisation import quantisation_step
from diagnose.noise.repeats import repeat_differences, repeat_groups
from diagnose.noise.rest import rest_mask, rest_stretches
from diagnose.signals.phases import Segmentation
from diagnose.signals.recording import Recording, Run
from foundation.arrays import Floats
from foundation.errors import InputError

REPEATS, REST, STATED = "repeated runs", "rest", "stated"
ENOUGH_SAMPLES = 50  # their variance is known to 20 %


def noise_models(recording: Recording) -> Mapping[tuple[str, str], NoiseModel]:
    """Noise models of every channel that is to be explained, by (label, channel).

    InputError where neither repeats nor rest nor the rig file tells the noise of a channel.
    """
    repeats = repeat_groups(recording.runs, recording.phases)
    pools: dict[tuple[str, str, tuple[int, ...]], NoiseModel | None] = {}

    def pool_estimate(source: str, channel: str, numbers: tuple[int, ...]) -> NoiseModel | None:
        key = (source, channel, numbers)
        if key not in pools:
            chosen = [(recording.runs[n], recording.phases[n]) for n in numbers]
            pools[key] = (
                _noise_from_repeats(chosen, channel) if source == REPEATS else _noise_from_rest(chosen, channel)
            )
        return pools[key]

    return {
        (run.label, channel): pool_estimate(REPEATS, channel, _repeats_of(repeats, number))
        or pool_estimate(REST, channel, _runs_with_like_rest(recording, run, channel))
        or _stated_noise(run, channel)
        for number, run in enumerate(recording.runs)
        for channel in run.answers
    }


def _repeats_of(repeats: Sequence[Sequence[int]], number: int) -> tuple[int, ...]:
    """Numbers of the runs that repeat a run, itself included; none where it was not repeated."""
    return next((tuple(group) for group in repeats if number in group), ())


def _runs_with_like_rest(recording: Recording, run: Run, channel: str) -> tuple[int, ...]:
    """Numbers of the runs whose rest can be pooled with that of a run: same rate, same amplifier.

    None for a coupon, which is held and never rests.
    """
    if recording.specimen is not None:
        return ()
    return tuple(
        number
        for number, other in enumerate(recording.runs)
        if channel in other.answers and run.readout == other.readout and isclose(run.step_s, other.step_s, rel_tol=0.01)
    )


def _noise_from_repeats(chosen: Sequence[tuple[Run, Segmentation]], channel: str) -> NoiseModel | None:
    """Noise model of the differences between repeats; None for too few samples.

    No lines are sought, as their phases differ.
    """
    deviations = repeat_differences([run for run, _ in chosen], [found for _, found in chosen], channel)
    return _fit_noise(chosen[0][0], channel, (), deviations, REPEATS) if _has_enough_samples(deviations) else None


def _noise_from_rest(chosen: Sequence[tuple[Run, Segmentation]], channel: str) -> NoiseModel | None:
    """Noise model of the samples at rest of all chosen runs together; None for too few samples."""
    rest = [rest_stretches(run, channel, rest_mask(run, found)) for run, found in chosen]
    if not _has_enough_samples([values for its in rest for _, values in its]):
        return None
    lines, left = _separate_lines(rest, chosen[0][0].step_s)
    return _fit_noise(chosen[0][0], channel, lines, left, REST)


def _stated_noise(run: Run, channel: str) -> NoiseModel:
    """White noise as rig.toml states it. InputError where it states none."""
    if channel not in run.noise:
        raise InputError(
            f"recording '{run.file}', column {channel}: its noise is not known; record at least {ENOUGH_SAMPLES} "
            f"samples before the touch, repeat the run, or state noise.{channel} of the run in rig.toml"
        )
    white = white_noise(run.noise[channel], run.step_s, STATED)
    return replace(white, quantisation=quantisation_step(run.channels[channel]))


def _has_enough_samples(values: Sequence[Floats]) -> bool:
    return sum(map(len, values)) >= ENOUGH_SAMPLES


def _separate_lines(
    rest: Sequence[Sequence[tuple[Floats, Floats]]], step_s: float
) -> tuple[tuple[Line, ...], list[Floats]]:
    """Mains lines of the run that rests longest, and the stretches of all runs less these lines.

    rest : times and samples of each stretch of each run. The lines have a phase of their own in each run.
    """
    longest = max(rest, key=lambda its: sum(len(values) for _, values in its))
    lines = find_lines([time for time, _ in longest], [values for _, values in longest], step_s)
    left = [subtract_lines(lines, [t for t, _ in its], [v for _, v in its]) for its in rest if its]
    return lines, [values for its in left for values in its]


def _fit_noise(run: Run, channel: str, lines: tuple[Line, ...], values: list[Floats], source: str) -> NoiseModel:
    """Noise model of samples without lines. InputError for a channel that is silent and states no noise."""
    step = quantisation_step(run.channels[channel])
    model = fit_autoregression(values, step**2 / 12.0 if step is not None else 0.0)
    if model.variance <= 0.0:
        raise InputError(
            f"recording '{run.file}', column {channel}: has no noise at all at rest; state noise.{channel} of the run "
            "in rig.toml"
        )
    return NoiseModel(model, run.step_s, source, sum(map(len, values)), lines, step)

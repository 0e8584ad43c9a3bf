"""Controls for real recordings: made so that no physics is left to find, and a diagnosis has to keep quiet.

    from controls import replicates, reversed_answers, shuffled

Each takes a recording as load_rig reads it and gives another one; replicates needs force and voltage.
"""

from dataclasses import replace

import numpy as np

from diagnose.signals.align import lag_between
from diagnose.signals.recording import Recording, Run
from foundation.arrays import Floats


def shuffled(recording: Recording) -> Recording:
    """Every run with the answers of another one, that of the half of the recording away.

    They run backwards too, so that no press answers to the drive at its own time. Nothing predicts them.
    """
    runs, half = recording.runs, max(1, len(recording.runs) // 2)
    return replace(recording, runs=tuple(_with_answers(run, runs[n - half]) for n, run in enumerate(runs)))


def _with_answers(run: Run, other: Run) -> Run:
    """A run as long as the shorter of both, with the answers of the other one backwards."""
    count = min(len(run.time_s), len(other.time_s))
    strange = {name: other.channels[name][:count][::-1] for name in run.answers}
    return _cut(run, count, {**{name: values[:count] for name, values in run.channels.items()}, **strange})


def reversed_answers(recording: Recording) -> Recording:
    """Every run with its own answers backwards, against a drive that runs on: a cause would follow its effect."""
    return replace(recording, runs=tuple(_with_answers(run, run) for run in recording.runs))


def replicates(recording: Recording) -> Recording:
    """Each two neighbouring repeats as one run: the mean of their forces, their voltages' difference over sqrt(2).

    The second is shifted onto the first by its force. What differs is noise: the sensor's own, and that of the rig.
    """
    pairs = zip(recording.runs[::2], recording.runs[1::2], strict=False)
    return replace(recording, runs=tuple(_difference(one, other) for one, other in pairs))


def _difference(one: Run, other: Run) -> Run:
    count = min(len(one.time_s), len(other.time_s))
    step = one.step_s
    lag = lag_between(one.channels["force_N"][:count], other.channels["force_N"][:count], step).lag_s

    def moved(values: Floats) -> Floats:
        place = np.arange(count) + lag / step
        return np.interp(place, np.arange(len(values)), values)

    channels = {
        name: (values[:count] - moved(other.channels[name])) / np.sqrt(2.0)
        for name, values in one.channels.items()
        if name != "force_N"
    }
    force = 0.5 * (one.channels["force_N"][:count] + moved(other.channels["force_N"]))
    return _cut(one, count, {"force_N": force, **channels})


def _cut(run: Run, count: int, channels: dict[str, Floats]) -> Run:
    """The first samples of a run with other channels, all of them there."""
    return replace(
        run,
        time_s=run.time_s[:count],
        channels=channels,
        valid={name: np.ones(count, dtype=bool) for name in channels},
        saturated={name: np.zeros(count, dtype=bool) for name in channels},
    )

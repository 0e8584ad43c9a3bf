"""Recordings with more samples than a diagnosis needs are averaged over blocks of samples.

To average is a linear filter, and it commutes with what is linear and constant in time: the answer to an averaged drive
is the averaged answer, as far as force and charge are straight over a block of 4 ms.
"""

from dataclasses import replace
from math import ceil

import numpy as np

from diagnose.noise.quantisation import quantisation_step
from diagnose.recording import Recording, Run
from mesh.types import Bools, Floats, Ints

ENOUGH = 15_000
"""Samples of a channel over all runs: as many as a diagnosis handles in a minute."""
LEAST_Hz = 250.0
"""No recording gets slower: mains and their second harmonic stay visible, and so does every press by hand."""


def thinned(recording: Recording) -> Recording:
    """The recording with ENOUGH samples, if its rate allows; a warning says so."""
    count = sum(len(run.time_s) for run in recording.runs)
    asked = ceil(count / ENOUGH)
    factors = [max(1, min(asked, int(1.0 / (run.step_s * LEAST_Hz) + 1e-6))) for run in recording.runs]
    if max(factors) == 1:
        return recording
    runs = tuple(averaged(run, factor) for run, factor in zip(recording.runs, factors, strict=True))
    said = (
        f"{count:,} samples of a channel are more than needed: up to {max(factors)} in a row were averaged, and "
        f"nothing faster than {0.5 / max(run.step_s for run in runs):.3g} Hz was analysed."
    )
    return replace(recording, runs=runs, warnings=(*recording.warnings, said))


def averaged(run: Run, factor: int) -> Run:
    """Means over factor samples in a row within even sampling, gaps left out; shorter ends are dropped.

    A block counts as missing where one of its samples is, and as saturated likewise.
    """
    if factor == 1:
        return run
    first = np.concatenate([np.arange(p.start, p.stop - factor + 1, factor) for p in run.pieces])
    blocks = first[:, None] + np.arange(factor)
    return replace(
        run,
        time_s=run.time_s[blocks].mean(axis=1),
        channels={name: _means(values, blocks) for name, values in run.channels.items()},
        valid={name: _all(there, blocks) for name, there in run.valid.items()},
        saturated={name: ~_all(~at, blocks) for name, at in run.saturated.items()},
        covariates={name: values[blocks].mean(axis=1) for name, values in run.covariates.items()},
        noise={name: sigma / np.sqrt(factor) for name, sigma in run.noise.items()},
    )


def _means(values: Floats, blocks: Ints) -> Floats:
    """On the steps of the converter, where it has any: they are part of the noise."""
    means, step = values[blocks].mean(axis=1), quantisation_step(values)
    if step is None:
        return np.asarray(means)
    zero = values[np.isfinite(values)][0]
    return np.asarray(zero + step * np.round((means - zero) / step))


def _all(flags: Bools, blocks: Ints) -> Bools:
    return np.asarray(flags[blocks].all(axis=1))

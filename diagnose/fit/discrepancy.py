"""Errors of a model that lacks no physics: columns smooth over a press, and a variance for the rest.

A signal with relative error sigma is taken as signal times (1 + sigma m(t)), with m a random function over each press.
Its smooth part is a few cosines over the press, common to the presses of a run (columns with prior sigma). What no
column can follow adds to the variance of the coefficients where the signal itself is, and of those next to them.
"""

from collections.abc import Sequence

import numpy as np

from diagnose.fit.samples import Samples
from diagnose.forward import Signals
from foundation.arrays import Floats

FORM_ERROR = 0.05
"""One sigma, relative, by which the effect of the right mechanism may be wrong because of its law alone."""
COSINES_PER_PRESS = 3
RelativeErrors = Sequence[float]
"""Relative error of each channel, one sigma, in the order of the samples' channels."""


def error_scale_signals(signals: Sequence[Signals]) -> list[Signals]:
    """Signals that a model's own error is relative to: for a voltage the largest of its run, else the signal itself.

    Voltages come from one field of stress, whose error an electrode that collects next to nothing has as well.
    """
    found: list[Signals] = []
    for of_run in signals:
        voltages = [values for name, values in of_run.items() if name.startswith("voltage")]
        largest = max(voltages, key=lambda values: float(np.abs(values).max(initial=0.0)), default=np.zeros(0))
        found.append({name: largest if name.startswith("voltage") else values for name, values in of_run.items()})
    return found


def smooth_columns(samples: Samples, signals: Sequence[Signals], relative: RelativeErrors) -> tuple[Floats, Floats]:
    """Columns (n, k) of a smooth error and their prior sigmas (k,).

    Each block times low cosines, and each channel as a whole.
    """
    found: list[Floats] = []
    sigma: list[float] = []
    whole: dict[str, Floats] = {}
    for block in samples.blocks:
        size = relative[samples.channels.index(block.channel)]
        if size == 0.0:
            continue
        waves = _press_cosines(samples, block.run) * signals[block.run][block.channel][:, None]
        own = samples.block_vector(block, block.whitening(waves))
        found += list(own.T)
        sigma += [size] * COSINES_PER_PRESS
        whole[block.channel] = whole.get(block.channel, np.zeros(len(samples))) + own[:, 0]
    found += list(whole.values())
    sigma += [relative[samples.channels.index(channel)] for channel in whole]
    return (np.column_stack(found) if found else np.zeros((len(samples), 0))), np.array(sigma)


def depth_columns(samples: Samples, signals: Sequence[Signals], relative: RelativeErrors) -> tuple[Floats, Floats]:
    """Columns (n, k) and their prior sigmas (k,) of an error over depth, which is the same in all runs.

    Low cosines of each channel over its range, which stands for the depth as it grows with it; the constant one is
    among smooth_columns.
    """
    orders = np.arange(1, COSINES_PER_PRESS)
    found = {name: np.zeros((len(samples), len(orders))) for name in samples.channels}
    largest = {
        name: max(float(np.abs(of_run[name]).max(initial=0.0)) for of_run in signals if name in of_run)
        for name in samples.channels
    }
    for block in samples.blocks:
        signal = signals[block.run][block.channel]
        share = np.abs(signal) / max(largest[block.channel], np.finfo(float).tiny)
        waves = np.cos(np.pi * share[:, None] * orders) * signal[:, None]
        found[block.channel] += samples.block_vector(block, block.whitening(waves))
    known = [name for name, size in zip(samples.channels, relative, strict=True) if size > 0.0]
    sigma = [size for size in relative if size > 0.0]
    columns = np.column_stack([found[name] for name in known]) if known else np.zeros((len(samples), 0))
    return columns, np.repeat(sigma, len(orders))


def rough_variance(samples: Samples, vector: Floats, relative: RelativeErrors) -> Floats:
    """Variance (n,) that the error of a signal (n,) adds to its coefficients beyond the smooth columns.

    Half of the expected square is where the signal is (its cell), half is spread over its piece with the spectrum of a
    random walk: a model-form error is rougher than the signal.
    """
    size = np.asarray(relative)[samples.kind[samples.block_of]] ** 2
    square = vector**2
    here = (np.bincount(samples.bank.cell, square) / samples.bank.degrees)[samples.bank.cell]
    falling = 1.0 / (1.0 + samples.order_in_piece) ** 2
    piece = samples.piece_of
    spread = (np.bincount(piece, square) / np.bincount(piece, falling))[piece] * falling
    return np.asarray(size * 0.5 * (here + spread))


def _press_cosines(samples: Samples, run: int) -> Floats:
    """Cosines (t, COSINES_PER_PRESS) over each press of a run, from its touch to its end."""
    presses, count = samples.recording.phases[run].presses, len(samples.recording.runs[run].time_s)
    place = np.zeros(count)
    for press in presses:
        length = max(press.end - press.touch, 1)
        place[press.touch : press.end] = (np.arange(press.end - press.touch) + 0.5) / length
    return np.cos(np.pi * place[:, None] * np.arange(COSINES_PER_PRESS))

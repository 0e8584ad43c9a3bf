"""Samples at rest, which hold noise alone: nothing touches, or has touched for a while."""

import numpy as np

from diagnose.signals.phases import Segmentation
from diagnose.signals.recording import Run
from foundation.arrays import Bools, Floats

SHORTEST_STRETCH_SAMPLES = 8
GUARD_LOADING_TIMES = 0.5  # left out before a touch, in terms of the time that loading takes


def rest_mask(run: Run, phases: Segmentation) -> Bools:
    """Flags (t,) of samples clear of every press: GUARD_LOADING_TIMES before it and one whole press behind it.

    The answer to a press goes on after it (charge leaks back, the medium recovers), and begins before the touch is seen
    in a noisy drive or on a clock that lags: all that is signal, not noise.
    """
    rest = np.ones(len(run.time_s), dtype=bool)
    time, last = run.time_s, len(run.time_s) - 1
    for press in phases.presses:
        touch, clear = time[press.touch], time[min(press.clear, last)]
        loading = time[min(press.held, last)] - touch
        rest &= (time < touch - GUARD_LOADING_TIMES * loading) | (time >= clear + (clear - touch))
    return rest


def rest_stretches(run: Run, channel: str, rest: Bools) -> list[tuple[Floats, Floats]]:
    """Times and samples, less their mean, of each unbroken stretch of rest (t,) in a channel."""
    good = rest & run.usable(channel)
    found = []
    for piece in run.pieces:
        edges = np.flatnonzero(np.diff(np.concatenate([[0], good[piece].astype(np.int8), [0]])))
        for a, b in piece.start + edges.reshape(-1, 2):
            if b - a >= SHORTEST_STRETCH_SAMPLES:
                values = run.channels[channel][a:b]
                found.append((run.time_s[a:b], values - values.mean()))
    return found

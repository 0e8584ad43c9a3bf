"""What every rival starts from: residuals of the elastic model after gains, and named features of a run.

The model is the generator's own, of what the experimenter believes, which is more than fair to them: no rival has to
make a model of its own.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.ndimage import uniform_filter1d

from softdot.studies.proof.world.arrays import Floats
from softdot.studies.proof.world.bench import Bench
from softdot.studies.proof.world.reality import Signals, channels, noise_of

Name = tuple[str, str]
WORTH = 1.1
"""Error of the baseline over that with a correction from which a mismatch is told."""
SLOW_S, FAST_S, SMOOTH = 0.5, 0.1, 9
TERMS: Mapping[str, Name] = {
    "integral of V": ("charge-leakage", "readout"),
    "u": ("property-error", "medium2"),
    "u^2": ("hyperelastic-stiffening", "medium1"),
    "u^3": ("hyperelastic-stiffening", "medium1"),
    "du/dt": ("viscoelasticity", "medium2"),
    "largest u": ("stress-softening", "medium2"),
}
"""What a term of sparse regression stands for."""


@dataclass(frozen=True)
class Opinion:
    """Opinion of a rival. named : None where it names nothing. after : held-out error over that of the noise."""

    detected: bool
    named: Name | None
    after: float


def halves(bench: Bench, number: int, time: Floats) -> tuple[Any, Any]:
    """Samples of the first press with its lead, and of the second."""
    run = bench.runs[number]
    middle = run.lead_s + 2.0 * run.rise_s + run.hold_s + 0.5 * run.pause_s
    return time < middle, time >= middle


def residuals_of(bench: Bench, runs: Sequence[Signals], model: Sequence[Signals]) -> dict[str, list[Floats]]:
    """Measured less model after gain and offset of each run, fitted to its first press."""
    return {
        name: [less_gain(bench, n, own, name, run[name]) for n, (run, own) in enumerate(zip(runs, model, strict=True))]
        for name in channels(bench)
    }


def less_gain(bench: Bench, number: int, model: Signals, name: str, values: Floats) -> Floats:
    """Values (t, ...) less the multiple of a run's model and the constant that fit them best in its first press."""
    first, _ = halves(bench, number, model["time_s"])
    columns = np.column_stack([model[name], np.ones(len(model[name]))])
    weights, *_ = np.linalg.lstsq(columns[first], values[first], rcond=None)
    return np.asarray(values - columns @ weights)


def held_out(bench: Bench, runs: Sequence[Signals], residuals: Mapping[str, Sequence[Floats]]) -> float:
    """Root mean square of held-out residuals over the noise."""
    squares = []
    for name, of_runs in residuals.items():
        for number, residual in enumerate(of_runs):
            _, second = halves(bench, number, runs[number]["time_s"])
            squares.append((residual[second] / noise_of(bench)[name]) ** 2)
    return float(np.sqrt(np.mean(np.concatenate(squares))))


def features(bench: Bench, run: Signals) -> Floats:
    """Depth, its rate, its largest so far, and its mean over the last half second; about 1 at the deepest, alike."""
    depth = np.clip(run["displacement_mm"], 0.0, None) / bench.deepest_mm
    step = run["time_s"][1] - run["time_s"][0]
    width = max(1, round(SLOW_S / step))
    total = np.concatenate([np.zeros(width), np.cumsum(depth)])
    slow = (total[width:] - total[:-width]) / width
    rate = FAST_S * np.gradient(uniform_filter1d(depth, SMOOTH), step)
    return np.column_stack([depth, rate, np.maximum.accumulate(depth), slow])


def terms_of(bench: Bench, run: Signals, model: Signals, channel: str) -> Floats:
    """Integral of the expected V (a leak draws V / R), u, u^2, u^3, du/dt and the largest u so far; all about 1.

    V is that of the channel; of a force, of all channels together.
    """
    seen, step = features(bench, run), run["time_s"][1] - run["time_s"][0]
    drawn_by = [channel] if channel in bench.voltages else bench.voltages
    u, drawn = seen[:, 0], step * np.cumsum(sum(model[name] for name in drawn_by)) / bench.peak_V
    return np.column_stack([drawn, u, u**2, u**3, seen[:, 1], seen[:, 2]])


def linear_opinion(
    bench: Bench,
    runs: Sequence[Signals],
    model: Sequence[Signals],
    columns_of: Callable[[Signals, Signals, str], Floats],
    fit: Callable[[Floats, Floats], tuple[Floats, Floats]],
) -> Opinion:
    """Opinion of a linear fit of the residuals, whose columns are the terms once or several times; the one that is
    largest in any channel names.

    columns_of(run, its model, channel) : (t, k). fit(inputs (n, k), target (n,)) : weights (k,) and sizes (k,).
    """
    before = residuals_of(bench, runs, model)
    firsts = [halves(bench, n, run["time_s"])[0] for n, run in enumerate(runs)]
    after, sizes = {}, np.zeros(len(TERMS))
    for name, residuals in before.items():
        sigma = noise_of(bench)[name]
        pairs = list(enumerate(zip(runs, model, strict=True)))
        columns = [less_gain(bench, n, own, name, columns_of(run, own, name)) for n, (run, own) in pairs]
        inputs = np.concatenate([c[first] for c, first in zip(columns, firsts, strict=True)])
        target = np.concatenate([r[first] for r, first in zip(residuals, firsts, strict=True)]) / sigma
        weights, size = fit(inputs, target)
        sizes = np.maximum(sizes, size.reshape(-1, len(TERMS)).sum(axis=0))
        after[name] = [r - sigma * (c @ weights) for r, c in zip(residuals, columns, strict=True)]
    left, had = held_out(bench, runs, after), held_out(bench, runs, before)
    detected = had > WORTH * left
    largest = int(sizes.argmax())
    return Opinion(detected, list(TERMS.values())[largest] if detected and sizes[largest] > 0.0 else None, left)

"""What others would say of the same recordings: a Gaussian process, sparse regression, and "always charge leakage".

All get the generator's own elastic model of what the experimenter believes as their baseline, which is more than fair,
and fit gains first. They train on the first press of every run and are scored on the second.
"""

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from importlib.util import find_spec
from typing import Any

import numpy as np
from scipy.ndimage import uniform_filter1d
from scipy.optimize import minimize_scalar

from diagnose.prove.world.bench import BENCHES, Bench
from diagnose.prove.world.laws import Floats
from diagnose.prove.world.reality import Reality, Signals, baseline, channels, noise_of, record

Name = tuple[str, str]
POINTS = 250
WORTH = 1.1
"""Error of the baseline over that with a correction from which a mismatch is told."""
LARGEST_MOHM, SMALLEST_MOHM = 1e6, 1.0
SPARSE = 0.05
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
    """named : None where it names nothing. after : held-out error over that of the noise."""

    detected: bool
    named: Name | None
    after: float


def opinions(bench_name: str, runs: Sequence[Signals]) -> dict[str, Opinion]:
    """Of every rival that is installed."""
    bench = BENCHES[bench_name]
    believed = _believed(bench_name)
    found = {"gaussian process": _gaussian_process(bench, runs, believed), "always leakage": _leakage(bench, runs)}
    if find_spec("pysindy") is not None:
        found["sparse regression"] = _sparse(bench, runs, believed)
    return found


@lru_cache(maxsize=8)
def _believed(bench_name: str) -> tuple[Signals, ...]:
    bench = BENCHES[bench_name]
    return tuple(record(baseline(bench), bench))


def _halves(bench: Bench, number: int, time: Floats) -> tuple[Any, Any]:
    """Samples of the first press with its lead, and of the second."""
    run = bench.runs[number]
    middle = run.lead_s + 2.0 * run.rise_s + run.hold_s + 0.5 * run.pause_s
    return time < middle, time >= middle


def _residuals(bench: Bench, runs: Sequence[Signals], model: Sequence[Signals]) -> dict[str, list[Floats]]:
    """Measured less model after gain and offset of each run, fitted to its first press."""
    return {
        name: [_less_gain(bench, n, own, name, run[name]) for n, (run, own) in enumerate(zip(runs, model, strict=True))]
        for name in channels(bench)
    }


def _less_gain(bench: Bench, number: int, model: Signals, name: str, values: Floats) -> Floats:
    """Values (t, ...) less the multiple of a run's model and the constant that fit them best in its first press."""
    first, _ = _halves(bench, number, model["time_s"])
    columns = np.column_stack([model[name], np.ones(len(model[name]))])
    weights, *_ = np.linalg.lstsq(columns[first], values[first], rcond=None)
    return np.asarray(values - columns @ weights)


def _held_out(bench: Bench, runs: Sequence[Signals], residuals: Mapping[str, Sequence[Floats]]) -> float:
    """Root mean square of held-out residuals over the noise."""
    squares = []
    for name, of_runs in residuals.items():
        for number, residual in enumerate(of_runs):
            _, second = _halves(bench, number, runs[number]["time_s"])
            squares.append((residual[second] / noise_of(bench)[name]) ** 2)
    return float(np.sqrt(np.mean(np.concatenate(squares))))


def _features(bench: Bench, run: Signals) -> Floats:
    """Depth, its rate, its largest so far, and its mean over the last half second; about 1 at the deepest, alike."""
    depth = np.clip(run["displacement_mm"], 0.0, None) / bench.deepest_mm
    step = run["time_s"][1] - run["time_s"][0]
    width = max(1, round(SLOW_S / step))
    total = np.concatenate([np.zeros(width), np.cumsum(depth)])
    slow = (total[width:] - total[:-width]) / width
    rate = FAST_S * np.gradient(uniform_filter1d(depth, SMOOTH), step)
    return np.column_stack([depth, rate, np.maximum.accumulate(depth), slow])


def _gaussian_process(bench: Bench, runs: Sequence[Signals], model: Sequence[Signals]) -> Opinion:
    """A discrepancy in the manner of Kennedy and O'Hagan: it has no names."""
    from sklearn.exceptions import ConvergenceWarning
    from sklearn.gaussian_process import GaussianProcessRegressor
    from sklearn.gaussian_process.kernels import RBF, ConstantKernel, WhiteKernel

    before = _residuals(bench, runs, model)
    features = [_features(bench, run) for run in runs]
    firsts = [_halves(bench, n, run["time_s"])[0] for n, run in enumerate(runs)]
    inputs = np.concatenate([f[first] for f, first in zip(features, firsts, strict=True)])
    chosen = np.random.default_rng(0).choice(len(inputs), min(POINTS, len(inputs)), replace=False)
    after = {}
    for name, residuals in before.items():
        sigma = noise_of(bench)[name]
        target = np.concatenate([r[first] for r, first in zip(residuals, firsts, strict=True)])[chosen] / sigma
        kernel = ConstantKernel(10.0) * RBF(np.full(4, 0.5)) + WhiteKernel(1.0)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ConvergenceWarning)  # a useless input has a length without bound
            process = GaussianProcessRegressor(kernel, normalize_y=True).fit(inputs[chosen], target)
        after[name] = [r - sigma * process.predict(f) for r, f in zip(residuals, features, strict=True)]
    left, had = _held_out(bench, runs, after), _held_out(bench, runs, before)
    return Opinion(had > WORTH * left, None, left)


def _leakage(bench: Bench, runs: Sequence[Signals]) -> Opinion:
    """One resistor is fitted, whatever is wrong."""

    def with_leak(log_MOhm: float) -> Reality:
        return replace(baseline(bench), leak_MOhm=float(10.0**log_MOhm))

    def error(log_MOhm: float) -> float:
        found = _residuals(bench, runs, record(with_leak(log_MOhm), bench))
        residuals = [(n, r) for name in bench.voltages for n, r in enumerate(found[name])]
        return float(sum(np.sum(r[_halves(bench, n, runs[n]["time_s"])[0]] ** 2) for n, r in residuals))

    bounds = np.log10([SMALLEST_MOHM, LARGEST_MOHM])
    best = minimize_scalar(error, bounds=tuple(bounds), method="bounded", options={"xatol": 0.02})
    after = _residuals(bench, runs, record(with_leak(float(best.x)), bench))
    return Opinion(True, ("charge-leakage", "readout"), _held_out(bench, runs, after))


def _sparse(bench: Bench, runs: Sequence[Signals], model: Sequence[Signals]) -> Opinion:
    """Sequentially thresholded least squares (SINDy) of the residuals on named terms; the largest term names."""
    from pysindy import STLSQ  # type: ignore[import-not-found,import-untyped,unused-ignore]

    before = _residuals(bench, runs, model)
    firsts = [_halves(bench, n, run["time_s"])[0] for n, run in enumerate(runs)]
    after, weights = {}, dict.fromkeys(TERMS, 0.0)
    for name, residuals in before.items():
        sigma = noise_of(bench)[name]
        found_terms = [_terms(bench, run, model[n], name) for n, run in enumerate(runs)]
        terms = [_less_gain(bench, n, model[n], name, own) for n, own in enumerate(found_terms)]
        inputs = np.concatenate([t[first] for t, first in zip(terms, firsts, strict=True)])
        target = np.concatenate([r[first] for r, first in zip(residuals, firsts, strict=True)]) / sigma
        fitted = STLSQ(threshold=SPARSE, alpha=1e-3).fit(inputs, target[:, None]).coef_.ravel()
        for term, coefficient in zip(TERMS, fitted, strict=True):
            weights[term] = max(weights[term], abs(float(coefficient)))
        after[name] = [r - sigma * (t @ fitted) for r, t in zip(residuals, terms, strict=True)]
    left, had = _held_out(bench, runs, after), _held_out(bench, runs, before)
    largest = max(weights, key=lambda term: weights[term])
    named = TERMS[largest] if weights[largest] > 0.0 and had > WORTH * left else None
    return Opinion(had > WORTH * left, named, left)


def _terms(bench: Bench, run: Signals, model: Signals, channel: str) -> Floats:
    """Integral of the expected V (a leak draws V / R), u, u^2, u^3, du/dt and the largest u so far; all about 1.

    V is that of the channel; of a force, of all channels together.
    """
    features, step = _features(bench, run), run["time_s"][1] - run["time_s"][0]
    drawn_by = [channel] if channel in bench.voltages else bench.voltages
    u, drawn = features[:, 0], step * np.cumsum(sum(model[name] for name in drawn_by)) / bench.peak_V
    return np.column_stack([drawn, u, u**2, u**3, features[:, 1], features[:, 2]])

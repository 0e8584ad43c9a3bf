"""What others would say of the same recordings.

They are a Gaussian process, sparse regression, a sparse regression that is local to phases and tested by F, and "always
charge leakage". All get the generator's own elastic model of what the experimenter believes as their baseline, which is
more than fair, and fit gains first. They train on the first press of every run and are scored on the second.
"""

import warnings
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache, partial
from importlib.util import find_spec

import numpy as np
from scipy.optimize import minimize_scalar

from softdot.studies.proof.believed import (
    WORTH,
    Opinion,
    features,
    halves,
    held_out,
    linear_opinion,
    residuals_of,
    terms_of,
)
from softdot.studies.proof.localised import localised_regression
from softdot.studies.proof.world.arrays import Floats
from softdot.studies.proof.world.bench import Bench
from softdot.studies.proof.world.reality import Reality, Signals, baseline, noise_of, record
from softdot.studies.proof.world.rigs import BENCHES

POINTS = 250
LARGEST_MOHM, SMALLEST_MOHM = 1e6, 1.0
SPARSE = 0.05


def opinions(bench_name: str, runs: Sequence[Signals]) -> dict[str, Opinion]:
    """Opinions on the runs of a bench by every rival that is installed, by name."""
    bench = BENCHES[bench_name]
    believed = _believed_runs(bench_name)
    found = {"gaussian process": _gaussian_process(bench, runs, believed), "always leakage": _leakage(bench, runs)}
    found["localised sparse regression"] = localised_regression(bench, runs, believed)
    if find_spec("pysindy") is not None:
        found["sparse regression"] = _sparse(bench, runs, believed)
    return found


@lru_cache(maxsize=8)
def _believed_runs(bench_name: str) -> tuple[Signals, ...]:
    """Runs that the experimenter expects of a bench, without any effect."""
    bench = BENCHES[bench_name]
    return tuple(record(baseline(bench), bench))


def _gaussian_process(bench: Bench, runs: Sequence[Signals], model: Sequence[Signals]) -> Opinion:
    """A discrepancy in the manner of Kennedy and O'Hagan: it has no names."""
    from sklearn.exceptions import ConvergenceWarning
    from sklearn.gaussian_process import GaussianProcessRegressor
    from sklearn.gaussian_process.kernels import RBF, ConstantKernel, WhiteKernel

    before = residuals_of(bench, runs, model)
    seen = [features(bench, run) for run in runs]
    firsts = [halves(bench, n, run["time_s"])[0] for n, run in enumerate(runs)]
    inputs = np.concatenate([f[first] for f, first in zip(seen, firsts, strict=True)])
    chosen = np.random.default_rng(0).choice(len(inputs), min(POINTS, len(inputs)), replace=False)
    after = {}
    for name, residuals in before.items():
        sigma = noise_of(bench)[name]
        target = np.concatenate([r[first] for r, first in zip(residuals, firsts, strict=True)])[chosen] / sigma
        kernel = ConstantKernel(10.0) * RBF(np.full(4, 0.5)) + WhiteKernel(1.0)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ConvergenceWarning)  # a useless input has a length without bound
            process = GaussianProcessRegressor(kernel, normalize_y=True).fit(inputs[chosen], target)
        after[name] = [r - sigma * process.predict(f) for r, f in zip(residuals, seen, strict=True)]
    left, had = held_out(bench, runs, after), held_out(bench, runs, before)
    return Opinion(had > WORTH * left, None, left)


def _leakage(bench: Bench, runs: Sequence[Signals]) -> Opinion:
    """One resistor is fitted, whatever is wrong."""

    def with_leak(log_MOhm: float) -> Reality:
        return replace(baseline(bench), leak_MOhm=float(10.0**log_MOhm))

    def error(log_MOhm: float) -> float:
        found = residuals_of(bench, runs, record(with_leak(log_MOhm), bench))
        residuals = [(n, r) for name in bench.voltages for n, r in enumerate(found[name])]
        return float(sum(np.sum(r[halves(bench, n, runs[n]["time_s"])[0]] ** 2) for n, r in residuals))

    bounds = np.log10([SMALLEST_MOHM, LARGEST_MOHM])
    best = minimize_scalar(error, bounds=tuple(bounds), method="bounded", options={"xatol": 0.02})
    after = residuals_of(bench, runs, record(with_leak(float(best.x)), bench))
    return Opinion(True, ("charge-leakage", "readout"), held_out(bench, runs, after))


def _sparse(bench: Bench, runs: Sequence[Signals], model: Sequence[Signals]) -> Opinion:
    """Sequentially thresholded least squares (SINDy) of the residuals on named terms; the largest term names."""
    from pysindy import STLSQ  # type: ignore[import-not-found,import-untyped,unused-ignore]

    def fit(inputs: Floats, target: Floats) -> tuple[Floats, Floats]:
        weights = STLSQ(threshold=SPARSE, alpha=1e-3).fit(inputs, target[:, None]).coef_.ravel()
        return weights, np.abs(weights)

    return linear_opinion(bench, runs, model, partial(terms_of, bench), fit)

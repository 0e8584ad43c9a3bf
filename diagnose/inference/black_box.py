"""The flexible rival: any linear memory of the drive. A named mechanism that cannot beat it is not named.

residual(t) = sum over lags of h_k times the mean drive over the k-th lag interval: a finite impulse response, constant
over intervals that double, so that a few coefficients reach from one sample to the whole press. Ridge prior
h ~ N(0, s^2), with s from the evidence of the presses it is fitted to (MacKay, Neural Comput. 4 (1992) 415; for impulse
responses Pillonetto and De Nicolao, Automatica 46 (2010) 81).

The rival without mechanics, judged in the same metric as the model that is to be named.

True refits: the named model fitted to some presses and shown on others that it has not seen.
"""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from scipy.optimize import minimize_scalar

from diagnose.findings import Fit
from diagnose.fit.baseline import plausible
from diagnose.fit.linearised_system import LinearisedSystem, linearised
from diagnose.fit.marginal_likelihood import Quadratic
from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.refit import Fitted, fitted
from diagnose.fit.samples import SampleBlock, Samples
from diagnose.forward import Setting
from diagnose.inference.search import Screening
from diagnose.statistics.held_out import Forecast, forecast
from diagnose.statistics.linear_gaussian import Sums
from geometry.arrays import Bools, Floats, Ints

STRENGTHS = np.logspace(-2.0, 6.0, 17)  # of the response, in sigma of the noise over all samples: where s is sought


def doubling_edges(longest: int) -> Ints:
    """Edges (k + 1,) of lag intervals in samples: [0, 1), [1, 2), [2, 4), [4, 8) ... up to at least `longest`."""
    return np.concatenate([[0], 2 ** np.arange(int(np.ceil(np.log2(max(longest, 1)))) + 1)])


def lagged_means(drive: Floats, edges: Ints) -> Floats:
    """Columns (n, k): means of a drive (n,) over lags [edges[k], edges[k + 1]); at rest before the first sample.

    Edges are in samples: runs at other rates need their own, equal in seconds. Give several drives, such as its
    square, or each run apart, for more freedom. Whiten the columns afterwards.
    """
    past = np.concatenate([np.zeros(int(edges[-1])), np.cumsum(drive - drive[0])])
    before = np.concatenate([[0.0], past])  # before[i + 1] is the sum up to and with i
    now = int(edges[-1]) + np.arange(len(drive)) + 1
    return np.column_stack([(before[now - a] - before[now - b]) / (b - a) for a, b in pairwise(edges)])


def ridge_by_evidence(sums: Sums, prior_sigma: Floats, ridge: Bools) -> float:
    """The common prior sigma of the coefficients marked True in ridge (k,) that maximises the evidence.

    prior_sigma : (k,) of the others, the nuisances.
    """
    strength = float(np.sqrt(np.trace(sums.gram[np.ix_(ridge, ridge)])))
    if strength == 0.0:
        return 0.0

    def loss(log_sigma: float) -> float:
        return -sums.log_evidence(np.where(ridge, np.exp(log_sigma), prior_sigma))

    grid = np.log(STRENGTHS / strength)
    best = int(np.argmin([loss(value) for value in grid]))
    around = (grid[max(best - 1, 0)], grid[min(best + 1, len(grid) - 1)])
    return float(np.exp(minimize_scalar(loss, bounds=around, method="bounded").x))


def black_box_forecast(
    residual: Floats, nuisances: Floats, prior_sigma: Floats, memory: Floats, press: Ints
) -> Forecast:
    """Every press predicted by nuisances (n, p) plus an impulse response on memory (n, k), fitted to the others.

    All whitened; prior_sigma : (p,) of the nuisances. The ridge is chosen anew from the presses that are fitted.
    """
    columns = np.column_stack([nuisances, memory])
    ridge = np.arange(columns.shape[1]) >= nuisances.shape[1]
    padded = np.concatenate([prior_sigma, np.zeros(memory.shape[1])])
    return forecast(
        residual, columns, press, lambda sums: np.where(ridge, ridge_by_evidence(sums, padded, ridge), padded)
    )


def memory(samples: Samples) -> Floats:
    """Columns (n, k): for each channel an impulse response to the drive and to its square, common to all runs."""
    step = max(run.step_s for run in samples.recording.runs)
    presses = [press.end - press.touch for found in samples.recording.phases for press in found.presses]
    edges_s = np.asarray(doubling_edges(max(presses, default=len(samples))) * step, dtype=np.float64)
    by_channel = []
    for channel in samples.channels:
        parts = [_of_block(samples, block, edges_s) for block in samples.blocks if block.channel == channel]
        by_channel.append(np.sum(parts, axis=0))
    return np.column_stack(by_channel)


def _of_block(samples: Samples, block: SampleBlock, edges_s: Floats) -> Floats:
    run = samples.recording.runs[block.run]
    depth = run.drive_values
    if run.drive == "displacement_mm" and samples.recording.specimen is None:
        depth = np.maximum(depth, 0.0)
    edges = np.maximum.accumulate(np.maximum(np.round(edges_s / run.step_s), np.arange(len(edges_s)))).astype(np.int64)
    past = np.column_stack([lagged_means(values, edges) for values in (depth, depth**2)])
    return samples.of_block(block, block.whitening(past))


def box_scores(samples: Samples, baseline: LinearisedSystem, metric: LinearisedSystem, past: Floats) -> Floats:
    """Held-out log-scores (presses,) of the baseline with nuisances plus the black box, in another system's metric."""
    informative = metric.informative
    columns = metric.weighted(baseline.nuisance_design)
    kept = baseline.sigma > 0.0
    fold = samples.fold[informative]
    found = black_box_forecast(
        metric.weighted(baseline.residual), columns[:, kept], baseline.sigma[kept], metric.weighted(past), fold
    )
    _, place = np.unique(fold, return_inverse=True)
    return np.asarray(found.log_scores + np.bincount(place, np.log(metric.weight[informative])))


def worth_of_form(samples: Samples, metric: LinearisedSystem) -> float:
    """Nats per press that it is worth to know the model-form error: half its share of the variance, summed."""
    share = (metric.variance - metric.numerical) / metric.variance
    folds = len(np.unique(samples.fold[metric.informative]))
    return 0.5 * float(share[metric.informative].sum()) / folds


ROUNDS = 2


def split(presses: int) -> tuple[list[int], list[int]]:
    """Numbers of presses to train on and to hold out: every second one."""
    return list(range(0, presses, 2)), list(range(1, presses, 2))


def trained_and_held(
    model: ObservedModel,
    found: Screening,
    fit: Fitted | None,
    gains: Floats,
    halves: tuple[list[int], list[int]] | None = None,
) -> tuple[Fit, Fit | None]:
    """Errors on training presses and on held-out ones; None where there is one press only.

    halves : numbers of both, every second one unless told otherwise. gains : (presses,) held-out log-score gains.
    Mechanisms and shared nuisances come from training presses alone. What floats in a run that has no training press is
    fitted to it with both models alike, under its prior.
    """
    samples = model.samples
    training, held = halves or split(len(samples.presses))
    informative = found.baseline.informative
    seen = informative & np.isin(samples.press, training)
    settings: tuple[Setting, ...] = ()
    after = before = relaxed(model, found.start.values, (), seen, np.zeros(len(model.nuisances), dtype=bool))
    if fit is not None:
        own = fitted(model, fit.system.reached(seen), fit.candidates, fit.values, found.excess)
        settings = own.settings
        after = own.nuisances(model)
    runs = {samples.presses[n][0] for n in training}
    frozen = np.array([nuisance.run is None or nuisance.run in runs for nuisance in model.nuisances], dtype=bool)
    unseen = informative & np.isin(samples.press, held)
    if held and not frozen.all():
        before = relaxed(model, before, (), unseen, frozen)
        after = relaxed(model, after, settings, unseen, frozen) if fit is not None else before
    train = errors(model, training, before, after, settings, gains)
    return train, errors(model, held, before, after, settings, gains) if held else None


def unimproved(fit: Fit) -> Fit:
    """The fit where nothing is named: after is as before."""
    return replace(fit, nrmse_after=fit.nrmse_before, log_score_gain_per_press=0.0)


def relaxed(model: ObservedModel, values: Floats, settings: Sequence[Setting], rows: Bools, frozen: Bools) -> Floats:
    """Nuisances fitted to some rows within what is plausible, but for those that are frozen."""
    for _ in range(ROUNDS if len(values) else 0):
        system = linearised(model, values, settings, informative=rows)
        values = model.answered(values, _bounded(system, values, frozen), settings)
    return values


def _bounded(system: LinearisedSystem, values: Floats, frozen: Bools) -> Floats:
    """Least squares (p,) within what is plausible: what would go farther is held there and the rest fitted again."""
    values, held = values.copy(), frozen.copy()
    columns, sigma = system.nuisance_design[:, : len(values)], system.sigma[: len(values)]
    while not held.all():
        free = np.flatnonzero(~held)
        residual = system.residual[system.informative] - columns[:, held] @ values[held]
        found = Quadratic(system.weighted(columns[:, free]), sigma[free]).mean(system.weighted(residual))
        values[free] = plausible(found, sigma[free])
        held[free] = values[free] != found
        if not held[free].any():
            break
    return values


def errors(
    model: ObservedModel,
    presses: Sequence[int],
    before: Floats,
    after: Floats,
    settings: Sequence[Setting],
    gains: Floats,
) -> Fit:
    """Of some presses (numbers); gains : (presses,) log-scores over the baseline."""
    samples = model.samples
    names = tuple(f"{model.runs[run].label}, press {press + 1}" for run, press in (samples.presses[n] for n in presses))
    own = [n for n in presses if n < len(gains)]
    gain = float(np.mean(gains[own])) if settings and own else 0.0
    old, floor = _relative(model, presses, model.signals(before))
    new, _ = _relative(model, presses, model.signals(after, settings))
    return Fit(names, old, new, floor, gain)


def _relative(
    model: ObservedModel, presses: Sequence[int], signals: Sequence[dict[str, Floats]]
) -> tuple[float, float]:
    """Root mean square error over the recording's, each channel counting alike; and that of noise alone."""
    samples, errors, floors = model.samples, [], []
    for channel in samples.channels:
        missed = seen = noise = 0.0
        for block in samples.blocks:
            if block.channel != channel:
                continue
            run, found = model.runs[block.run], samples.recording.phases[block.run]
            own = [press for n in presses for number, press in [samples.presses[n]] if number == block.run]
            rows = block.observed & np.isin(found.press, own)
            recorded = run.channels[channel][rows]
            missed += float(((recorded - signals[block.run][channel][rows]) ** 2).sum())
            seen += float((recorded**2).sum())
            noise += len(recorded) * block.whitening.noise.rms**2
        if seen > 0.0:
            errors.append(missed / seen)
            floors.append(noise / seen)
    return float(np.sqrt(np.mean(errors))), float(np.sqrt(np.mean(floors)))

"""The flexible rival without mechanics, any linear memory of the drive: a name that cannot beat it is not given."""

import numpy as np

from diagnose.fit.linearised_system import LinearisedSystem
from diagnose.fit.samples import SampleBlock, Samples
from diagnose.statistics.impulse_response import doubling_edges, impulse_response_forecast, lagged_means
from foundation.arrays import Floats


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
    return samples.block_vector(block, block.whitening(past))


def box_scores(samples: Samples, baseline: LinearisedSystem, metric: LinearisedSystem, past: Floats) -> Floats:
    """Held-out log-scores (presses,) of the baseline with nuisances plus the black box, in another system's metric."""
    informative = metric.informative
    columns = metric.weighted_rows(baseline.nuisance_design)
    kept = baseline.sigma > 0.0
    fold = samples.fold[informative]
    found = impulse_response_forecast(
        metric.weighted_rows(baseline.residual),
        columns[:, kept],
        baseline.sigma[kept],
        metric.weighted_rows(past),
        fold,
    )
    _, place = np.unique(fold, return_inverse=True)
    return np.asarray(found.log_scores + np.bincount(place, np.log(metric.weight[informative])))


def worth_of_form(samples: Samples, metric: LinearisedSystem) -> float:
    """Nats per press that it is worth to know the model-form error: half its share of the variance, summed."""
    share = (metric.variance - metric.numerical) / metric.variance
    folds = len(np.unique(samples.fold[metric.informative]))
    return 0.5 * float(share[metric.informative].sum()) / folds

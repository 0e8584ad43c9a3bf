"""The rival without mechanics, judged in the same metric as the model that is to be named."""

import numpy as np

from diagnose.inference.samples import Block, Samples
from diagnose.inference.system import System
from diagnose.statistics.black_box import black_box_forecast, doubling_edges, lagged_means
from mesh.types import Floats


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


def _of_block(samples: Samples, block: Block, edges_s: Floats) -> Floats:
    run = samples.recording.runs[block.run]
    depth = run.drive_values
    if run.drive == "displacement_mm" and samples.recording.specimen is None:
        depth = np.maximum(depth, 0.0)
    edges = np.maximum.accumulate(np.maximum(np.round(edges_s / run.step_s), np.arange(len(edges_s)))).astype(np.int64)
    past = np.column_stack([lagged_means(values, edges) for values in (depth, depth**2)])
    return samples.of_block(block, block.whitening(past))


def box_scores(samples: Samples, baseline: System, metric: System, past: Floats) -> Floats:
    """Held-out log-scores (presses,) of the baseline with nuisances plus the black box, in another system's metric."""
    live = metric.live
    columns = metric.weighted(baseline.excused)
    kept = baseline.sigma > 0.0
    fold = samples.fold[live]
    found = black_box_forecast(
        metric.weighted(baseline.residual), columns[:, kept], baseline.sigma[kept], metric.weighted(past), fold
    )
    _, place = np.unique(fold, return_inverse=True)
    return np.asarray(found.log_scores + np.bincount(place, np.log(metric.weight[live])))


def worth_of_form(samples: Samples, metric: System) -> float:
    """Nats per press that it is worth to know the error of form: half its share of the variance, summed."""
    share = (metric.variance - metric.numerical) / metric.variance
    folds = len(np.unique(samples.fold[metric.live]))
    return 0.5 * float(share[metric.live].sum()) / folds

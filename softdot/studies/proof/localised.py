"""A rival: sparse regression whose terms act in one phase alone and are taken in by F tests.

In the manner of LISDD (arXiv:2606.23215), of which the title alone was known here: a discrepancy that is localised and
sparse, found by F tests.
"""

from collections.abc import Sequence

import numpy as np
from scipy.stats import f as f_distribution

from softdot.studies.proof.believed import Opinion, features, linear_opinion, terms_of
from softdot.studies.proof.world.arrays import Floats
from softdot.studies.proof.world.bench import Bench
from softdot.studies.proof.world.reality import Signals

STILL = 0.05
"""Share of the largest depth or speed below which the dot is clear or held."""
TESTED, LEVEL = 1000, 0.001
"""Samples of a channel, far enough apart to be taken as independent, and the error rate of all F tests of it."""


def localised_regression(bench: Bench, runs: Sequence[Signals], model: Sequence[Signals]) -> Opinion:
    """Opinion of a regression on each term in each phase alone, taken in while a partial F test is for it; the one that
    explains most names.
    """

    def columns_of(run: Signals, own: Signals, channel: str) -> Floats:
        terms = terms_of(bench, run, own, channel)
        return np.concatenate([terms * phase[:, None] for phase in _phases(bench, run)], axis=1)

    return linear_opinion(bench, runs, model, columns_of, _fit_selected)


def _fit_selected(inputs: Floats, target: Floats) -> tuple[Floats, Floats]:
    """Weights (k,) of the columns that are taken in, and the squares (k,) that each takes."""
    some = np.linspace(0, len(target) - 1, min(TESTED, len(target))).astype(int)
    gains = _select_forward(inputs[some], target[some])
    columns, weights, sizes = list(gains), np.zeros(inputs.shape[1]), np.zeros(inputs.shape[1])
    weights[columns] = np.linalg.lstsq(inputs[:, columns], target, rcond=None)[0]
    sizes[columns] = list(gains.values())
    return weights, sizes


def _phases(bench: Bench, run: Signals) -> list[Floats]:
    """Phases where the dot is clear, goes down, is held and goes up, each (t,) of 0 and 1."""
    depth, rate = features(bench, run)[:, :2].T
    still, clear = np.abs(rate) < STILL * np.abs(rate).max(), depth < STILL
    parts = (still & clear, ~still & (rate > 0.0), still & ~clear, ~still & (rate < 0.0))
    return [part.astype(np.float64) for part in parts]


def _select_forward(inputs: Floats, target: Floats) -> dict[int, float]:
    """Select columns of inputs (n, k) forward: column -> squares of target (n,) that it takes, in order."""
    left, columns, found = target.copy(), inputs.copy(), dict[int, float]()
    while len(found) < columns.shape[1]:
        size = (columns**2).sum(axis=0)
        usable = size > 1e-9 * (inputs**2).sum(axis=0)
        gain = np.divide((columns.T @ left) ** 2, size, out=np.zeros(len(size)), where=usable)
        best, free = int(gain.argmax()), len(left) - len(found) - 1
        ratio = gain[best] * free / max(float(left @ left) - gain[best], 1e-300)
        if f_distribution.sf(ratio, 1, free) * columns.shape[1] > LEVEL:
            break
        found[best] = float(gain[best])
        direction = columns[:, best] / np.sqrt(size[best])
        left -= direction * (direction @ left)
        columns -= np.outer(direction, direction @ columns)
    return found

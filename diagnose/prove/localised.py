"""A rival: sparse regression whose terms act in one phase alone and are taken in by F tests.

In the manner of LISDD (arXiv:2606.23215), of which the title alone was known here: a discrepancy that is localised and
sparse, found by F tests.
"""

from collections.abc import Sequence

import numpy as np
from scipy.stats import f as f_distribution

from diagnose.prove.believed import TERMS, WORTH, Opinion, features, halves, held_out, less_gain, residuals_of, terms_of
from diagnose.prove.world.bench import Bench
from diagnose.prove.world.laws import Floats
from diagnose.prove.world.reality import Signals, noise_of

STILL = 0.05
"""Share of the largest depth or speed below which the dot is clear or held."""
TESTED, LEVEL = 1000, 0.001
"""Samples of a channel, far enough apart to be taken as independent, and the error rate of all F tests of it."""


def localised(bench: Bench, runs: Sequence[Signals], model: Sequence[Signals]) -> Opinion:
    """Each term in each phase alone, taken in while a partial F test is for it; what explains most names."""
    before = residuals_of(bench, runs, model)
    firsts = [halves(bench, n, run["time_s"])[0] for n, run in enumerate(runs)]
    after, explained = {}, dict.fromkeys(TERMS, 0.0)
    for name, residuals in before.items():
        sigma = noise_of(bench)[name]
        local = [
            np.concatenate([terms_of(bench, run, own, name) * phase[:, None] for phase in _phases(bench, run)], axis=1)
            for run, own in zip(runs, model, strict=True)
        ]
        local = [less_gain(bench, n, model[n], name, terms) for n, terms in enumerate(local)]
        inputs = np.concatenate([terms[first] for terms, first in zip(local, firsts, strict=True)])
        target = np.concatenate([r[first] for r, first in zip(residuals, firsts, strict=True)]) / sigma
        some = np.linspace(0, len(target) - 1, min(TESTED, len(target))).astype(int)
        gains = _taken_in(inputs[some], target[some])
        for column, gain in gains.items():
            explained[list(TERMS)[column % len(TERMS)]] += gain
        weights = np.zeros(inputs.shape[1])
        columns = list(gains)
        weights[columns] = np.linalg.lstsq(inputs[:, columns], target, rcond=None)[0]
        after[name] = [r - sigma * (terms @ weights) for r, terms in zip(residuals, local, strict=True)]
    left, had = held_out(bench, runs, after), held_out(bench, runs, before)
    largest = max(explained, key=lambda term: explained[term])
    named = TERMS[largest] if explained[largest] > 0.0 and had > WORTH * left else None
    return Opinion(had > WORTH * left, named, left)


def _phases(bench: Bench, run: Signals) -> list[Floats]:
    """Where the dot is clear, goes down, is held and goes up, each (t,) of 0 and 1."""
    depth, rate = features(bench, run)[:, :2].T
    still, clear = np.abs(rate) < STILL * np.abs(rate).max(), depth < STILL
    parts = (still & clear, ~still & (rate > 0.0), still & ~clear, ~still & (rate < 0.0))
    return [part.astype(np.float64) for part in parts]


def _taken_in(inputs: Floats, target: Floats) -> dict[int, float]:
    """Column of inputs (n, k) -> squares of target (n,) that it takes, in the order of a forward selection."""
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

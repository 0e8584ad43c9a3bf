"""How well a hypothesis predicts conditions that it was not fitted to, beside a discrepancy of unknown size.

The score of a condition is the logarithm of its predictive density given all others, linear about the fit to all, with
everything linear integrated out and the sizes of the discrepancy summed over a grid under their priors:
    p(y_k | others) = sum_s prior(s) p(y | s) / sum_s prior(s) p(others | s)
So no hypothesis is judged by the size that another one needs, and a hypothesis that leaves much pays for it.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property, reduce
from itertools import product
from operator import add

import numpy as np
from scipy.special import logsumexp

from diagnose.fit.linearised_system import LinearisedSystem
from diagnose.fit.marginal_likelihood import Quadratic
from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.rig_discrepancy import RigDiscrepancy
from diagnose.statistics.linear_gaussian import Sums
from foundation.arrays import Bools, Floats, Ints

SIZES = 1e-3 * 2.0 ** np.arange(8.0)
"""Sizes of a discrepancy, relative to the signal: 0.1 % to 13 %. What is farther off is no discrepancy of a model."""
USUAL_SHAPE, USUAL_ROUGH, USUAL_MEMORY = 0.005, 0.002, 0.05
"""Medians of the priors of the sizes, which are half-Cauchy: of the shapes half a per cent, what two good codes differ
by and an ordinary rig adds; of the rest 0.2 %; of a memory that no mechanism explains 5 %."""
NEGLIGIBLE_NATS = 7.0  # below the likeliest sizes: these count for nothing
MOST_FOLDS = 12  # groups of conditions that are left out in turn


@dataclass(frozen=True)
class Scored:
    """log_scores : (f,) of each group of conditions. missed : (n,) whitened residual of each where it was left out,
    with what belongs to its own runs, such as gains, fitted to it. sizes : the likeliest of the discrepancy, relative
    to the signal, by name.
    """

    log_scores: Floats
    missed: Floats
    sizes: dict[str, float]


@dataclass(frozen=True)
class LinearHypothesis:
    """residual (n,) = columns (n, k) @ parameters + discrepancy + noise; sigma : (k,) prior deviations.

    system : the metric and the rows that are looked at. memory : whether each column, (k,) flags, is part of a flexible
    memory, whose size is not known either. own : whether it belongs to one run alone, such as a gain.
    """

    system: LinearisedSystem
    residual: Floats
    columns: Floats
    sigma: Floats
    memory: Bools
    own: Bools


class HeldOutScorer:
    """Scores hypotheses on the same groups of conditions. fold : (n,) number of the group of each coefficient."""

    def __init__(self, model: ObservedModel, discrepancy: RigDiscrepancy, conditions: Ints) -> None:
        self.model, self.discrepancy = model, discrepancy
        self.fold: Ints = np.unique(conditions, return_inverse=True)[1] % MOST_FOLDS
        self.folds = int(self.fold.max()) + 1

    def scored(self, hypothesis: LinearHypothesis) -> Scored:
        """The hypothesis on all groups."""
        return _Scoring(self, hypothesis).scored()


class _Scoring:
    """Sums of one hypothesis for all sizes, added up as they are asked for."""

    def __init__(self, scorer: HeldOutScorer, one: LinearHypothesis) -> None:
        self.scorer, self.one = scorer, one
        found, system = scorer.discrepancy, one.system
        self.rows = np.flatnonzero(system.informative)
        self.count = one.columns.shape[1]
        self.columns = np.hstack([one.columns[self.rows], found.columns[self.rows]])
        self.residual = one.residual[self.rows]
        self.fold, self.kind = scorer.fold[self.rows], found.kind[self.rows]
        self.variance, self.rough = system.variance[self.rows], found.rough[self.rows]
        self.kinds = len(found.kinds)
        self._sums: dict[tuple[int, int], list[tuple[Sums, float]]] = {}

    @cached_property
    def axes(self) -> list[tuple[str, float]]:
        """Name and usual size of each size that is not known: shape and rest of each quantity, and a memory."""
        units = self.scorer.discrepancy.kinds
        axes = [(f"shape {unit}", USUAL_SHAPE) for unit in units] + [(f"rest {unit}", USUAL_ROUGH) for unit in units]
        return [*axes, ("memory", USUAL_MEMORY)] if self.one.memory.any() else axes

    def scored(self) -> Scored:
        best = self._likeliest()
        states = list(self._around(best))
        whole = np.array([self._log_evidence(state, None) for state in states])
        kept = whole > whole.max() - NEGLIGIBLE_NATS
        scores = np.empty(self.scorer.folds)
        for fold in range(self.scorer.folds):
            others = [self._log_evidence(state, fold) for state, one in zip(states, kept, strict=True) if one]
            scores[fold] = logsumexp(whole[kept]) - logsumexp(others)
        sizes = {name: float(SIZES[n]) for (name, _), n in zip(self.axes, best, strict=True)}
        return Scored(scores, self._missed(best), sizes)

    def _likeliest(self) -> tuple[int, ...]:
        """Numbers of the likeliest sizes, one after the other until none changes."""
        state = [int(np.searchsorted(SIZES, usual)) for _, usual in self.axes]
        for _ in range(4):
            before = list(state)
            for axis in range(len(state)):
                tried = [self._log_evidence((*state[:axis], n, *state[axis + 1 :]), None) for n in range(len(SIZES))]
                state[axis] = int(np.argmax(tried))
            if state == before:
                break
        return tuple(state)

    def _around(self, best: tuple[int, ...]) -> Iterator[tuple[int, ...]]:
        """All sizes next to the likeliest."""
        return product(*(range(max(n - 1, 0), min(n + 2, len(SIZES))) for n in best))

    def _log_evidence(self, state: tuple[int, ...], without: int | None) -> float:
        """Logarithm of prior and evidence of all groups but one, a flat prior having the density 1."""
        sums, scale = self._parts(state, without)
        prior = sum(_log_half_cauchy(SIZES[n], usual) for n, (_, usual) in zip(state, self.axes, strict=True))
        return sums.log_evidence(self._sigma(state)) + scale + prior

    def _sigma(self, state: tuple[int, ...]) -> Floats:
        """Prior deviations (k,) of all columns."""
        one, quantity = self.one, self.scorer.discrepancy.quantity
        size = np.array([SIZES[n] for n in state])
        own = one.sigma * np.where(one.memory, size[-1], 1.0)
        return np.concatenate([own, np.where(quantity < 0, 1.0, size[np.maximum(quantity, 0)])])

    def _parts(self, state: tuple[int, ...], without: int | None) -> tuple[Sums, float]:
        """Sums over groups and quantities, and the logarithm of the weights."""
        chosen = [
            part
            for kind in range(self.kinds)
            for fold, part in enumerate(self._by_fold(kind, state[self.kinds + kind]))
            if fold != without
        ]
        return reduce(add, (sums for sums, _ in chosen)), sum(scale for _, scale in chosen)

    def _by_fold(self, kind: int, size: int) -> list[tuple[Sums, float]]:
        """Sums of each group in one quantity, with a rest of one size, and the logarithm of their weights."""
        if (kind, size) not in self._sums:
            found = []
            for fold in range(self.scorer.folds):
                rows = (self.kind == kind) & (self.fold == fold)
                weight = self._weight(size)[rows]
                sums = Sums.from_columns(self.columns[rows] * weight[:, None], self.residual[rows] * weight)
                found.append((sums, float(np.log(weight).sum())))
            self._sums[kind, size] = found
        return self._sums[kind, size]

    def _weight(self, size: int) -> Floats:
        return np.asarray(1.0 / np.sqrt(self.variance + SIZES[size] ** 2 * self.rough))

    def _missed(self, state: tuple[int, ...]) -> Floats:
        """(n,) residual of each group as the others predict it, with what is the group's own fitted to it."""
        one, sigma = self.one, self._sigma(state)
        whole = self._parts(state, None)[0].mean(sigma)  # for rows that fits do not look at
        missed, own = one.residual - one.columns @ whole[: self.count], np.flatnonzero(one.own)
        weight = np.empty(len(self.rows))
        for kind in range(self.kinds):
            rows = self.kind == kind
            weight[rows] = self._weight(state[self.kinds + kind])[rows]
        for fold in range(self.scorer.folds):
            held = self.fold == fold
            mean = self._parts(state, fold if self.scorer.folds > 1 else None)[0].mean(sigma)
            mean[self.count :], rows = 0.0, self.rows[held]
            left = one.residual[rows] - self.columns[held] @ mean
            columns = self.columns[held][:, own] * weight[held, None]
            closest = Quadratic(columns, sigma[own]).mean(left * weight[held])
            missed[rows] = left - self.columns[held][:, own] @ closest
        return missed


def _log_half_cauchy(size: float, usual: float) -> float:
    """Logarithm of the density of a size on a logarithmic grid, but for a constant."""
    return float(np.log(size / usual) - np.log1p((size / usual) ** 2))

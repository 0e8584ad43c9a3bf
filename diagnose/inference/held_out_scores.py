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
from typing import NamedTuple

import numpy as np
from scipy.special import logsumexp

from diagnose.fit.linearised_system import LinearisedSystem
from diagnose.fit.marginal_likelihood import Quadratic
from diagnose.fit.rig_discrepancy import SPECTRA, RigDiscrepancy
from diagnose.inference.conditions import Conditions
from diagnose.statistics.linear_gaussian import Sums
from foundation.arrays import Bools, Floats

SIZES = 1e-3 * 2.0 ** np.arange(8.0)
"""Sizes of a memory and of what is rough, relative to the signal: 0.1 % to 13 %."""
SMOOTH_SIZES = SIZES[:5]
"""Those of what is smooth, to 1.6 %: a rig or code that is farther off for a whole press has more than small flaws.
Were more allowed, a fit would be praised for its details while it misses the press."""


class RandomRest(NamedTuple):
    """A random rest. size : relative to the signal. spectrum : its number in SPECTRA."""

    size: float
    spectrum: int


RESTS = tuple(
    RandomRest(float(size), number)
    for number, power in enumerate(SPECTRA)
    for size in (SMOOTH_SIZES if power > 0.0 else SIZES)
)
USUAL_SHAPE, USUAL_ROUGH, USUAL_MEMORY = 0.005, 0.002, 0.05
"""Medians of the priors of the sizes, which are half-Cauchy: of the shapes half a per cent, what two good codes differ
by and an ordinary rig adds; of the rest 0.2 %; of a memory that no mechanism explains 5 %."""
NEGLIGIBLE_NATS = 7.0  # below the likeliest sizes: these count for nothing


@dataclass(frozen=True)
class Scored:
    """log_scores : (f,) of each group of conditions that is judged. missed : (n,) whitened residual of each group where
    it was left out, with what belongs to its own runs, such as gains, fitted to it. sizes : the likeliest of the
    discrepancy, relative to the signal, by name. rest : (n,) variance of its random part.
    """

    log_scores: Floats
    missed: Floats
    sizes: dict[str, float]
    rest: Floats


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
    """Scores hypotheses on the same groups of conditions."""

    def __init__(self, discrepancy: RigDiscrepancy, conditions: Conditions) -> None:
        self.discrepancy, self.fold, self.judged = discrepancy, conditions.fold, conditions.judged
        self.folds = len(conditions.judged)

    def scored(self, hypothesis: LinearHypothesis) -> Scored:
        """The hypothesis on all groups."""
        return _Scoring(self, hypothesis).scored()


class _Unknown(NamedTuple):
    """A size that is summed over. sizes : (v,) that it may have. usual : median of its prior."""

    name: str
    sizes: Floats
    usual: float

    def near(self, number: int) -> list[int]:
        """Numbers of the sizes next to one and of itself."""
        ratio = self.sizes / self.sizes[number]
        count = np.arange(len(ratio))
        return [int(n) for n in np.flatnonzero((np.abs(count - number) <= 1) & (ratio < 2.1) & (ratio > 0.4))]


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
        self.variance, self.rough = system.variance[self.rows], found.rough[:, self.rows]
        self.kinds = len(found.kinds)
        self._sums: dict[tuple[int, int], list[tuple[Sums, float]]] = {}

    @cached_property
    def axes(self) -> list[_Unknown]:
        """Sizes that are not known: those of the shapes and of the rest of each quantity, and that of a memory."""
        units = self.scorer.discrepancy.kinds
        found = [_Unknown(f"shape {unit}", SMOOTH_SIZES, USUAL_SHAPE) for unit in units]
        found += [_Unknown(f"rest {unit}", np.array([one.size for one in RESTS]), USUAL_ROUGH) for unit in units]
        return [*found, _Unknown("memory", SIZES, USUAL_MEMORY)] if self.one.memory.any() else found

    def scored(self) -> Scored:
        best = self._likeliest()
        states = list(self._around(best))
        whole = np.array([self._log_evidence(state, None) for state in states])
        kept = whole > whole.max() - NEGLIGIBLE_NATS
        scores = []
        for fold in np.flatnonzero(self.scorer.judged):
            others = [self._log_evidence(state, int(fold)) for state, one in zip(states, kept, strict=True) if one]
            scores.append(float(logsumexp(whole[kept]) - logsumexp(others)))
        sizes = {axis.name: float(axis.sizes[n]) for axis, n in zip(self.axes, best, strict=True)}
        return Scored(np.array(scores), self._missed(best), sizes, self._rest(best))

    def _likeliest(self) -> tuple[int, ...]:
        """Numbers of the likeliest sizes, one after the other until none changes."""
        state = [int(np.argmin(np.abs(np.log(axis.sizes / axis.usual)))) for axis in self.axes]
        for _ in range(4):
            before = list(state)
            for at, axis in enumerate(self.axes):
                tried = [self._log_evidence((*state[:at], n, *state[at + 1 :]), None) for n in range(len(axis.sizes))]
                state[at] = int(np.argmax(tried))
            if state == before:
                break
        return tuple(state)

    def _around(self, best: tuple[int, ...]) -> Iterator[tuple[int, ...]]:
        """All sizes next to the likeliest."""
        return product(*(axis.near(n) for axis, n in zip(self.axes, best, strict=True)))

    def _log_evidence(self, state: tuple[int, ...], without: int | None) -> float:
        """Logarithm of prior and evidence of all groups but one, a flat prior having the density 1."""
        sums, scale = self._parts(state, without)
        sized = zip(self.axes, state, strict=True)
        prior = sum(_log_half_cauchy(axis.sizes[n], axis.usual) for axis, n in sized)
        return sums.log_evidence(self._sigma(state)) + scale + prior

    def _sigma(self, state: tuple[int, ...]) -> Floats:
        """Prior deviations (k,) of all columns."""
        one, quantity = self.one, self.scorer.discrepancy.quantity
        size = np.array([axis.sizes[n] for axis, n in zip(self.axes, state, strict=True)])
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

    def _by_fold(self, kind: int, rest: int) -> list[tuple[Sums, float]]:
        """Sums of each group in one quantity, with one rest, and the logarithm of their weights."""
        if (kind, rest) not in self._sums:
            found = []
            for fold in range(self.scorer.folds):
                rows = (self.kind == kind) & (self.fold == fold)
                weight = self._weight(RESTS[rest])[rows]
                sums = Sums.from_columns(self.columns[rows] * weight[:, None], self.residual[rows] * weight)
                found.append((sums, float(np.log(weight).sum())))
            self._sums[kind, rest] = found
        return self._sums[kind, rest]

    def _weight(self, rest: RandomRest) -> Floats:
        return np.asarray(1.0 / np.sqrt(self.variance + rest.size**2 * self.rough[rest.spectrum]))

    def _rest(self, state: tuple[int, ...]) -> Floats:
        """Variance (n,) of the rest."""
        found, variance = self.scorer.discrepancy, np.empty(len(self.scorer.fold))
        for kind in range(self.kinds):
            rest, rows = RESTS[state[self.kinds + kind]], found.kind == kind
            variance[rows] = rest.size**2 * found.rough[rest.spectrum, rows]
        return variance

    def _missed(self, state: tuple[int, ...]) -> Floats:
        """(n,) residual of each group as the others predict it, with what is the group's own fitted to it."""
        one, sigma = self.one, self._sigma(state)
        whole = self._parts(state, None)[0].mean(sigma)  # for rows that fits do not look at
        missed, own = one.residual - one.columns @ whole[: self.count], np.flatnonzero(one.own)
        weight = np.empty(len(self.rows))
        for kind in range(self.kinds):
            rows = self.kind == kind
            weight[rows] = self._weight(RESTS[state[self.kinds + kind]])[rows]
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

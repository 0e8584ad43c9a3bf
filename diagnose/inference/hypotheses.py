"""Hypotheses on what was left out, compared on one footing: nothing, mechanisms alone and together, something else.

Mechanisms are fitted with a small discrepancy among the noise. Pairs and triples are grown stepwise, where one alone
leaves more than an ordinary rig does. Something else is the baseline with a flexible memory of the drive, both viscous
and rate-independent, without mechanics.
"""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from diagnose.figures import figure
from diagnose.fit.baseline import cap_nuisances, hold_strained_nuisances
from diagnose.fit.descent import coordinates
from diagnose.fit.linearised_system import LinearisedSystem
from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.refit import Fitted, fit_mechanisms
from diagnose.fit.rig_discrepancy import VISIBLE_ERROR, RigDiscrepancy, played
from diagnose.fit.samples import SampleBlock, Samples
from diagnose.forward import Candidate, NoAnswerError
from diagnose.inference.conditions import conditions_of
from diagnose.inference.grades import THRESHOLDS, accounts_for_all, takes_away
from diagnose.inference.held_out_scores import USUAL_SHAPE, HeldOutScorer, LinearHypothesis, Scored
from diagnose.inference.screening import Screening
from diagnose.inference.search import first_fits, paired, pairs, singles
from diagnose.statistics.impulse_response import doubling_edges, lagged_means
from diagnose.statistics.model_criteria import held_out_probabilities
from foundation.arrays import Floats
from foundation.progress import Report

MOST_MECHANISMS = 3
MOST_FIRSTS = 3  # hypotheses beside which another mechanism is sought
WORTH_NATS = 3.0
"""What another mechanism must gain, over all conditions, to be a hypothesis beside those that it is added to."""
PART_SHARE = 0.5  # of the share of the best: what accounts for less is sought beside it, not it beside others
PLAY_SHARES = (0.05, 0.15, 0.4)  # of the range of a drive: thresholds of the play operators of something else
FLAT = 1e6  # sigma of the noise over all samples: a prior for what has none


@dataclass(frozen=True)
class Hypothesis:
    """A hypothesis with its score.

    fit : None for nothing and for something else. metric : the model in whose metric it was fitted, and form_excess :
    excess of which an error of its law may have taken a part there. found_as : the fit beside which further mechanisms
    are sought, with a small discrepancy only. left : (n,) squares above noise of what it leaves of conditions that were
    left out, relative to the signal of each channel, 0 where a condition is not judged.
    """

    fit: Fitted | None
    metric: ObservedModel
    form_excess: float
    found_as: Fitted | None
    scored: Scored
    left: Floats

    @property
    def candidates(self) -> tuple[Candidate, ...]:
        """Mechanisms in it."""
        return () if self.fit is None else self.fit.candidates

    @property
    def names(self) -> frozenset[tuple[str, str]]:
        """Names of its mechanisms."""
        return frozenset(candidate.name for candidate in self.candidates)

    @property
    def score(self) -> float:
        """Logarithm of the predictive density of all conditions, nats."""
        return float(self.scored.log_scores.sum())


@dataclass(frozen=True)
class Compared:
    """All hypotheses. explained : those with mechanisms, best first. probabilities : (m,) of these, of nothing and of
    something else last. judge : in whose metric.
    """

    judge: "Judge"
    explained: tuple[Hypothesis, ...]
    nothing: Hypothesis
    something_else: Hypothesis
    probabilities: Floats

    @property
    def best(self) -> Hypothesis | None:
        """The first of those with mechanisms."""
        return self.explained[0] if self.explained else None

    @property
    def parts_of_best(self) -> list[int]:
        """Numbers of the explanations that hold some of the mechanisms of the best only, best first."""
        return [n for n, one in enumerate(self.explained) if one.names < self.explained[0].names]

    def with_first(self, number: int) -> "Compared":
        """The same with another explanation before all others."""
        order = [number, *(n for n in range(len(self.probabilities)) if n != number)]
        explained = tuple(self.explained[n] for n in order[: len(self.explained)])
        return replace(self, explained=explained, probabilities=self.probabilities[order])


class Judge:
    """Scores hypotheses of one recording, all with the same discrepancy and on the same conditions."""

    def __init__(self, model: ObservedModel, found: Screening, discrepancy: RigDiscrepancy) -> None:
        self.model, self.found, self.discrepancy = model, found, discrepancy
        self.conditions = conditions_of(model.samples)
        self.scorer = HeldOutScorer(discrepancy, self.conditions)
        self.errors = replace(discrepancy.errors, counted=self.conditions.judged[self.conditions.fold])

    @cached_property
    def nothing(self) -> Hypothesis:
        """The baseline, with strained nuisances held at what the experimenter declared."""
        system = hold_strained_nuisances(self.found.start, self.found.baseline)
        return self._hypothesis(None, system, self.model, self.found.excess)

    @cached_property
    def something_else(self) -> Hypothesis:
        """The baseline with a flexible memory."""
        system = hold_strained_nuisances(self.found.start, self.found.baseline)
        memory = flexible_memory(self.model.samples)
        return self._hypothesis(None, system, self.model, self.found.excess, memory)

    def scored(self, fits: Sequence[Fitted]) -> list[Hypothesis]:
        """The hypotheses of fits, without those that have no answer any more."""
        found = []
        for fit in fits:
            with suppress(NoAnswerError):
                found.append(self._scored(fit))
        return found

    def _scored(self, fit: Fitted) -> Hypothesis:
        """The hypothesis of a fit; where it leaves more than a rig's flaws it is fitted anew beside so much, without an
        error of its law, and what predicts better counts. Beside little noise a law that is not exact would follow its
        smallest details otherwise.
        """
        first = self._hypothesis(fit, cap_nuisances(fit.system), self.model, self.found.excess)
        if self.error(first) <= VISIBLE_ERROR:
            return first
        start = replace(self.found.start, values=fit.system.values)
        metric = self.model.with_tolerance(first.scored.rest)
        again = fit_mechanisms(metric, start, fit.candidates, fit.values, 0.0)
        other = self._hypothesis(again, cap_nuisances(again.system), metric, 0.0)
        return replace(other, found_as=fit) if self.error(other) < self.error(first) else first

    def _hypothesis(
        self,
        fit: Fitted | None,
        system: LinearisedSystem,
        metric: ObservedModel,
        form_excess: float,
        memory: Floats | None = None,
    ) -> Hypothesis:
        linear = self._linear(fit, replace(system, numerical=system.numerical - metric.tolerance), memory)
        scored = self.scorer.scored(linear)
        left = self.errors.above_noise(scored.missed)
        if fit is not None:
            fitted = self.errors.above_noise(self._residual(fit, metric))
            left = max(left, fitted, key=np.sum)  # nothing predicts better than it fits: the linear model went too far
        return Hypothesis(fit, metric, form_excess, fit, scored, left)

    def _residual(self, fit: Fitted, metric: ObservedModel) -> Floats:
        """Whitened residual (n,) of a fit itself."""
        shown = metric.vector(fit.closest_nuisances(metric), fit.settings)
        return np.asarray(self.model.samples.recorded_vector - shown)

    def _linear(self, fit: Fitted | None, system: LinearisedSystem, memory: Floats | None) -> LinearHypothesis:
        """Without the errors of the engine among the columns, which the discrepancy has."""
        count, total = len(system.values), len(system.sigma)
        kept = np.r_[0:count, total - system.laws : total]
        columns = np.zeros((len(self.model.samples), len(kept)))
        columns[system.informative] = system.nuisance_design[:, kept]
        sigma, residual = system.sigma[kept], system.residual
        own = [one.run is not None for one in self.model.nuisances] + [False] * (len(kept) - count)
        if fit is not None:
            width = np.array([one.high - one.low for one in coordinates(fit.candidates)])
            columns, sigma = np.hstack([columns, fit.slopes]), np.concatenate([sigma, width])
            residual = residual + fit.slopes @ fit.values
            own += [one.traits.free_phase for one in fit.candidates for _ in one.coordinates]
        flexible = np.zeros(len(sigma), dtype=bool)
        if memory is not None:
            columns = np.hstack([columns, memory])
            sigma = np.concatenate([sigma, np.ones(memory.shape[1])])
            flexible = np.concatenate([flexible, np.ones(memory.shape[1], dtype=bool)])
        own += [False] * (len(sigma) - len(own))
        length = np.linalg.norm(columns[system.informative], axis=0)
        sigma = np.where(np.isinf(sigma), FLAT / np.maximum(length, 1.0), sigma)
        return LinearHypothesis(system, residual, columns, sigma, flexible, np.array(own, dtype=bool))

    def share(self, one: Hypothesis) -> float:
        """Share of the excess of nothing that a hypothesis accounts for in conditions that were left out."""
        return self.errors.share_taken(self.nothing.left, one.left)

    def apart(self, one: Hypothesis, other: Hypothesis) -> float:
        """Root mean square difference of two forecasts, relative to the signal, of the worst channel."""
        return self.errors.largest(self.errors.squares(one.scored.missed - other.scored.missed))

    def known_share(self, one: Hypothesis) -> float:
        """The same share, were two sigma of the noise in what it leaves no more than noise."""
        return self.errors.share_taken(self.nothing.left, one.left, 2.0)

    def error(self, one: Hypothesis) -> float:
        """Root mean square error of a hypothesis in conditions left out, above noise, of the worst channel."""
        return self.errors.largest(one.left)

    def is_closer(self, one: Hypothesis, other: Hypothesis) -> bool:
        """Whether one is closer in practice to conditions that were left out than another."""
        return takes_away(self.error(other), self.error(one))


def compared(judge: Judge, rng: np.random.Generator, report: Report) -> Compared:
    """All hypotheses of a recording, the best first."""
    fits = singles(judge.model, judge.found, first_fits(judge.model, judge.found, report), report)
    found = []
    for count, fit in enumerate(fits):
        report("held-out conditions", count, len(fits))
        # what predicts with more error than nothing explains nothing, whatever its score
        found += [one for one in judge.scored([fit]) if judge.share(one) > 0.0]
    grown = _best_first(found)
    while grown and len(grown[0].candidates) < MOST_MECHANISMS and _least_error(judge, grown) > VISIBLE_ERROR:
        more = _with_one_more(judge, grown, report)
        if not more:
            break
        found += more
        grown = _best_first([*more, *grown])
    ordered = _in_order(judge, found)
    scores = [one.scored.log_scores for one in (*ordered, judge.nothing, judge.something_else)]
    probabilities = held_out_probabilities(np.array(scores), rng)
    whole = Compared(judge, tuple(ordered), judge.nothing, judge.something_else, probabilities)
    return whole.with_first(simplest(judge, ordered, probabilities)) if ordered else whole


def _in_order(judge: Judge, found: Sequence[Hypothesis]) -> list[Hypothesis]:
    """The likeliest first, before all than which another one is closer in practice: what is likelier in details and
    leaves more explains less. Of those that score alike, first what needs no implausible value and has few coordinates.
    """
    close = [one for one in found if not any(judge.is_closer(other, one) for other in found)]
    least = max((one.score for one in close), default=0.0) - WORTH_NATS

    def rank(one: Hypothesis) -> tuple[bool, bool, bool, int, float]:
        is_close = any(one is other for other in close)
        is_alike = is_close and one.score > least
        count = sum(len(candidate.coordinates) for candidate in one.candidates)
        implies = bool(implausible(one.fit))
        return not is_close, not is_alike, is_alike and implies, count if is_alike else 0, -one.score

    return sorted(found, key=rank)


def simplest(judge: Judge, ordered: Sequence[Hypothesis], probabilities: Floats) -> int:
    """Number of the first, or of what holds a part of its mechanisms only and is not excluded beside it. Where a part
    is probable and accounts for all but flaws, the others are details of its law.
    """

    def is_enough(number: int) -> bool:
        one = ordered[number]
        whole = accounts_for_all(judge.error(one), judge.known_share(one))
        return as_good(judge, ordered, probabilities, number) or (whole and is_probable(ordered, probabilities, number))

    parts = [n for n, one in enumerate(ordered) if one.names < ordered[0].names and is_enough(n)]
    return min(parts, key=lambda n: len(ordered[n].names), default=0)


def as_good(judge: Judge, ordered: Sequence[Hypothesis], probabilities: Floats, number: int) -> bool:
    """Whether an explanation is not excluded beside the first: it is probable beside the likeliest and the first is not
    closer in practice, or its forecast differs from that of the first by no more than those of two good codes.
    """
    first, other = ordered[0], ordered[number]
    probable = is_probable(ordered, probabilities, number) and not judge.is_closer(first, other)
    return probable or judge.apart(first, other) < USUAL_SHAPE


def is_probable(ordered: Sequence[Hypothesis], probabilities: Floats, number: int) -> bool:
    """Whether an explanation is probable beside the likeliest one."""
    least = THRESHOLDS.rival * float(probabilities[: len(ordered)].max() + probabilities[number])
    return float(probabilities[number]) > least


def implausible(fit: Fitted | None) -> tuple[str, ...]:
    """Coordinates of a fit at an end of what a real part can have; 0 is always plausible."""
    found = []
    for coordinate, value in zip(coordinates(fit.candidates), fit.values, strict=True) if fit is not None else ():
        close = 1e-6 * (coordinate.high - coordinate.low)
        for end, plausible in zip((coordinate.low, coordinate.high), coordinate.levels_off, strict=True):
            if end != 0.0 and abs(value - end) <= close and not plausible:
                found.append(f"{coordinate.name.replace('_', ' ')} = {figure(value)}")
    return tuple(found)


def _least_error(judge: Judge, found: Sequence[Hypothesis]) -> float:
    """Of those with as many mechanisms as the first."""
    return min(judge.error(one) for one in found if len(one.candidates) == len(found[0].candidates))


def _with_one_more(judge: Judge, found: Sequence[Hypothesis], report: Report) -> list[Hypothesis]:
    """Hypotheses with one mechanism more than the best, that predict better than it; then what acts in place of one."""
    size, best = len(found[0].candidates), found[0]
    firsts = [one for one in found if len(one.candidates) == size and _is_a_part(judge, one, best)][:MOST_FIRSTS]
    seen = {frozenset(c.name for c in one.candidates) for one in found}
    more: list[Hypothesis] = []
    for first in firsts:
        assert first.found_as is not None
        for fit in pairs(judge.model, judge.found, first.found_as, report):
            if (names := frozenset(c.name for c in fit.candidates)) not in seen:
                seen.add(names)
                more += judge.scored([fit])
    least = _least_error(judge, found)
    more = _worth_it(judge, more, best, least)
    if more and size == 1:
        more += _worth_it(judge, _in_its_place(judge, found, more[0], seen, report), best, least)
    return _best_first(more)


def _is_a_part(judge: Judge, one: Hypothesis, best: Hypothesis) -> bool:
    """Whether a hypothesis accounts for enough that it may be one of two that account for all."""
    return judge.share(one) >= PART_SHARE * judge.share(best)


def _worth_it(judge: Judge, more: Sequence[Hypothesis], best: Hypothesis, least: float) -> list[Hypothesis]:
    """Those that predict better than the best with fewer mechanisms for sure, and are closer than all of these."""
    return _best_first(
        [one for one in more if one.score > best.score + WORTH_NATS and takes_away(least, judge.error(one))]
    )


def _in_its_place(
    judge: Judge, found: Sequence[Hypothesis], pair: Hypothesis, seen: set[frozenset[tuple[str, str]]], report: Report
) -> list[Hypothesis]:
    """The second of a pair beside every other mechanism alone: what imitates the first may not do so here."""
    assert pair.fit is not None
    first, second = pair.candidates
    start, others = pair.fit.values[len(first.coordinates) :], []
    for one in found:
        if one.found_as is not None and len(one.candidates) == 1 and _is_a_part(judge, one, found[0]):
            names = frozenset((one.candidates[0].name, second.name))
            if len(names) == 2 and names not in seen:
                others += paired(judge.model, judge.found, one.found_as, second, [start], report)
    return judge.scored(others)


def _best_first(found: Sequence[Hypothesis]) -> list[Hypothesis]:
    return sorted(found, key=lambda one: -one.score)


def flexible_memory(samples: Samples) -> Floats:
    """Columns (n, k), of the size of the signals: for each channel an impulse response to the drive and to its square,
    and play operators of the drive, common to all runs.
    """
    step = max(run.step_s for run in samples.recording.runs)
    presses = [press.end - press.touch for found in samples.recording.phases for press in found.presses]
    edges_s = np.asarray(doubling_edges(max(presses, default=len(samples))) * step, dtype=np.float64)
    by_channel = []
    for channel in samples.channels:
        own = [block for block in samples.blocks if block.channel == channel]
        columns = np.sum([_past_of(samples, block, edges_s) for block in own], axis=0)
        signal = np.sum([_signal_of(samples, block) for block in own], axis=0)
        length = np.linalg.norm(columns, axis=0)
        scale = np.divide(np.linalg.norm(signal), length, out=np.zeros(len(length)), where=length > 0.0)
        by_channel.append(columns * scale)
    return np.column_stack(by_channel)


def _past_of(samples: Samples, block: SampleBlock, edges_s: Floats) -> Floats:
    run = samples.recording.runs[block.run]
    depth = run.drive_values
    if run.drive == "displacement_mm" and samples.recording.specimen is None:
        depth = np.maximum(depth, 0.0)
    edges = np.maximum.accumulate(np.maximum(np.round(edges_s / run.step_s), np.arange(len(edges_s)))).astype(np.int64)
    reach = float(np.ptp(depth))
    plays = [played(depth, share * reach) - depth[0] for share in PLAY_SHARES]
    past = np.column_stack([*(lagged_means(values, edges) for values in (depth, depth**2)), *plays])
    return samples.block_vector(block, block.whitening(past))


def _signal_of(samples: Samples, block: SampleBlock) -> Floats:
    values = samples.recording.runs[block.run].channels[block.channel]
    return samples.block_vector(block, block.whitening(np.where(np.isfinite(values), values, 0.0)))

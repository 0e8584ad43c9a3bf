"""Which of the fitted models is best, by how much, and what speaks against it."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from diagnose.figures import figure
from diagnose.fit.baseline import hold_strained_nuisances
from diagnose.fit.descent import coordinates
from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.refit import Fitted
from diagnose.forward import Candidate
from diagnose.inference.ambiguity import alike, grouped, separations
from diagnose.inference.black_box import box_scores, memory, worth_of_form
from diagnose.inference.excess import share_left
from diagnose.inference.forecasts import Forecasted, forecasted, gained
from diagnose.inference.residual_test import DRAWS, checked, nuisance_pull
from diagnose.inference.screening import Screening
from diagnose.inference.search import first_fits, paired, pairs, singles
from diagnose.statistics.abstain import Decision, Evidence, decide
from diagnose.statistics.error_rates import AMBIGUITY_ERROR, LARGEST_SHARE_LEFT, MOST_FIRSTS_OF_PAIRS, RATES
from diagnose.statistics.held_out import Gain, gain_over_noise
from diagnose.statistics.model_criteria import bic, held_out_probabilities
from foundation.arrays import Bools, Floats
from foundation.progress import Report

FEWER_DRAWS = 499  # for models that are not the best


@dataclass(frozen=True)
class Judged:
    """A fitted model and what is said of it; p_left is 1 where it leaves less than LARGEST_SHARE_LEFT of the excess.

    p_strained : of what floats beside it, 1 where it leaves less than LARGEST_SHARE_LEFT of the baseline's strain.
    """

    fit: Fitted
    forecast: Forecasted
    gain: Gain
    left: float
    p_left: float
    p_strained: float


@dataclass(frozen=True)
class Choice:
    """models : best first. probabilities : (m,). groups : of models.

    box_gain : nats per press of the black box over the best. base : the baseline's forecast, None without models.
    """

    models: tuple[Judged, ...]
    probabilities: Floats
    groups: tuple[tuple[int, ...], ...]
    box_gain: float
    decision: Decision
    base: Forecasted | None


class Judge:
    """Judges fitted models against the baseline, on the same held-out presses."""

    def __init__(self, model: ObservedModel, found: Screening, rng: np.random.Generator) -> None:
        self.model, self.found, self.rng = model, found, rng
        self.declared = hold_strained_nuisances(found.start, found.baseline)
        self.base = forecasted(model.samples, self.declared)
        self.strain = nuisance_pull(found.baseline)

    def judged(self, fit: Fitted, draws: int = FEWER_DRAWS) -> Judged:
        """Forecast, gain and what is left."""
        samples = self.model.samples
        forecast = forecasted(samples, fit.system, fit)
        left = share_left(fit, self.found.excess)
        system, p_left = replace(fit.system, form_error=fit.largest_form_error), 1.0
        if left > LARGEST_SHARE_LEFT or self.found.excess == 0.0:
            found = checked(samples, system, self.rng, fit.slopes, draws)
            p_left, strain = found.p_value, found.strain
        else:
            strain = nuisance_pull(system, fit.slopes)
        p_strained = strain.p_value if strain.excess > LARGEST_SHARE_LEFT * self.strain.excess else 1.0
        return Judged(fit, forecast, self.gained(forecast, self.base), left, p_left, p_strained)

    def gained(self, one: Forecasted, rival: Forecasted) -> Gain:
        """Nats per press, with a lower bound that is corrected for all candidates."""
        return gained(one, rival, len(self.found.candidates))

    def best(self, models: Sequence[Judged]) -> Judged:
        """The fewest coordinates of those whose loss to the best score is within one standard error.

        Where it leaves too much, or has a value that no part can have, one without such a fault takes its place that
        does not predict worse for sure.
        """
        top = max(models, key=score_of)
        near = [one for one in models if one is top or self._within_one_error(top, one)]
        best = _simplest(near)
        sound = [one for one in models if not _doubtful(one) and self.gained(top.forecast, one.forecast).lower <= 0.0]
        return _simplest(sound) if _doubtful(best) and sound else best

    def _within_one_error(self, top: Judged, other: Judged) -> bool:
        loss = self.gained(top.forecast, other.forecast)
        return loss.mean <= loss.standard_error


def choose(
    model: ObservedModel, found: Screening, p_mismatch: float, rng: np.random.Generator, report: Report
) -> Choice:
    """Single mechanisms first; pairs only where something speaks against the best single one."""
    fits = singles(model, found, first_fits(model, found, report), report)
    if not fits:
        decision = decide(Evidence(p_mismatch, 0.0, 1.0, 0.0, 0.0, (), 0), RATES)
        return Choice((), np.zeros(0), (), 0.0, replace(decision, reasons=(NOTHING,)), None)
    judge = Judge(model, found, rng)
    models = []
    for count, fit in enumerate(fits):
        report("held-out presses", count, len(fits))
        models.append(judge.judged(fit))
    best = judge.best(models)
    if _doubtful(best):
        models, best = _with_pairs(judge, models, best, report)
    rest = _others(models, best)
    best = judge.judged(best.fit, DRAWS)
    return _decided(judge, (best, *rest), p_mismatch)


def _with_pairs(judge: Judge, singles: Sequence[Judged], best: Judged, report: Report) -> tuple[list[Judged], Judged]:
    """Partners for the best single mechanism, then for the next ones, until nothing is left; the models and the best.

    Where two act together, a third may imitate their sum better than either does alone, or one of them beside the
    other.
    """
    models, tried, single = list(singles), list[Candidate](), best
    for first in [best, *_others(singles, best)][:MOST_FIRSTS_OF_PAIRS]:
        same = [one.fit.candidates[0] for one in singles if one is not first and _same(judge, first, one)]
        second = [judge.judged(fit) for fit in pairs(judge.model, judge.found, first.fit, [*same, *tried], report)]
        better = [one for one in second if judge.gained(one.forecast, best.forecast).lower > 0.0]
        models += better
        best = judge.best([best, *better])
        if not _doubtful(best):
            break
        tried += first.fit.candidates
    if best is single:
        return models, best
    rivals = _rivals(judge, singles, best, report)
    models, best = [*models, *rivals], judge.best([best, *rivals])
    others = partners(judge, models, best, report)
    return [*models, *others], judge.best([best, *others])


def _rivals(judge: Judge, singles: Sequence[Judged], pair: Judged, report: Report) -> list[Judged]:
    """The second of a pair beside every other single mechanism: what imitates the first alone may not do so here."""
    first, second = pair.fit.candidates
    start = pair.fit.values[len(first.coordinates) :]
    others = [one.fit for one in singles if one.fit.candidates[0].name not in (first.name, second.name)]
    found = []
    for count, other in enumerate(others):
        report("rivals of the pair", count, len(others))
        found += [judge.judged(fit) for fit in paired(judge.model, judge.found, other, second, [start], report)]
    return found


def partners(judge: Judge, models: Sequence[Judged], pair: Judged, report: Report) -> list[Judged]:
    """The first of a pair beside what else shows there: where the second was found beside another one, it was alone."""
    first = pair.fit.candidates[0]
    alone = next((one.fit for one in models if one.fit.candidates == (first,)), None)
    if alone is None:
        return []
    visited = [c for one in models if first in one.fit.candidates for c in one.fit.candidates if c != first]
    return [judge.judged(fit) for fit in pairs(judge.model, judge.found, alone, visited, report)]


NOTHING = "The residual resembles none of the candidates more than chance allows."


def _decided(judge: Judge, models: tuple[Judged, ...], p_mismatch: float) -> Choice:
    samples, best = judge.model.samples, models[0]
    past = memory(samples)
    metric = replace(best.fit.system, form_error=best.fit.largest_form_error)
    over = box_scores(samples, judge.declared, metric, past) - forecasted(samples, metric, best.fit).log_scores
    box = gain_over_noise(over, np.sqrt(2.0 * np.maximum(over, 0.0)), RATES.level)
    none = box_scores(samples, judge.declared, judge.declared, past)
    scores = np.array([*(one.forecast.log_scores for one in models), judge.base.log_scores, none])
    apart = separations(samples, [one.fit for one in models])
    apart[contradicted(models)] = 0.0
    apart[_told_apart(judge, models)] = np.inf
    probabilities = _probabilities(models, scores, judge.rng)
    others = likely(models, probabilities)
    apart[0, others] = apart[others, 0] = 0.0
    strained, bounds = best.p_strained, implausible(best.fit)
    evidence = Evidence(
        p_mismatch, best.p_left, strained, best.gain.lower, box.lower, bounds, alike(apart), ordinary(best.fit)
    )
    decision = decide(evidence, replace(RATES, margin=worth_of_form(samples, metric)))
    return Choice(models, probabilities, grouped(apart), box.mean, decision, judge.base)


def _probabilities(models: Sequence[Judged], scores: Floats, rng: np.random.Generator) -> Floats:
    """(m,) from scores (m + 2, presses), baseline and none of these last; beside a sound best, faulty ones have 0."""
    sound = not _doubtful(models[0])
    counted = [n for n, one in enumerate(models) if not (sound and _doubtful(one))]
    found = np.zeros(len(models))
    found[counted] = held_out_probabilities(scores[[*counted, -2, -1]], rng)[: len(counted)]
    return found


def _told_apart(judge: Judge, models: Sequence[Judged]) -> Bools:
    """(m, m) whether one of two models predicts held-out presses better for sure: then they are not alike."""
    better = [[judge.gained(one.forecast, other.forecast).lower > 0.0 for other in models] for one in models]
    return np.asarray(np.array(better) | np.array(better).T)


def contradicted(models: Sequence[Judged]) -> Bools:
    """(m, m) whether held-out presses speak for one of two faultless models and the fit to all for the other."""
    scores, badness = np.array([score_of(one) for one in models]), criteria(models)
    faultless = np.array([not _doubtful(one) for one in models])
    against = np.subtract.outer(scores, scores) * np.subtract.outer(badness, badness) > 0.0
    return np.asarray(against & np.logical_and.outer(faultless, faultless))


def likely(models: Sequence[Judged], probabilities: Floats) -> list[int]:
    """Numbers of the faultless models that may be right instead of the first, by probabilities (m,) of the scores."""
    return [n for n, one in enumerate(models) if n > 0 and probabilities[n] > AMBIGUITY_ERROR and not _doubtful(one)]


def criteria(models: Sequence[Judged]) -> Floats:
    """Schwarz's criterion (m,) of each fit to all presses: less is better."""
    return np.array(
        [bic(one.fit.evidence, len(one.fit.values), int(one.fit.system.informative.sum())) for one in models]
    )


def _same(judge: Judge, one: Judged, other: Judged) -> bool:
    """Whether two models are alike: both together are no more than one."""
    return alike(separations(judge.model.samples, [one.fit, other.fit])) > 1


def _simplest(models: Sequence[Judged]) -> Judged:
    """The fewest coordinates, of equals the one that predicts best."""
    return min(models, key=lambda one: (len(one.fit.values), -score_of(one)))


def _others(models: Sequence[Judged], best: Judged) -> list[Judged]:
    """All but the best, those that predict best first."""
    return sorted((one for one in models if one is not best), key=lambda one: -score_of(one))


def score_of(one: Judged) -> float:
    """Logarithm of the predictive density of all held-out presses."""
    return float(one.forecast.log_scores.sum())


def _doubtful(one: Judged) -> bool:
    return min(one.p_left, one.p_strained) <= RATES.level or bool(implausible(one.fit))


def implausible(fit: Fitted) -> tuple[str, ...]:
    """Coordinates at an end of what a real part can have; 0 is always plausible."""
    found = []
    for coordinate, value in zip(coordinates(fit.candidates), fit.values, strict=True):
        close = 1e-6 * (coordinate.high - coordinate.low)
        for end, plausible in zip((coordinate.low, coordinate.high), coordinate.levels_off, strict=True):
            if end != 0.0 and abs(value - end) <= close and not plausible:
                found.append(f"{coordinate.name.replace('_', ' ')} = {figure(value)}")
    return tuple(found)


def ordinary(fit: Fitted) -> bool:
    """Whether a careful laboratory's rig has as much of all its mechanisms."""
    return all(one.candidate.is_ordinary(one.values) for one in fit.settings)

"""From screened candidates to a short list of fitted models: single mechanisms, and pairs where one is not enough."""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

from diagnose.fit.descent import descent, lowest
from diagnose.fit.linearised_system import LinearisedSystem
from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.refit import Fitted, common_metric, fit_mechanisms
from diagnose.forward import Candidate, NoAnswerError
from diagnose.inference.screening import Screening, least_degrees, screened
from diagnose.inference.sensitivities import sensitivity
from diagnose.statistics.error_rates import MOST_FINALISTS, MOST_PAIRS_PER_FIRST, RATES
from foundation.arrays import Floats
from foundation.progress import Report

STARTS = 3  # of each candidate's first fit
REFINEMENTS = 3  # most full solves of each mechanism of a fit


@dataclass(frozen=True)
class FirstFit:
    """One candidate by its number, fitted with the nuisances linear about a start; cost : half its square."""

    number: int
    values: Floats
    cost: float


def first_fits(model: ObservedModel, found: Screening, report: Report) -> list[FirstFit]:
    """Survivors fitted in one metric, the best of them, MOST_FINALISTS at most, first."""
    common = common_metric(model.samples, found.start)
    firsts = []
    for count, number in enumerate(found.survivors):
        report("first fits", count, len(found.survivors))
        only = (found.candidates[number],)
        best = lowest(descent(model, common, only, ()), found.tests.estimates[number][:STARTS], found.rough)
        if best is not None:
            firsts.append(FirstFit(number, best.values, best.cost))
    return sorted(firsts, key=lambda one: one.cost)[:MOST_FINALISTS]


def singles(model: ObservedModel, found: Screening, firsts: Sequence[FirstFit], report: Report) -> list[Fitted]:
    """First fits continued with all that floats."""
    model.engine.prepare([found.candidates[one.number] for one in firsts], report)
    fits = []
    for count, one in enumerate(firsts):
        report("fits", count, len(firsts))
        fits += _fitted(model, found.start, (found.candidates[one.number],), one.values, found.excess)
    return [fit for fit in refined(model, found.start, fits, found.excess, report) if _is_usable(model, fit)]


def refined(
    model: ObservedModel, start: LinearisedSystem, fits: Sequence[Fitted], excess: float, report: Report
) -> list[Fitted]:
    """Fits made anew by an engine that has solved at their values, until it says there what it said before."""
    fits = list(fits)
    for _ in range(REFINEMENTS):
        changed = model.engine.refine([setting for fit in fits for setting in fit.settings], report)
        if not changed:
            break
        fits = [
            one
            for fit in fits
            for one in (
                _fitted(model, start, fit.candidates, fit.values, excess)
                if any(setting in changed for setting in fit.settings)
                else [fit]
            )
        ]
    return fits


def pairs(model: ObservedModel, found: Screening, first: Fitted, report: Report) -> list[Fitted]:
    """The mechanisms of a fit with each further one that shows in what they leave."""
    if not model.has_answer(first.system.values, first.settings):  # a coupon's answer depends on where it starts
        return []
    names = [one.name for one in first.candidates]
    others = [c for c in found.candidates if c.name not in names]
    each = [sensitivity(model, first.system.values, other, first.settings) for other in others]
    beside = replace(
        first.system,
        nuisance_design=np.column_stack([first.slopes[first.system.informative], first.system.nuisance_design]),
        sigma_of_one=np.concatenate([np.full(first.slopes.shape[1], np.inf), first.system.sigma_of_one]),
    )
    tests = screened(beside, each, least_degrees(model))
    order = np.argsort(-tests.explained)
    shown = [int(n) for n in order if tests.p_values[n] <= RATES.level][:MOST_PAIRS_PER_FIRST]
    model.engine.prepare([others[n] for n in shown], report)
    fits = []
    for count, number in enumerate(shown):
        report("pairs", count, len(shown))
        fits += paired(model, found, first, others[number], tests.estimates[number][:STARTS], report)
    return fits


def paired(
    model: ObservedModel,
    found: Screening,
    first: Fitted,
    second: Candidate,
    starts: Sequence[Floats],
    report: Report,
) -> list[Fitted]:
    """Both together from starts (q,) of the second; none where the model has no answer."""
    if not model.has_answer(first.system.values, first.settings):
        return []
    both = (*first.candidates, second)
    problem = descent(model, first.system, both, first.settings)
    best = lowest(problem, [np.concatenate([first.values, start]) for start in starts], found.rough)
    if best is None:
        return []
    fits = _fitted(model, first.system, both, best.values, found.excess)
    return [one for one in refined(model, first.system, fits, found.excess, report) if _is_usable(model, one)]


def _fitted(
    model: ObservedModel, system: LinearisedSystem, candidates: Sequence[Candidate], start: Floats, excess: float
) -> list[Fitted]:
    """The fit, none where a law that turns over gave an answer once and gives none from another start."""
    with suppress(NoAnswerError):
        return [fit_mechanisms(model, system, candidates, start, excess)]
    return []


def _is_usable(model: ObservedModel, fit: Fitted) -> bool:
    """Whether all mechanisms of a fit are on (with one that is off it is of fewer), and the model answers there."""
    return all(any(setting.values) for setting in fit.settings) and model.has_answer(fit.system.values, fit.settings)

"""From the baseline to a short list of fitted models: screening, single mechanisms, pairs where one is not enough.

Which candidates show in the residual at all: the score test of each, corrected for their number.

How every candidate would change the recording, near its off value and at a finite size.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from diagnose.fit.baseline import believed
from diagnose.fit.descent import LEAST_GAIN, descent, lowest
from diagnose.fit.informative_rows import informative_rows
from diagnose.fit.linearised_system import LinearisedSystem
from diagnose.fit.observed_model import STEP, ObservedModel
from diagnose.fit.refit import Fitted, common_metric, fitted
from diagnose.fit.samples import noise_degrees
from diagnose.forward import Candidate, Coordinate, Setting
from diagnose.inference.forecasts import excess
from diagnose.statistics.error_rates import FINALISTS, PAIRS, RATES
from diagnose.statistics.nuisance_projection import Marginal
from diagnose.statistics.score_test import holm, score_test
from geometry.arrays import Bools, Floats
from geometry.base import Report

FLAT = 0.05  # of the secant: a slope below it is none


@dataclass(frozen=True)
class Sensitivity:
    """columns : (n, q) change per unit of each coordinate, a secant where there is no slope at 0.

    non_negative : (q,) whether 0 is the lower end. sign : (q,) -1 where 0 is the upper end; columns have it already.
    finite : (n, s) change at starts, and coordinates (s, q) there.
    """

    candidate: Candidate
    columns: Floats
    non_negative: Bools
    sign: Floats
    finite: Floats
    places: Floats


def sensitivity(
    model: ObservedModel, values: Floats, candidate: Candidate, others: Sequence[Setting] = ()
) -> Sensitivity:
    """Of one candidate beside others that are on, at nuisances (p,)."""
    without = model.vector(values, others)
    count = len(candidate.coordinates)

    def change(number: int, value: float) -> Floats | None:
        """(n,); None where the model has no answer."""
        at = np.zeros(count)
        at[number] = value
        try:
            return np.asarray(model.vector(values, [*others, Setting(candidate, tuple(at.tolist()))]) - without)
        except ValueError:
            return None

    columns, finite, places = [], [], []
    for number, coordinate in enumerate(candidate.coordinates):
        made = {start: change(number, start) for start in coordinate.starts}
        found = {start: column for start, column in made.items() if column is not None}
        finite += list(found.values())
        places += [np.eye(count)[number] * start for start in found]
        step = STEP * min(coordinate.starts, key=abs)
        first = change(number, step)
        slope = first / step if first is not None else np.zeros(len(without))
        secants = [column / start for start, column in found.items()]
        largest = max(secants, key=lambda secant: float(np.linalg.norm(secant)), default=slope)
        flat = np.linalg.norm(slope) < FLAT * np.linalg.norm(largest)
        columns.append(largest if flat else slope)
    sign = np.array([-1.0 if c.high <= 0.0 else 1.0 for c in candidate.coordinates])
    return Sensitivity(
        candidate,
        np.column_stack(columns) * sign,
        np.array([one_sided(c) for c in candidate.coordinates]),
        sign,
        np.column_stack(finite) if finite else np.zeros((len(without), 0)),
        np.array(places).reshape(-1, count),
    )


def one_sided(coordinate: Coordinate) -> bool:
    """Whether 0 is an end of its range."""
    return coordinate.low >= 0.0 or coordinate.high <= 0.0


@dataclass(frozen=True)
class Screened:
    """p_values : (m,) corrected for the number of candidates. explained : (m,) share of the squares of the residual.

    estimates : first guesses (q,) of each candidate's coordinates, best first.
    """

    p_values: Floats
    explained: Floats
    estimates: tuple[tuple[Floats, ...], ...]


def screened(system: LinearisedSystem, sensitivities: Sequence[Sensitivity], noise_degrees: float) -> Screened:
    """By the score test along the tangent, and along each finite change, whichever shows more (Bonferroni)."""
    marginal = Marginal(system.weighted(system.nuisance_design), system.sigma)
    white = marginal(system.weighted(system.residual))
    p_values, explained, estimates = [], [], []
    for one in sensitivities:
        slopes = marginal(system.weighted(one.columns))
        changes = marginal(system.weighted(one.finite))
        tangent = score_test(white, slopes, one.non_negative, noise_degrees)
        always: Bools = np.array([True])
        finite = [score_test(white, change[:, None], always, noise_degrees) for change in changes.T]
        best = [tangent, *finite]
        p_values.append(min(1.0, len(best) * min(test.p_value for test in best)))
        explained.append(max(test.statistic for test in best) / float(white @ white))
        order = np.argsort([-test.statistic for test in finite], kind="stable")
        scaled = [one.places[n] * min(1.0, float(finite[n].estimate[0])) for n in order]
        guesses = [tangent.estimate * one.sign, *scaled]
        estimates.append(tuple(_clipped(one, guess) for guess in guesses if np.any(guess)))
    return Screened(holm(np.array(p_values)), np.array(explained), tuple(estimates))


def _clipped(one: Sensitivity, guess: Floats) -> Floats:
    low = np.array([c.low for c in one.candidate.coordinates])
    high = np.array([c.high for c in one.candidate.coordinates])
    return np.asarray(np.clip(guess, low + 0.02 * (low < 0) * (high - low), high - 0.02 * (high > 0) * (high - low)))


STARTS = 3  # of each candidate's first fit
REFINEMENTS = 3  # most full solves of each mechanism of a fit
ROUGH = 1e-3  # of the excess: what a last step of a first fit may gain, which only has to tell who is worth a second


@dataclass(frozen=True)
class Screening:
    """baseline : fitted, with its informative rows. start : about what the priors find plausible.

    each, tests : candidates.

    excess : of the baseline.
    """

    candidates: tuple[Candidate, ...]
    baseline: LinearisedSystem
    start: LinearisedSystem
    each: tuple[Sensitivity, ...]
    tests: Screened
    excess: float

    @property
    def rough(self) -> float:
        """Gain of a step that is the last of a first fit."""
        return max(LEAST_GAIN, ROUGH * self.excess)

    @property
    def survivors(self) -> list[int]:
        """Numbers of the candidates that show, those that explain most first."""
        order = np.argsort(-self.tests.explained, kind="stable")
        return [int(n) for n in order if self.tests.p_values[n] <= RATES.level]


def screen(model: ObservedModel, baseline: LinearisedSystem, report: Report) -> Screening:
    """Every candidate of the engine."""
    candidates = model.engine.candidates
    start = believed(model, baseline)
    each = []
    for number, candidate in enumerate(candidates):
        report("screening", number, len(candidates))
        each.append(sensitivity(model, start.values, candidate))
    informative = informative_rows(model.samples, baseline, [*(s.columns for s in each), *(s.finite for s in each)])
    baseline, start = baseline.reached(informative), start.reached(informative)
    tests = screened(start, each, least_degrees(model))
    return Screening(candidates, baseline, start, tuple(each), tests, excess(baseline))


def least_degrees(model: ObservedModel) -> float:
    """Degrees of freedom of the noise that is known worst."""
    return min(noise_degrees(law) for law in model.samples.noise.values())


@dataclass(frozen=True)
class FirstFit:
    """One candidate by its number, fitted with the nuisances linear about a start; cost : half its square."""

    number: int
    values: Floats
    cost: float


def first_fits(model: ObservedModel, found: Screening, report: Report) -> list[FirstFit]:
    """Survivors fitted in one metric, the best of them, FINALISTS at most, first."""
    common = common_metric(model.samples, found.start)
    firsts = []
    for count, number in enumerate(found.survivors):
        report("first fits", count, len(found.survivors))
        only = (found.candidates[number],)
        best = lowest(descent(model, common, only, ()), found.tests.estimates[number][:STARTS], found.rough)
        if best is not None:
            firsts.append(FirstFit(number, best.values, best.cost))
    return sorted(firsts, key=lambda one: one.cost)[:FINALISTS]


def singles(model: ObservedModel, found: Screening, firsts: Sequence[FirstFit], report: Report) -> list[Fitted]:
    """First fits continued with all that floats."""
    fits = []
    for count, one in enumerate(firsts):
        report("fits", count, len(firsts))
        fits.append(fitted(model, found.start, (found.candidates[one.number],), one.values, found.excess))
    return [fit for fit in refined(model, found.start, fits, found.excess, report) if _acts(fit)]


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
            fitted(model, start, fit.candidates, fit.values, excess)
            if any(setting in changed for setting in fit.settings)
            else fit
            for fit in fits
        ]
    return fits


def pairs(
    model: ObservedModel,
    found: Screening,
    first: Fitted,
    same: Sequence[Candidate],
    report: Report,
    level: float = RATES.level,
    least: float = 0.0,
) -> list[Fitted]:
    """The first mechanism with each second one that shows in what it leaves; same : those that act as the first.

    level : p-value of the score test up to which a second one shows. least : share of the squares that it explains.
    """
    names = [one.name for one in (*first.candidates, *same)]
    others = [c for c in found.candidates if c.name not in names]
    each = [sensitivity(model, first.system.values, other, first.settings) for other in others]
    beside = replace(
        first.system,
        nuisance_design=np.column_stack([first.slopes[first.system.informative], first.system.nuisance_design]),
        sigma_of_one=np.concatenate([np.full(first.slopes.shape[1], np.inf), first.system.sigma_of_one]),
    )
    tests = screened(beside, each, least_degrees(model))
    shows = (tests.p_values <= level) & (tests.explained >= least)
    shown = [int(n) for n in np.argsort(-tests.explained) if shows[n]][:PAIRS]
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
    both = (*first.candidates, second)
    problem = descent(model, first.system, both, first.settings)
    best = lowest(problem, [np.concatenate([first.values, start]) for start in starts], found.rough)
    if best is None:
        return []
    fit = fitted(model, first.system, both, best.values, found.excess)
    return [one for one in refined(model, first.system, [fit], found.excess, report) if _acts(one)]


def _acts(fit: Fitted) -> bool:
    """Whether all its mechanisms are on: with one that is off it is a model of fewer."""
    return all(any(setting.values) for setting in fit.settings)

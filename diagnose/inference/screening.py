"""Which candidates show in the residual at all: the score test of each, corrected for their number."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from diagnose.fit.baseline import linearise_at_plausible
from diagnose.fit.descent import LEAST_GAIN
from diagnose.fit.informative_rows import informative_rows
from diagnose.fit.linearised_system import LinearisedSystem
from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.samples import noise_degrees
from diagnose.forward import Candidate
from diagnose.inference.excess import excess
from diagnose.inference.sensitivities import Sensitivity, sensitivity
from diagnose.statistics.error_rates import RATES
from diagnose.statistics.nuisance_projection import Marginal
from diagnose.statistics.score_test import holm_p_values, score_test
from foundation.arrays import Bools, Floats
from foundation.progress import Report


@dataclass(frozen=True)
class Screened:
    """p_values : (m,) corrected for the number of candidates. explained : (m,) share of the squares of the residual.

    estimates : first guesses (q,) of each candidate's coordinates, best first.
    """

    p_values: Floats
    explained: Floats
    estimates: tuple[tuple[Floats, ...], ...]


def screened(system: LinearisedSystem, sensitivities: Sequence[Sensitivity], noise_degrees: float) -> Screened:
    """Screen by the score test along the tangent and each finite change, whichever shows more (Bonferroni)."""
    marginal = Marginal(system.weighted_rows(system.nuisance_design), system.sigma)
    white = marginal(system.weighted_rows(system.residual))
    p_values, explained, estimates = [], [], []
    for one in sensitivities:
        slopes = marginal(system.weighted_rows(one.columns))
        changes = marginal(system.weighted_rows(one.finite))
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
    return Screened(holm_p_values(np.array(p_values)), np.array(explained), tuple(estimates))


def _clipped(one: Sensitivity, guess: Floats) -> Floats:
    low = np.array([c.low for c in one.candidate.coordinates])
    high = np.array([c.high for c in one.candidate.coordinates])
    return np.asarray(np.clip(guess, low + 0.02 * (low < 0) * (high - low), high - 0.02 * (high > 0) * (high - low)))


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
    start = linearise_at_plausible(model, baseline)
    each = []
    for number, candidate in enumerate(candidates):
        report("screening", number, len(candidates))
        each.append(sensitivity(model, start.values, candidate))
    informative = informative_rows(model.samples, baseline, [*(s.columns for s in each), *(s.finite for s in each)])
    baseline, start = baseline.restricted_to(informative), start.restricted_to(informative)
    tests = screened(start, each, least_degrees(model))
    return Screening(candidates, baseline, start, tuple(each), tests, excess(baseline))


def least_degrees(model: ObservedModel) -> float:
    """Degrees of freedom of the noise that is known worst."""
    return min(noise_degrees(law) for law in model.samples.noise.values())

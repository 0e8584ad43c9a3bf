"""Which candidates show in the residual at all: the score test of each, corrected for their number."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from diagnose.inference.sensitivities import Sensitivity
from diagnose.inference.system import System
from diagnose.statistics.holm import holm
from diagnose.statistics.nuisance import Marginal
from diagnose.statistics.score_test import score_test
from mesh.types import Bools, Floats


@dataclass(frozen=True)
class Screened:
    """p_values : (m,) corrected for the number of candidates. explained : (m,) share of the squares of the residual.

    estimates : first guesses (q,) of each candidate's coordinates, best first.
    """

    p_values: Floats
    explained: Floats
    estimates: tuple[tuple[Floats, ...], ...]


def screened(system: System, sensitivities: Sequence[Sensitivity], noise_degrees: float) -> Screened:
    """By the score test along the tangent, and along each finite change, whichever shows more (Bonferroni)."""
    marginal = Marginal(system.weighted(system.excused), system.sigma)
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

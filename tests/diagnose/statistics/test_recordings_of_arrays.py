"""All steps together in a linear world: eight presses, twenty mechanisms, two nuisances; the stated rates are kept."""

from functools import cache

import numpy as np

from diagnose.statistics.abstain import Evidence, decide
from diagnose.statistics.cells import FilterBank, octave_edges_Hz, time_segments
from diagnose.statistics.error_rates import Rates
from diagnose.statistics.family_wise import null_energies, step_down_p_values
from diagnose.statistics.held_out import gain_over_noise
from diagnose.statistics.hypotheses import Hypotheses, membership_with_pools
from diagnose.statistics.impulse_response import doubling_edges, impulse_response_forecast, lagged_means
from diagnose.statistics.nuisance_projection import Marginal
from diagnose.statistics.proportions import rate_for_promise
from diagnose.statistics.score_test import holm_p_values, score_test
from tests.diagnose.statistics.forecasts import linear_forecast, separation_by_press

PRESSES, LENGTH, CANDIDATES = 8, 60, 20
PRESS = np.repeat(np.arange(PRESSES), LENGTH)
TIME = np.linspace(0.0, 1.0, LENGTH)
DEPTH = np.linspace(0.5, 1.5, PRESSES)
DRIVE = np.sin(np.pi * TIME)
NUISANCES, PRIOR = np.column_stack([np.outer(DEPTH, DRIVE).ravel(), np.ones(len(PRESS))]), np.array([5.0, np.inf])
WIDE = 100.0  # prior deviation of every mechanism's parameter
BANK = FilterBank(time_segments({"press": PRESS}, np.full(len(PRESS), TIME[1])), octave_edges_Hz(1.0, TIME[1]))
FAMILY = Hypotheses(
    membership_with_pools(BANK.cells, [{"press"}, {"press", "band_Hz"}]),
    BANK.degrees,
    np.zeros(len(BANK.cells), int),
    np.array([np.inf]),
)
MEMORY = np.concatenate([lagged_means(d * DRIVE, doubling_edges(40)) for d in DEPTH])
RATES = Rates(rate_for_promise(4, 400), margin=0.0, largest_group=3)


def mechanism(power, lag):
    """A smooth answer that grows with a power of the depth."""
    shape = np.maximum(np.sin(np.pi * np.clip(TIME - lag, 0.0, None) / (1.0 - lag)), 0.0) ** 2
    return np.outer(DEPTH**power, shape).ravel()


SENSITIVITIES = [mechanism(power, lag) for power in (0.0, 1.0, 2.0, 3.0) for lag in (0.0, 0.15, 0.3, 0.45, 0.6)]
UNKNOWN = np.outer(DEPTH, np.sign(np.sin(5.0 * np.pi * TIME))).ravel()
MARGINAL = Marginal(NUISANCES, PRIOR)


@cache
def null_scores(candidate):
    """Null scores, with the parameter of a candidate refitted too (None: nuisances alone), and the marginal map."""
    columns, sigma = columns_of(candidate, np.inf)
    marginal, rng = Marginal(columns, sigma), np.random.default_rng(0)
    return marginal, FAMILY.scores(null_energies(FAMILY, BANK.cell, BANK.coefficients(marginal.free), 1999, rng))


def columns_of(candidate, sigma=WIDE):
    if candidate is None:
        return NUISANCES, PRIOR
    return np.column_stack([NUISANCES, SENSITIVITIES[candidate]]), np.append(PRIOR, sigma)


def p_of_residual(residual, candidate):
    marginal, null = null_scores(candidate)
    return step_down_p_values(FAMILY.scores(BANK.energies(marginal(residual))), null).min()


def diagnosed(residual):
    """(decision, candidate)"""
    p_mismatch = p_of_residual(residual, None)
    if p_mismatch > RATES.level:
        return decide(Evidence(p_mismatch, 1.0, 1.0, 0.0, 0.0, (), 1), RATES), None
    white = MARGINAL(residual)
    p_values = [score_test(white, MARGINAL(s[:, None]), np.array([True])).p_value for s in SENSITIVITIES]
    survivors = np.flatnonzero(holm_p_values(np.array(p_values)) <= RATES.level)
    if len(survivors) == 0:
        return decide(Evidence(p_mismatch, 0.0, 1.0, -1.0, 0.0, (), 1), RATES), None
    forecasts = {int(c): linear_forecast(residual, *columns_of(c), PRESS) for c in survivors}
    best = max(forecasts, key=lambda c: forecasts[c].log_scores.sum())
    baseline = linear_forecast(residual, *columns_of(None), PRESS)
    box = impulse_response_forecast(residual, NUISANCES, PRIOR, MEMORY, PRESS)
    gain, box_gain = gained(forecasts[best], baseline), gained(box, forecasts[best])
    left = p_of_residual(residual, best)
    return decide(Evidence(p_mismatch, left, 1.0, gain.lower, box_gain.lower, (), 1), RATES), best


def gained(model, rival):
    separation = separation_by_press(model.predictions, rival.predictions, PRESS)
    return gain_over_noise(model.log_scores - rival.log_scores, separation, RATES.level, CANDIDATES)


def trials(count, effect, seed):
    rng = np.random.default_rng(seed)
    for _ in range(count):
        nuisances = NUISANCES @ np.array([rng.normal(0.0, 5.0), rng.uniform(-20.0, 20.0)])
        yield diagnosed(rng.standard_normal(len(PRESS)) + nuisances + effect)


def test_no_effect_is_named_in_at_most_four_of_four_hundred():
    assert sum(decision.named for decision, _ in trials(400, 0.0, 121)) <= 4


def test_a_known_effect_is_named():
    named = [best if decision.named else None for decision, best in trials(12, 3.0 * SENSITIVITIES[12], 122)]
    assert named.count(12) >= 11


def test_an_unknown_effect_is_left_unexplained():
    decisions = [decision for decision, _ in trials(12, UNKNOWN, 123)]
    assert sum(d.unexplained for d in decisions) >= 11
    assert sum(d.named for d in decisions) <= 1

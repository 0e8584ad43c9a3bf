"""The maximum over all cells keeps its level: overlapping cells, refitted nuisances, an estimated noise variance."""

import numpy as np
import pytest
from scipy.sparse import eye_array
from scipy.stats import chi2, kstest

from diagnose.statistics.cells import FilterBank, octave_edges_Hz, time_segments
from diagnose.statistics.family_wise import null_energies, step_down_p_values
from diagnose.statistics.hypotheses import Hypotheses, membership_with_pools
from diagnose.statistics.nuisance_projection import Marginal
from tests.diagnose.statistics.rejections import is_fair

COUNT, LEVEL, TRIALS = 400, 0.05, 400
PHASE = np.repeat(np.arange(5), 80)
BANK = FilterBank(time_segments({"phase": PHASE}, np.full(COUNT, 0.01)), octave_edges_Hz(0.8, 0.01))
TIME = np.linspace(0.0, 1.0, COUNT)
TANGENT = np.column_stack([np.ones(COUNT), TIME, np.exp(-8.0 * TIME)])


def hypotheses(noise_degrees=np.inf):
    """Every cell, and the sums over all phases of each band: these share cells, so their scores are correlated."""
    members, noise = membership_with_pools(BANK.cells, [{"phase"}]), np.zeros(len(BANK.cells), int)
    return Hypotheses(members, BANK.degrees, noise, np.array([noise_degrees]))


def null_of(family, marginal, seed):
    rng = np.random.default_rng(seed)
    return family.scores(null_energies(family, BANK.cell, BANK.coefficients(marginal.free), 1999, rng))


def rejections(family, null, marginal, noise_degrees=None):
    """Rejections in TRIALS data sets of noise, each with whatever nuisances and its own estimate of the variance."""
    rng, count = np.random.default_rng(5), 0
    for _ in range(TRIALS):
        nuisances = TANGENT @ rng.normal(0.0, 50.0, TANGENT.shape[1])
        residual = rng.standard_normal(COUNT) + nuisances
        if noise_degrees is not None:
            residual /= np.sqrt(rng.chisquare(noise_degrees) / noise_degrees)
        count += step_down_p_values(family.scores(BANK.energies(marginal(residual))), null).min() <= LEVEL
    return count


def test_family_wise_level_with_correlated_cells_and_free_nuisances():
    marginal, family = Marginal(TANGENT, np.full(3, np.inf)), hypotheses()
    assert is_fair(rejections(family, null_of(family, marginal, 1), marginal), TRIALS, LEVEL)


def test_family_wise_level_when_the_noise_variance_is_estimated():
    marginal, family = Marginal(TANGENT, np.full(3, np.inf)), hypotheses(60.0)
    assert is_fair(rejections(family, null_of(family, marginal, 2), marginal, 60.0), TRIALS, LEVEL)


def test_taking_an_estimated_variance_for_known_breaks_the_level():
    marginal, family = Marginal(TANGENT, np.full(3, np.inf)), hypotheses()
    count = rejections(family, null_of(family, marginal, 3), marginal, 60.0)
    assert count > TRIALS * LEVEL
    assert not is_fair(count, TRIALS, LEVEL)


def test_draws_without_samples_have_the_law_of_projected_noise():
    """Energies in each cell against brute-force projection of white noise, two-sample Kolmogorov-Smirnov."""
    marginal, family = Marginal(TANGENT, np.full(3, np.inf)), hypotheses()
    rng = np.random.default_rng(6)
    drawn = null_energies(family, BANK.cell, BANK.coefficients(marginal.free), 1500, rng)
    brute = np.array([BANK.energies(marginal(rng.standard_normal(COUNT))) for _ in range(1500)])
    p_values = [kstest(a, b).pvalue for a, b in zip(drawn.T, brute.T, strict=True)]
    assert min(p_values) > 1e-3 / len(p_values)
    assert kstest(drawn.sum(axis=1), chi2(COUNT - 3).cdf).pvalue > 1e-3


def test_an_effect_in_one_phase_and_band_is_found_there_alone():
    marginal, family = Marginal(TANGENT, np.full(3, np.inf)), hypotheses()
    null = null_of(family, marginal, 7)
    rng = np.random.default_rng(8)
    effect = np.where(PHASE == 3, 1.5 * np.cos(2.0 * np.pi * 9.0 * 0.01 * np.arange(COUNT)), 0.0)
    own = [n for n, c in enumerate(BANK.cells) if c.labels["phase"] == 3 and c.band_Hz[0] <= 9.0 < c.band_Hz[1]]
    found, elsewhere = 0, 0
    for _ in range(100):
        adjusted = step_down_p_values(family.scores(BANK.energies(marginal(rng.standard_normal(COUNT) + effect))), null)
        found += adjusted[own[0]] <= LEVEL
        quiet = [n for n, c in enumerate(BANK.cells) if c.labels["phase"] not in (3,)]
        elsewhere += adjusted[quiet].min() <= LEVEL
    assert found >= 95
    assert elsewhere <= 15


def test_step_down_finds_more_than_the_single_step_and_keeps_the_order():
    null = np.random.default_rng(10).standard_normal((4000, 6))
    observed = np.array([5.0, 2.5, 2.2, -1.0, 0.3, 0.0])
    adjusted = step_down_p_values(observed, null)
    single = (1 + (null.max(axis=1)[:, None] >= observed).sum(axis=0)) / 4001
    assert adjusted[0] == single[0] == pytest.approx(1 / 4001)
    assert np.all(adjusted <= single)
    assert adjusted[2] < single[2]
    assert np.all(np.diff(adjusted[np.argsort(observed)]) <= 0.0)


def test_scores_are_nearly_standard_normal_whatever_the_degrees():
    rng = np.random.default_rng(12)
    for degrees in (4.0, 30.0, 500.0):
        family = Hypotheses(eye_array(1), np.array([degrees]), np.zeros(1, int), np.array([80.0]))
        scale = rng.chisquare(80.0, 20_000) / 80.0
        scores = family.scores((rng.chisquare(degrees, 20_000) / scale)[:, None])
        assert np.mean(scores) == pytest.approx(0.0, abs=0.05)
        assert np.mean(scores > 1.645) == pytest.approx(0.05, abs=0.01)

"""Scores of hypotheses against dense normal densities, and what must hold for any recording."""

from dataclasses import replace
from functools import cache
from itertools import product

import numpy as np
import pytest
from scipy.special import logsumexp
from scipy.stats import multivariate_normal

from diagnose.fit.baseline import fit_baseline
from diagnose.fit.linearised_system import linearise
from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.rig_discrepancy import RigDiscrepancy, played
from diagnose.fit.samples import Samples
from diagnose.inference import held_out_scores
from diagnose.inference.held_out_scores import SIZES, HeldOutScorer, LinearHypothesis
from diagnose.noise.estimate import noise_models
from tests.diagnose.inference.toy import Sensor, ToyEngine, small


@cache
def observed():
    recording = small(5, Sensor(), runs=3, rate=20.0, noise=0.02)
    model = ObservedModel(Samples(recording, noise_models(recording)), ToyEngine(recording))
    return model, fit_baseline(model)


@cache
def discrepancy():
    model, baseline = observed()
    return RigDiscrepancy(model, baseline.values)


def hypothesis(columns, sigma):
    model, baseline = observed()
    system = replace(linearise(model, baseline.values), informative=np.arange(len(model.samples)) % 3 == 0)
    none = np.zeros(len(sigma), dtype=bool)
    return LinearHypothesis(system, system.residual, columns, sigma, none, none)


def test_scores_are_those_of_the_dense_normal_density(monkeypatch):
    """Summed over a grid of sizes under their priors; each group of conditions given all others."""
    monkeypatch.setattr(held_out_scores, "SIZES", SIZES[2:4])
    monkeypatch.setattr(held_out_scores, "NEGLIGIBLE_NATS", np.inf)
    model, _ = observed()
    found, rng = discrepancy(), np.random.default_rng(3)
    columns, sigma = rng.standard_normal((len(model.samples), 2)), np.array([0.7, 2.0])
    one = hypothesis(columns, sigma)
    scorer = HeldOutScorer(model, found, model.samples.run)
    rows = one.system.informative
    usual = (held_out_scores.USUAL_SHAPE,) * 2 + (held_out_scores.USUAL_ROUGH,) * 2

    def log_density(kept):
        each = []
        for sizes in product(SIZES[2:4], repeat=4):
            shape, rest = np.array(sizes[:2]), np.array(sizes[2:])
            scale = np.where(found.quantity < 0, 1.0, shape[np.maximum(found.quantity, 0)])
            all_columns = np.hstack([columns * sigma, found.columns * scale])[kept]
            variance = one.system.variance[kept] + rest[found.kind[kept]] ** 2 * found.rough[kept]
            covariance = all_columns @ all_columns.T + np.diag(variance)
            prior = sum(np.log(s / u) - np.log1p((s / u) ** 2) for s, u in zip(sizes, usual, strict=True))
            each.append(multivariate_normal(cov=covariance).logpdf(one.residual[kept]) + prior)
        return logsumexp(each)

    expected = [log_density(rows) - log_density(rows & (scorer.fold != fold)) for fold in range(scorer.folds)]
    assert scorer.scored(one).log_scores == pytest.approx(expected, abs=1e-6)


def test_noise_alone_leaves_no_error():
    """Squares above noise have the mean 0 and the stated scatter."""
    found, rng = discrepancy(), np.random.default_rng(4)
    place = np.zeros(len(found.rough), dtype=np.int64)
    sums = [found.relative_squares(rng.standard_normal(len(place))).sum() for _ in range(400)]
    sigma = float(found.noise_errors(place)[0])
    assert abs(np.mean(sums)) < 4.0 * sigma / np.sqrt(400)
    assert np.std(sums) == pytest.approx(sigma, rel=0.15)


def test_an_error_of_five_per_cent_is_told_as_such():
    model, baseline = observed()
    shown = model.signals(baseline.values)
    off = model.samples.coefficients([{name: 0.05 * values for name, values in run.items()} for run in shown])
    noise = np.random.default_rng(5).standard_normal(len(off))
    assert discrepancy().errors(off + noise) == pytest.approx(0.05, rel=0.2)


def test_the_order_of_conditions_changes_no_score():
    model, _ = observed()
    one = hypothesis(np.ones((len(model.samples), 1)), np.ones(1))
    labels = model.samples.run
    first = HeldOutScorer(model, discrepancy(), labels).scored(one)
    other = HeldOutScorer(model, discrepancy(), labels.max() - labels).scored(one)
    assert first.log_scores == pytest.approx(other.log_scores[::-1])
    np.testing.assert_allclose(first.missed, other.missed)


def test_a_play_forgets_how_fast_it_went():
    """It depends on the turning points alone, and stays within its threshold."""
    path = np.sin(np.linspace(0.0, 9.0, 400)) * np.linspace(1.0, 0.3, 400)
    slow = np.interp(np.linspace(0.0, 399.0, 1197), np.arange(400.0), path)
    assert played(path, 0.2)[-1] == pytest.approx(played(slow, 0.2)[-1], abs=1e-3)
    assert np.abs(played(path, 0.2) - path).max() <= 0.2 + 1e-12
    np.testing.assert_allclose(played(path, 0.0), path)

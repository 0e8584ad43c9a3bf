"""Scores of hypotheses against dense normal densities, and what must hold for any recording."""

from copy import copy
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
from diagnose.inference.conditions import Conditions, within_reach
from diagnose.inference.held_out_scores import SIZES, HeldOutScorer, LinearHypothesis, RandomRest
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


def conditions(labels):
    return Conditions(labels, np.ones(labels.max() + 1, dtype=bool))


def hypothesis(columns, sigma):
    model, baseline = observed()
    system = replace(linearise(model, baseline.values), informative=np.arange(len(model.samples)) % 3 == 0)
    none = np.zeros(len(sigma), dtype=bool)
    return LinearHypothesis(system, system.residual, columns, sigma, none, none)


def test_scores_are_those_of_the_dense_normal_density(monkeypatch):
    """Summed over a grid of sizes under their priors; each group of conditions given all others."""
    rests = (RandomRest(SIZES[2], 1), RandomRest(SIZES[3], 1))
    monkeypatch.setattr(held_out_scores, "SMOOTH_SIZES", SIZES[2:4])
    monkeypatch.setattr(held_out_scores, "RESTS", rests)
    monkeypatch.setattr(held_out_scores, "NEGLIGIBLE_NATS", np.inf)
    model, _ = observed()
    found, rng = discrepancy(), np.random.default_rng(3)
    columns, sigma = rng.standard_normal((len(model.samples), 2)), np.array([0.7, 2.0])
    one = hypothesis(columns, sigma)
    scorer = HeldOutScorer(found, conditions(model.samples.run))
    rows = one.system.informative
    usual = (held_out_scores.USUAL_SHAPE,) * 2 + (held_out_scores.USUAL_ROUGH,) * 2

    def log_density(kept):
        each = []
        for sizes in product(SIZES[2:4], repeat=4):
            shape, rest = np.array(sizes[:2]), np.array(sizes[2:])
            scale = np.where(found.quantity < 0, 1.0, shape[np.maximum(found.quantity, 0)])
            all_columns = np.hstack([columns * sigma, found.columns * scale])[kept]
            variance = one.system.variance[kept] + rest[found.kind[kept]] ** 2 * found.rough[1, kept]
            covariance = all_columns @ all_columns.T + np.diag(variance)
            prior = sum(np.log(s / u) - np.log1p((s / u) ** 2) for s, u in zip(sizes, usual, strict=True))
            each.append(multivariate_normal(cov=covariance).logpdf(one.residual[kept]) + prior)
        return logsumexp(each)

    expected = [log_density(rows) - log_density(rows & (scorer.fold != fold)) for fold in range(scorer.folds)]
    assert scorer.scored(one).log_scores == pytest.approx(expected, abs=1e-6)


def test_noise_alone_leaves_no_error():
    """Squares above noise have the mean 0 and the stated scatter."""
    errors, rng = discrepancy().errors, np.random.default_rng(4)
    sums = [errors.above_noise(rng.standard_normal(len(errors.noise))).sum() for _ in range(400)]
    assert abs(np.mean(sums)) < 4.0 * np.linalg.norm(errors.noise_sigma) / np.sqrt(400)
    assert np.std(sums) == pytest.approx(np.linalg.norm(errors.noise_sigma), rel=0.15)


def test_an_error_of_five_per_cent_is_told_as_such():
    """Of all conditions, and of those that are counted alone."""
    model, baseline = observed()
    shown = model.signals(baseline.values)
    off = model.samples.coefficients([{name: 0.05 * values for name, values in run.items()} for run in shown])
    noise = np.random.default_rng(5).standard_normal(len(off))
    for counted in (model.samples.run >= 0, model.samples.run > 0):
        errors = replace(discrepancy().errors, counted=counted)
        assert errors.largest(errors.above_noise(off + noise)) == pytest.approx(0.05, rel=0.2)


def test_the_order_of_conditions_changes_no_score():
    model, _ = observed()
    one = hypothesis(np.ones((len(model.samples), 1)), np.ones(1))
    labels = model.samples.run
    first = HeldOutScorer(discrepancy(), conditions(labels)).scored(one)
    other = HeldOutScorer(discrepancy(), conditions(labels.max() - labels)).scored(one)
    assert first.log_scores == pytest.approx(other.log_scores[::-1])
    np.testing.assert_allclose(first.missed, other.missed)


def test_a_play_forgets_how_fast_it_went():
    """It depends on the turning points alone, and stays within its threshold."""
    path = np.sin(np.linspace(0.0, 9.0, 400)) * np.linspace(1.0, 0.3, 400)
    slow = np.interp(np.linspace(0.0, 399.0, 1197), np.arange(400.0), path)
    assert played(path, 0.2)[-1] == pytest.approx(played(slow, 0.2)[-1], abs=1e-3)
    assert np.abs(played(path, 0.2) - path).max() <= 0.2 + 1e-12
    np.testing.assert_allclose(played(path, 0.0), path)


def test_what_goes_farther_than_all_others_is_not_judged():
    """Whatever the order of the runs, and whether or not another run goes as far."""
    model, _ = observed()
    samples = model.samples

    def judged(sizes):
        runs = [
            replace(run, channels={**run.channels, run.drive: size * run.drive_values})
            for run, size in zip(samples.recording.runs, sizes, strict=True)
        ]
        other = copy(samples)
        other.recording = replace(samples.recording, runs=tuple(runs))
        return within_reach(other, samples.run).tolist()

    assert judged((1.0, 2.0, 1.1)) == [True, False, True]
    assert judged((2.0, 1.1, 1.0)) == [False, True, True]
    assert judged((2.0, 1.1, 2.0)) == [True, True, True]

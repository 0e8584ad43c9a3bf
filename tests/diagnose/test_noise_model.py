"""Whitening and likelihood of the noise model against dense linear algebra and statistics."""

import numpy as np
import pytest
from scipy.linalg import toeplitz
from scipy.stats import chi2, multivariate_normal

from diagnose.noise.autoregression import Autoregression
from diagnose.noise.mains_lines import Line, find_lines, line_basis
from diagnose.noise.model import NoiseModel
from diagnose.noise.quantisation import quantisation_step
from tests.cases import for_each

AR = Autoregression(np.array([1.2, -0.5, 0.1]), 0.04)
HUM = Line(50.0, 0.7)
PLAIN = NoiseModel(AR, 1e-3, "rest", 1000)
HUMMING = NoiseModel(AR, 1e-3, "rest", 1000, (HUM, Line(150.0, 0.2)))
GAPS = {"none": [], "first": [0], "scattered": [0, 3, 5, 7, 20], "blocks": [*range(10, 18), *range(40, 42)]}


def dense(model, count):
    """Covariance (n, n) of even samples, by its definition."""
    columns = line_basis(model.lines, model.step_s * np.arange(count))
    return toeplitz(model.autoregression.autocovariance(count)) + columns @ columns.T


@for_each("missing", GAPS.values(), ids=GAPS.keys())
@for_each("model", [PLAIN, HUMMING], ids=["plain", "humming"])
def test_log_density_is_the_normal_density_of_the_samples_that_are_there(model, missing):
    residual = model.draw(np.random.default_rng(3), 60)
    residual[missing] = np.nan
    there = np.isfinite(residual)
    reference = multivariate_normal(cov=dense(model, 60)[np.ix_(there, there)]).logpdf(residual[there])
    assert model.log_density(residual) == pytest.approx(reference, rel=1e-9)


@for_each("missing", GAPS.values(), ids=GAPS.keys())
def test_whitening_is_a_root_of_the_inverse_covariance(missing):
    there = np.ones(60, dtype=bool)
    there[missing] = False
    root = HUMMING.whitening(there)(np.eye(60))
    assert root @ dense(HUMMING, 60) @ root.T == pytest.approx(np.eye(there.sum()), abs=1e-9)


def test_whitened_noise_has_unit_variance_and_no_memory():
    white = PLAIN.whiten(PLAIN.draw(np.random.default_rng(4), 20_000))
    low, high = chi2.ppf([1e-4, 1.0 - 1e-4], len(white))
    assert low < white @ white < high
    correlation = [float(white[k:] @ white[:-k]) / len(white) for k in range(1, 21)]
    assert len(white) * np.sum(np.square(correlation)) < chi2.ppf(1.0 - 1e-4, 20)  # Box and Pierce 1970


def test_white_noise_is_divided_by_its_deviation():
    white = NoiseModel(Autoregression(np.zeros(0), 0.25), 1.0, "stated", 0)
    assert white.whiten(np.array([1.0, np.nan, -2.0])) == pytest.approx([2.0, -4.0])


def test_a_gap_in_time_starts_anew():
    time = np.concatenate([np.arange(30), 500 + np.arange(30)]) * 1e-3
    residual = PLAIN.draw(np.random.default_rng(5), 60, time)
    apart = PLAIN.log_density(residual[:30]) + PLAIN.log_density(residual[30:])
    assert PLAIN.log_density(residual, time) == pytest.approx(apart, rel=1e-12)


def test_samples_at_another_rate_keep_their_power():
    time = 0.01 * np.arange(50)
    power = AR.autocovariance(1)[0]
    residual = np.random.default_rng(6).standard_normal(50)
    assert PLAIN.whiten(residual, time) == pytest.approx(residual / np.sqrt(power))


def test_draws_have_the_covariance_of_the_model():
    rng, trials = np.random.default_rng(7), 2000
    draws = np.array([HUMMING.draw(rng, 6) for _ in range(trials)])
    expected = dense(HUMMING, 6)
    error = np.sqrt((expected**2 + np.outer(expected.diagonal(), expected.diagonal())) / trials)
    assert (np.abs(draws.T @ draws / trials - expected) < 4.5 * error).all()


def test_hum_is_found_at_the_frequency_of_the_mains():
    time = 1e-3 * np.arange(4000)
    rng = np.random.default_rng(8)
    hum = 0.7 * np.sin(2 * np.pi * 50.07 * time + 1.0) + 0.3 * np.cos(2 * np.pi * 150.21 * time)
    lines = find_lines([time], [PLAIN.draw(rng, 4000) + hum], 1e-3)
    assert [line.frequency_Hz for line in lines] == pytest.approx([50.07, 150.21], abs=0.01)
    assert [line.amplitude for line in lines] == pytest.approx([0.7, 0.3], abs=0.05)


def test_coloured_noise_alone_has_no_hum():
    time = 1e-3 * np.arange(4000)
    rng = np.random.default_rng(9)
    assert [find_lines([time], [PLAIN.draw(rng, 4000)], 1e-3) for _ in range(8)] == [()] * 8


def test_the_step_of_a_converter_is_seen():
    values = np.random.default_rng(10).standard_normal(2000)
    assert quantisation_step(np.round(values / 62.4e-6) * 62.4e-6) == pytest.approx(62.4e-6)
    assert quantisation_step(values) is None

"""Schwarz's criterion and probabilities of models."""

import numpy as np
import pytest

from diagnose.statistics.linear_gaussian import Sums
from diagnose.statistics.model_criteria import bic, held_out_probabilities


def test_the_formula():
    assert bic(-120.0, 3, 1000) == pytest.approx(3.0 * np.log(1000.0) + 240.0)


def test_it_approaches_the_exact_evidence_of_a_unit_information_prior():
    """-2 log evidence of a linear model whose prior holds as much as one sample (Kass and Wasserman 1995)."""
    rng = np.random.default_rng(71)
    columns, _ = np.linalg.qr(rng.standard_normal((2000, 2)))
    columns *= np.sqrt(2000.0)
    residual = rng.standard_normal(2000)
    fit, *_ = np.linalg.lstsq(columns, residual)
    log_likelihood = Sums.from_columns(np.zeros((2000, 0)), residual - columns @ fit).log_evidence(np.zeros(0))
    exact = Sums.from_columns(columns, residual).log_evidence(np.ones(2))
    assert bic(log_likelihood, 2, 2000) == pytest.approx(-2.0 * exact, abs=0.02)


def test_one_lucky_press_does_not_decide():
    """The same total gain: even over presses it is nearly certain, from one press alone it is not."""
    even, lucky = np.full(10, 1.5), np.zeros(10)
    lucky[0] = 15.0
    sure = held_out_probabilities(np.array([even, np.zeros(10)]), np.random.default_rng(72))
    unsure = held_out_probabilities(np.array([lucky, np.zeros(10)]), np.random.default_rng(72))
    assert sure[0] > 0.999
    assert 0.8 < unsure[0] < 0.99
    assert unsure.sum() == pytest.approx(1.0)

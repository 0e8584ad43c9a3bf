"""Proportions, and promises about counts."""

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.stats import binom

from diagnose.statistics.proportions import rate_for_promise, wilson_interval
from tests.cases import for_each


def test_the_ends_solve_the_score_equation():
    """(share - p)^2 = z^2 p (1 - p) / n."""
    for end in wilson_interval(7, 50):
        assert (0.14 - end) ** 2 == pytest.approx(1.959964**2 * end * (1.0 - end) / 50, rel=1e-6)


def test_four_false_names_in_four_hundred_are_at_most_2_6_percent():
    assert wilson_interval(4, 400)[1] == pytest.approx(0.0254, abs=1e-4)
    assert wilson_interval(0, 400)[0] == pytest.approx(0.0, abs=1e-15)


def test_it_covers_a_rare_proportion_on_average():
    """Mean of the exact coverage over proportions (Agresti and Coull 1998: close to the stated level)."""
    counts = np.arange(101)
    ends = np.array([wilson_interval(int(k), 100) for k in counts])
    shares = np.linspace(0.02, 0.5, 60)
    covers = [binom.pmf(counts, 100, p)[(ends[:, 0] <= p) & (p <= ends[:, 1])].sum() for p in shares]
    assert 0.94 < np.mean(covers) < 0.96


def test_the_promised_rate_keeps_the_promise_and_no_more():
    rate = rate_for_promise(4, 400, 0.99)
    assert rate == pytest.approx(brentq(lambda p: binom.cdf(4, 400, p) - 0.99, 1e-6, 0.5), rel=1e-6)


@for_each(("successes", "trials"), [(5, 4), (-1, 4), (0, 0)])
def test_what_is_no_proportion_is_refused(successes, trials):
    with pytest.raises(ValueError, match="must"):
        wilson_interval(successes, trials)

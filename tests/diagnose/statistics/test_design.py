"""Which press tells the rivals apart."""

import numpy as np
import pytest
from scipy.optimize import minimize

from diagnose.statistics.separation import best_press, chance_of_right_choice, expected_separation, remaining_spread
from tests.diagnose.statistics.rejections import is_fair

RNG = np.random.default_rng(111)
TANGENT, DIFFERENCE = RNG.standard_normal((40, 2)), RNG.standard_normal(40)
INFORMATION = np.array([[3.0, 1.0], [1.0, 2.0]])


def test_it_is_the_least_distance_that_freed_parameters_leave():
    """min over x of |d - T x|^2 + x' I x, x weighed by what earlier presses know."""
    best = minimize(lambda x: np.sum((DIFFERENCE - TANGENT @ x) ** 2) + x @ INFORMATION @ x, np.zeros(2)).fun
    found = expected_separation(DIFFERENCE, TANGENT, remaining_spread(INFORMATION))
    assert found == pytest.approx(np.sqrt(best), rel=1e-6)


def test_known_parameters_leave_the_plain_distance_and_free_ones_the_rest():
    plain = np.linalg.norm(DIFFERENCE)
    assert expected_separation(DIFFERENCE, TANGENT, remaining_spread(1e12 * INFORMATION)) == pytest.approx(plain)
    imitated = TANGENT @ np.array([1.0, -2.0])
    assert expected_separation(imitated, TANGENT, remaining_spread(1e-12 * INFORMATION)) < 1e-4


def test_the_root_is_of_the_inverse_information():
    root = remaining_spread(INFORMATION)
    np.testing.assert_allclose(root @ root.T, np.linalg.inv(INFORMATION), atol=1e-14)


def test_the_least_separated_pair_decides():
    assert best_press(np.array([[9.0, 0.1, 9.0], [2.0, 3.0, 2.5], [2.0, 9.0, 2.5]])) == 2


def test_the_chance_of_the_right_choice_is_met():
    noise = np.random.default_rng(112).standard_normal((400, 40))
    difference = 1.5 * DIFFERENCE / np.linalg.norm(DIFFERENCE)
    right = np.linalg.norm(noise, axis=1) < np.linalg.norm(noise - difference, axis=1)
    assert is_fair(int(right.sum()), 400, chance_of_right_choice(1.5))

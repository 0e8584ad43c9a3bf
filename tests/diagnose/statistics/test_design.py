"""Which press tells the rivals apart."""

import numpy as np

from diagnose.statistics.best_press import best_press, covariance_root, linked_groups

RNG = np.random.default_rng(111)
TANGENT, DIFFERENCE = RNG.standard_normal((40, 2)), RNG.standard_normal(40)
INFORMATION = np.array([[3.0, 1.0], [1.0, 2.0]])


def test_the_root_is_of_the_inverse_information():
    root = covariance_root(INFORMATION)
    np.testing.assert_allclose(root @ root.T, np.linalg.inv(INFORMATION), atol=1e-14)


def test_the_least_separated_pair_decides():
    assert best_press(np.array([[9.0, 0.1, 9.0], [2.0, 3.0, 2.5], [2.0, 9.0, 2.5]]), 10.0) == 2


def test_a_press_that_settles_more_pairs_comes_first():
    assert best_press(np.array([[3.0, 3.0, 3.0], [0.1, 9.0, 5.0]]), 3.3) == 1


def test_rivals_that_no_press_parts_are_linked_through_others():
    """Of four, 0 and 1 are alike and 1 and 3; pairs are 01, 02, 03, 12, 13, 23."""
    assert linked_groups(4, np.array([True, False, False, False, True, False])) == ((0, 1, 3),)
    assert linked_groups(3, np.zeros(3, dtype=bool)) == ()

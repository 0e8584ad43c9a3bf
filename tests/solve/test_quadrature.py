"""The rules integrate every monomial up to their degree exactly."""

from math import factorial

import numpy as np
import pytest

from solve.fem.quadrature import tetrahedron, triangle
from solve.terms.contact import HATS, POINTS, WEIGHTS
from tests.cases import for_each


def monomials(dimension: int, degree: int):
    grid = np.indices(dimension * (degree + 1,)).reshape(dimension, -1).T
    return [tuple(powers) for powers in grid if powers.sum() <= degree]


def exact(powers) -> float:
    """int x^a y^b z^c over the reference simplex = a! b! c! / (a + b + c + d)!."""
    return np.prod([factorial(p) for p in powers]) / factorial(sum(powers) + len(powers))


@for_each("degree", [3, 5])
def test_tetrahedron(degree):
    points, weights = tetrahedron(degree)
    assert (weights > 0).all()
    for powers in monomials(3, degree):
        assert weights @ np.prod(points**powers, axis=1) == pytest.approx(exact(powers), abs=1e-15)


@for_each("rule", [triangle(), (POINTS, WEIGHTS)], ids=["triangle", "four quarters"])
def test_triangle(rule):
    points, weights = rule
    for powers in monomials(2, 4):
        assert weights @ np.prod(points**powers, axis=1) == pytest.approx(exact(powers), abs=1e-15)


def test_hat_functions_of_the_quarters_share_the_facet():
    """They sum to one; a corner hat covers a quarter's third, a mid-side hat three of them."""
    np.testing.assert_allclose(HATS.sum(axis=1), 1.0)
    np.testing.assert_allclose(WEIGHTS @ HATS, np.array([1, 1, 1, 3, 3, 3]) / 24.0)

"""Weights of presses between the values at which the 3D model was pressed."""

import numpy as np
import pytest

from diagnose.engines.segment.interpolation import Differences, pressed_effect
from diagnose.forward import Candidate, Coordinate
from tests.cases import for_each

X = Coordinate("x", 0.0, 1.0, (0.1,), (0.3, 1.0))
Y = Coordinate("y", -1.0, 1.0, (0.1,), (-1.0, 0.5, 1.0))
FREE = Coordinate("free", -1.0, 1.0, (0.1,))
LAYOUTS = ("sum", "jointly", "fading", "glue")


@for_each("together", LAYOUTS)
def test_a_press_stands_for_itself_and_nothing_for_off(together):
    second = X if together == "glue" else Y
    known = pressed_effect(together, (X, second, FREE))
    for number, point in enumerate(known.points):
        np.testing.assert_allclose(known.weights(point), np.eye(len(known.points))[number], atol=1e-9)
    np.testing.assert_allclose(known.weights((0.0, 0.0, 0.7)), 0.0, atol=1e-12)


def test_changes_of_one_coordinate_are_exact_up_to_the_degree_that_its_nodes_allow():
    known = pressed_effect("sum", (Y,))
    cubic = [x + 0.5 * x**2 - x**3 for (x,) in known.points]
    assert known.weights((0.2,)) @ cubic == pytest.approx(0.2 + 0.5 * 0.04 - 0.008)


def test_coordinates_that_act_on_the_same_thing_share_a_product():
    known = pressed_effect("jointly", (X, Y))
    values = [2.0 * x - y + 3.0 * x * y for x, y in known.points]
    assert known.weights((0.4, 0.6)) @ values == pytest.approx(0.8 - 0.6 + 0.72)


def test_compliances_of_a_glue_add_up():
    known = pressed_effect("glue", (X, X))
    values = [x**2 + 3.0 * y for x, y in known.points]
    assert known.weights((0.5, 0.8)) @ values == pytest.approx(0.25 + 2.4)


def test_the_exponent_of_a_foam_means_nothing_without_compressibility():
    known = pressed_effect("fading", (X, Y))
    np.testing.assert_allclose(known.weights((0.0, 0.9)), 0.0, atol=1e-12)


def test_beyond_the_bounds_is_refused():
    with pytest.raises(ValueError, match=r"x = 1\.2: must lie between 0 and 1"):
        pressed_effect("sum", (X,)).weights((1.2,))


def test_a_further_press_counts_where_it_was_made_and_not_at_the_first_ones():
    chosen = Candidate("foam-densification", "medium1", (X, FREE, Y), lambda _: {})
    known, more = pressed_effect("sum", chosen.coordinates), Differences(chosen)
    more.add((0.6, 0.0, 0.2), np.array([[1.0, -2.0]]))
    more.add((0.6, 0.0, 0.4), np.array([[0.5, 0.5]]) - more.difference_at((0.6, 0.0, 0.4)))
    np.testing.assert_allclose(more.difference_at((0.6, 0.3, 0.2)), [[1.0, -2.0]], atol=1e-9)
    np.testing.assert_allclose(more.difference_at((0.6, 0.0, 0.4)), [[0.5, 0.5]], atol=1e-9)
    for point in ((0.0, 0.0, 0.0), *known.points):
        np.testing.assert_allclose(more.difference_at(point), 0.0, atol=1e-9)
    assert more.is_pressed_at((0.6, 0.9, 0.21))
    assert not more.is_pressed_at((0.3, 0.0, 0.2))

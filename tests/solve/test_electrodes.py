"""What electrodes collect where their edges cut elements, against integrals by hand."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from solve.fem.quadrature import tetrahedron
from solve.fem.shape_functions import physical_gradients, quadratic
from solve.terms.electrodes import coverage
from tests.solve.box import box

SIZE = (2.0, 3.0, 0.05)
CELLS = 3


def film():
    """Corners, quadrature points and weights of a plate whose elements are 0.67 by 1 wide."""
    points, tets = box(CELLS, SIZE)
    reference, weight = tetrahedron()
    shape, slope = quadratic(reference)
    _, volume = physical_gradients(points[tets], slope, weight)
    return points[tets[:, :4]], np.einsum("qn,mni->mqi", shape, points[tets]), volume


FILM = film()
INSIDE = st.tuples(st.floats(0.0, 0.99), st.floats(0.01, 1.0))


def span(low_and_length, size):
    low = low_and_length[0] * size
    return low, low + low_and_length[1] * (size - low)


@given(INSIDE, INSIDE)
def test_a_linear_density_is_integrated_exactly_over_any_rectangle(in_x, in_y):
    """int (1 + 2 x - 3 y) dV = t A (1 + 2 xm - 3 ym), with the middle of the rectangle."""
    (x0, x1), (y0, y1) = span(in_x, SIZE[0]), span(in_y, SIZE[1])
    over = coverage(*FILM, np.array([[x0, x1, y0, y1]]))
    x, y, _ = np.moveaxis(FILM[1], -1, 0)
    volume = SIZE[2] * (x1 - x0) * (y1 - y0)
    assert over.volume()[0] == pytest.approx(volume, rel=1e-9)
    exact = volume * (1.0 + (x0 + x1) - 1.5 * (y0 + y1))
    assert over.integral(1.0 + 2.0 * x - 3.0 * y)[0] == pytest.approx(exact, rel=1e-8, abs=1e-9 * volume)


def test_an_electrode_over_everything_has_the_weights_of_the_elements():
    everywhere = np.array([[-np.inf, np.inf, -np.inf, np.inf]])
    over = coverage(*FILM, everywhere)
    assert (over.weight == FILM[2]).all()


def test_electrodes_that_share_an_element_have_their_parts_of_it():
    cut = 0.31
    over = coverage(*FILM, np.array([[0.0, cut, 0.0, 3.0], [cut, 2.0, 0.0, 3.0]]))
    assert over.volume() == pytest.approx(np.array([cut, 2.0 - cut]) * 3.0 * 0.05)


def test_a_curved_density_converges_at_second_order_at_least():
    """int x^2 over [0.3, 1.1] on elements of half the size: the error falls by four or more."""
    errors = []
    for cells in (3, 6, 12):
        points, tets = box(cells, SIZE)
        reference, weight = tetrahedron()
        shape, slope = quadratic(reference)
        _, volume = physical_gradients(points[tets], slope, weight)
        at = np.einsum("qn,mni->mqi", shape, points[tets])
        over = coverage(points[tets[:, :4]], at, volume, np.array([[0.3, 1.1, 0.0, 3.0]]))
        errors.append(abs(over.integral(at[..., 0] ** 2)[0] / (0.15 * (1.1**3 - 0.3**3) / 3.0) - 1.0))
    assert errors[2] < errors[0] / 16.0

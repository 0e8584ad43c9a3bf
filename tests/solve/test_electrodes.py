"""What electrodes collect where their edges cut elements, against integrals by hand."""

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from geometry.electrode_outlines import EVERYWHERE, electrode_corners, rectangle_corners
from geometry.parameters import Electrode
from geometry.polygons import signed_area_mm2
from solve.fem.quadrature import tetrahedron
from solve.fem.shape_functions import physical_gradients, quadratic
from solve.symmetry import electrode_images
from solve.terms.electrodes import coverage, electrode_pieces
from tests.cases import for_each
from tests.solve.box import box

SIZE = (2.0, 3.0, 0.05)
CELLS = 3


def film(cells=CELLS):
    """Corners, quadrature points and weights of a plate whose elements are 0.67 by 1 wide."""
    points, tets = box(cells, SIZE)
    reference, weight = tetrahedron()
    shape, slope = quadratic(reference)
    _, volume = physical_gradients(points[tets], slope, weight)
    return points[tets[:, :4]], np.einsum("qn,mni->mqi", shape, points[tets]), volume


def over(outlines, on):
    return coverage(*on, electrode_pieces([np.array(one) for one in outlines]))


FILM = film()
INSIDE = st.tuples(st.floats(0.0, 0.99), st.floats(0.01, 1.0))


def span(low_and_length, size):
    low = low_and_length[0] * size
    return low, low + low_and_length[1] * (size - low)


def linear_integral(outlines):
    """int (1 + 2 x - 3 y) dV over each outline."""
    x, y, _ = np.moveaxis(FILM[1], -1, 0)
    return over(outlines, FILM).integral(1.0 + 2.0 * x - 3.0 * y)


@given(INSIDE, INSIDE)
@example((2.3e-313, 0.5), (0.0, 1.0))
def test_a_linear_density_is_integrated_exactly_over_any_rectangle(in_x, in_y):
    """int (1 + 2 x - 3 y) dV = t A (1 + 2 xm - 3 ym), with the middle of the rectangle."""
    (x0, x1), (y0, y1) = span(in_x, SIZE[0]), span(in_y, SIZE[1])
    corners = [rectangle_corners(x0, x1, y0, y1)]
    volume = SIZE[2] * (x1 - x0) * (y1 - y0)
    assert over(corners, FILM).volume()[0] == pytest.approx(volume, rel=1e-9)
    exact = volume * (1.0 + (x0 + x1) - 1.5 * (y0 + y1))
    assert linear_integral(corners)[0] == pytest.approx(exact, rel=1e-8, abs=1e-9 * volume)


STAR = [(1.0, 1.4), (1.2, 2.0), (1.9, 2.1), (1.3, 2.3), (1.0, 2.9), (0.7, 2.3), (0.1, 2.1), (0.8, 2.0)]
"""Its own image in x = 1; corners of four notches point inwards."""


@for_each(
    ("electrode", "area", "middle"),
    [
        ({"shape": "circle", "center_mm": (0.9, 1.3), "radius_mm": 0.7}, np.pi * 0.49, (0.9, 1.3)),
        # right triangle, clockwise: the middle is the mean of its corners
        ({"shape": "polygon", "corners_mm": ((0.2, 0.3), (0.2, 2.7), (1.7, 0.3))}, 1.8, (0.7, 1.1)),
        # an L of a square of 1 and one of 0.5 beside it
        (
            {"shape": "polygon", "corners_mm": ((0, 0), (1.5, 0), (1.5, 0.5), (1, 0.5), (1, 1), (0, 1))},
            1.25,
            ((0.5 + 0.25 * 1.25) / 1.25, (0.5 + 0.25 * 0.25) / 1.25),
        ),
    ],
)
def test_area_and_first_moments_of_circles_and_polygons(electrode, area, middle):
    """Closed forms, whatever the elements: int (1 + 2 x - 3 y) dV = t A (1 + 2 xm - 3 ym)."""
    corners = [electrode_corners(Electrode(name="a", **electrode))]
    assert over(corners, FILM).volume()[0] == pytest.approx(SIZE[2] * area, rel=1e-9)
    exact = SIZE[2] * area * (1.0 + 2.0 * middle[0] - 3.0 * middle[1])
    assert linear_integral(corners)[0] == pytest.approx(exact, rel=1e-8)


def test_a_circle_and_the_rest_of_the_film_collect_what_the_whole_film_does():
    """The rest as two halves around the circle, polygons with a deep bay; any density."""
    circle = electrode_corners(Electrode(name="a", shape="circle", center_mm=(1.0, 1.5), radius_mm=0.8))
    left, right = [p for p in circle if p[0] < 1.0], [p for p in circle if p[0] > 1.0]
    right = sorted(right, key=lambda p: p[1])
    left = sorted(left, key=lambda p: -p[1])
    top, bottom = (1.0, left[0][1]), (1.0, right[0][1])  # an edge of the circle is level there
    halves = [
        [(1.0, 0.0), (2.0, 0.0), (2.0, 3.0), (1.0, 3.0), top, *right[::-1], bottom],
        [(1.0, 3.0), (0.0, 3.0), (0.0, 0.0), (1.0, 0.0), bottom, *left[::-1], top],
    ]
    density = np.random.default_rng(1).normal(size=FILM[2].shape)
    collected = over([circle, *halves], FILM).integral(density)
    assert collected.sum() == pytest.approx((density * FILM[2]).sum(), rel=1e-9)


def test_a_star_is_its_own_image_in_one_axis():
    moved = [[(x - 1.0, y - 2.0) for x, y in STAR]]
    assert list(electrode_images(moved, 0)) == [0]
    assert electrode_images(moved, 1) is None
    assert over([STAR], FILM).volume()[0] == pytest.approx(SIZE[2] * signed_area_mm2(STAR), rel=1e-9)


def test_an_electrode_over_everything_has_the_weights_of_the_elements():
    assert (over([EVERYWHERE], FILM).weight == FILM[2]).all()


def test_a_curved_density_converges_at_second_order_at_least():
    """int x^2 over [0.3, 1.1] on elements of half the size: the error falls by four or more."""
    errors = []
    for cells in (3, 6, 12):
        found = over([rectangle_corners(0.3, 1.1, 0.0, 3.0)], (fine := film(cells)))
        exact = 0.15 * (1.1**3 - 0.3**3) / 3.0
        errors.append(abs(found.integral(fine[1][..., 0] ** 2)[0] / exact - 1.0))
    assert errors[2] < errors[0] / 16.0

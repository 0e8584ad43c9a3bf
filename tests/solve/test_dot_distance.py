"""Distance to the dot against geometry, its derivatives against differences."""

import numpy as np
import pytest

from geometry.dot import DotShape
from solve.terms.rigid_dot import RigidDot
from tests.cases import for_each

AT_REST = np.zeros(3)


def dot(kind="cap", radius=0.8, height=0.5, tips=((0.0, 0.0, 0.0),), rotation=None):
    return RigidDot(
        DotShape(
            kind,
            radius,
            height,
            np.array(tips),
            np.array([0.1, 0.2, 3.0]),
            np.eye(3) if rotation is None else rotation,
        ),
        unit_mm=1.0,
    )


def gap(rigid, *points, move=AT_REST):
    return rigid.distance(np.array(points, float), move)[0]


def test_touches_at_its_tip_and_follows_its_movement():
    assert gap(dot(), (0.1, 0.2, 3.0)) == pytest.approx(0.0)
    assert gap(dot(), (0.1, 0.2, 3.0), move=np.array([0, 0, -0.3])) == pytest.approx(-0.3)


def test_sphere_plate_and_ridge():
    assert gap(dot(), (0.4, 0.2, 3.0)) == pytest.approx(np.hypot(0.3, 0.8) - 0.8)
    assert gap(dot(), (9.0, 9.0, 3.1)) == pytest.approx(0.4)  # far from the cap the plate is nearest
    assert gap(dot("ridge", height=9.0), (0.4, 7.0, 3.0)) == pytest.approx(np.hypot(0.3, 0.8) - 0.8)
    assert gap(dot("plate", height=0.0), (5.0, 5.0, 2.9)) == pytest.approx(0.1)


def test_foot_of_a_tall_dot_is_a_cylinder():
    assert gap(dot(radius=0.8, height=1.5), (1.2, 0.2, 3.9)) == pytest.approx(0.3)


def test_neighbours_of_a_cell_take_part():
    cell = dot(tips=((0.0, 0.0, 0.0), (2.5, 0.0, 0.0)))
    assert gap(cell, (2.6, 0.2, 2.9)) == pytest.approx(0.1)


def test_a_lower_neighbour_is_farther_away():
    cell = dot(tips=((0.0, 0.0, 0.0), (2.5, 0.0, 0.1)))
    assert gap(cell, (2.6, 0.2, 2.9)) == pytest.approx(0.2)
    assert gap(cell, (2.9, 0.2, 3.1)) == pytest.approx(np.hypot(0.3, 0.8) - 0.8)


TILTED = np.array([[0.8, 0.0, 0.6], [0.0, 1.0, 0.0], [-0.6, 0.0, 0.8]])


@for_each(
    "rigid",
    [dot(), dot("ridge"), dot(radius=0.8, height=1.5), dot(rotation=TILTED), dot("plate", rotation=TILTED)],
)
def test_derivatives(rigid):
    points = np.array([[0.3, 0.1, 2.9], [-0.4, 0.5, 3.05], [1.6, 0.4, 4.3]])
    _, normal, hessian = rigid.distance(points, AT_REST)
    np.testing.assert_allclose(np.linalg.norm(normal, axis=1), 1.0)
    for axis, step in enumerate(1e-6 * np.eye(3)):
        ahead, behind = rigid.distance(points + step, AT_REST), rigid.distance(points - step, AT_REST)
        np.testing.assert_allclose(normal[:, axis], (ahead[0] - behind[0]) / 2e-6, atol=1e-8)
        np.testing.assert_allclose(hessian[:, :, axis], (ahead[1] - behind[1]) / 2e-6, atol=1e-7)

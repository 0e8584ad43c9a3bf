"""Distance to the dot against geometry, its derivatives against differences."""

import numpy as np
import pytest

from geometry.dot import DotShape
from geometry.dot_profile import DotProfile
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


def measured(depth_mm, base_mm=0.75, rows=40):
    """A profile that samples depth_mm(r)."""
    radius = np.linspace(0.0, base_mm, rows)
    profile = DotProfile(tuple(radius), tuple(depth_mm(radius)))
    shape = DotShape("profile", 0.8, profile.height_mm, np.zeros((1, 3)), np.array([0.1, 0.2, 3.0]), np.eye(3), profile)
    return RigidDot(shape, unit_mm=1.0)


BALL = measured(lambda r: 0.8 - np.sqrt(0.64 - r**2))
POINTS = np.array([[0.3, 0.1, 2.9], [-0.4, 0.5, 3.05], [0.2, 0.2, 3.05], [0.1, 0.2, 2.7]])
"""Over the dot, in front of its surface and behind it; the last one on its axis."""


def test_a_profile_of_a_ball_is_the_ball():
    """Of 40 rows 20 um apart, by a cubic spline: height to the fourth order, curvature to the second."""
    for found, exact, most in zip(
        BALL.distance(POINTS, AT_REST), dot(height=1.0).distance(POINTS, AT_REST), (1e-6, 1e-4, 2e-3), strict=True
    ):
        np.testing.assert_allclose(found, exact, atol=most)
    assert BALL.shape.profile.tip_radius_mm == pytest.approx(0.8, rel=0.05)


def test_a_profile_of_a_cone_has_the_distance_of_a_cone():
    """Beside its rounded tip: (z + r) / sqrt 2 from a flank of 45 degrees."""
    cone = measured(lambda r: r)
    assert gap(cone, (0.5, 0.2, 3.2)) == pytest.approx((0.4 - 0.2) / np.sqrt(2.0))
    assert gap(cone, (5.0, 0.2, 3.5)) == pytest.approx(0.25)  # of the plate


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
    [dot(), BALL, dot("ridge"), dot(radius=0.8, height=1.5), dot(rotation=TILTED), dot("plate", rotation=TILTED)],
)
def test_derivatives(rigid):
    points = np.array([[0.3, 0.1, 2.9], [-0.4, 0.5, 3.05], [1.6, 0.4, 4.3]])
    _, normal, hessian = rigid.distance(points, AT_REST)
    np.testing.assert_allclose(np.linalg.norm(normal, axis=1), 1.0)
    for axis, step in enumerate(1e-6 * np.eye(3)):
        ahead, behind = rigid.distance(points + step, AT_REST), rigid.distance(points - step, AT_REST)
        np.testing.assert_allclose(normal[:, axis], (ahead[0] - behind[0]) / 2e-6, atol=1e-8)
        np.testing.assert_allclose(hessian[:, :, axis], (ahead[1] - behind[1]) / 2e-6, atol=1e-7)

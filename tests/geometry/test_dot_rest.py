"""A dot at rest just touches: against closed forms and against points on the surfaces."""

from math import asin, atan2, degrees, hypot, radians, sin

import numpy as np
import pytest

from foundation.errors import InputError
from geometry.dot_at_rest import resolve_dot
from geometry.parameters import Dot, Effector
from geometry.stack import Box, Disc, Dome
from tests.cases import for_each

TOP = 3.528
MARBURG_RADIUS = 0.8125


def test_a_tilted_ball_still_touches_the_top_at_its_offset(segment):
    shape = resolve_dot(Dot(offset_mm=(0.3, -0.2), tilt_deg=(6.0, -9.0)), segment)
    ball = shape.origin_mm + shape.rotation @ [0.0, 0.0, MARBURG_RADIUS]
    assert ball == pytest.approx([0.3, -0.2, TOP + MARBURG_RADIUS])


def test_a_positive_tilt_about_y_lowers_the_dots_at_positive_x(segment):
    shape = resolve_dot(Dot(tilt_deg=(0.0, 5.0)), segment)
    assert (shape.rotation @ [1.0, 0.0, 0.0])[2] == pytest.approx(-sin(radians(5.0)))


def test_the_allowed_tilt_is_where_the_plate_meets_the_edge(segment):
    # the plate's face, 0.5 mm over the tip, meets the edge at x = 1.25: 1.25 sin t - R cos t = h - R
    arm = hypot(1.25, MARBURG_RADIUS)
    limit = degrees(atan2(MARBURG_RADIUS, 1.25) + asin((0.5 - MARBURG_RADIUS) / arm))
    resolve_dot(Dot(tilt_deg=(0.0, limit - 0.01)), segment)
    resolve_dot(Dot(tilt_deg=(-limit + 0.01, 0.0)), segment)
    with pytest.raises(InputError, match="plate overlaps the segment by"):
        resolve_dot(Dot(tilt_deg=(0.0, limit + 0.01)), segment)


def test_a_refused_tilt_says_overlap_and_limit(segment):
    with pytest.raises(InputError) as error:
        resolve_dot(Dot(tilt_deg=(0.0, 40.0)), segment)
    # overlap 1.25 sin t - R cos t - h + R at 40 degrees; limit as above
    assert str(error.value) == (
        "dot.tilt_deg = [0, 40]: the plate overlaps the segment by 0.494 mm at rest; "
        "in this direction at most [0, 20.92] is allowed"
    )


def test_a_tilted_neighbour_over_a_long_segment_is_refused(make_segment):
    # its ball sinks by pitch times sine: 2.5 sin 2 deg = 0.0872
    with pytest.raises(InputError) as error:
        resolve_dot(Dot(cell="⠉", tilt_deg=(0.0, 2.0)), make_segment(length_mm=8.0))
    assert str(error.value) == (
        "dot.tilt_deg = [0, 2]: the neighbouring dot overlaps the segment by 0.0872 mm at rest; "
        "in this direction at most [0, 0] is allowed"
    )
    resolve_dot(Dot(cell="⠉", tilt_deg=(0.0, -2.0)), make_segment(length_mm=8.0))


@for_each("tilt", [(4.0, 2.0), (-3.0, 5.0)])
def test_a_tilted_plate_touches_the_highest_corner_only(make_segment, tilt):
    segment = make_segment(effector=Effector(shape="block", length_mm=1.0, width_mm=2.0))
    shape = resolve_dot(Dot(shape="plate", tilt_deg=tilt, offset_mm=(0.1, 0.0)), segment)
    corners = np.array([[x, y, TOP] for x in (-0.5, 0.5) for y in (-1.0, 1.0)])
    behind = (corners - shape.origin_mm) @ shape.rotation[:, 2]
    assert behind.max() == pytest.approx(0.0, abs=1e-12)
    assert np.sort(behind)[-2] < -1e-3
    assert shape.origin_mm[:2] == pytest.approx([0.1, 0.0])


@for_each(("tilt", "offset"), [((6.0, 0.0), (0.0, 0.0)), ((-5.0, 4.0), (0.2, 0.3))])
def test_a_ridge_tilted_along_its_axis_touches_the_edge_only(segment, tilt, offset):
    shape = resolve_dot(Dot(shape="ridge", radius_mm=1.0, tilt_deg=tilt, offset_mm=offset), segment)
    angle, along = np.meshgrid(np.linspace(-1, 1, 2001), np.linspace(-4, 4, 2001))
    skin = np.stack([np.sin(angle), along, 1 - np.cos(angle)], axis=-1).reshape(-1, 3)
    points = shape.origin_mm + skin @ shape.rotation.T
    over = points[(np.abs(points[:, :2]) <= 1.25).all(axis=1)]
    assert over[:, 2].min() == pytest.approx(TOP, abs=5e-4)  # one step of the grid times the slope


def test_an_untilted_ridge_rests_on_the_top(segment):
    assert resolve_dot(Dot(shape="ridge", radius_mm=1.0), segment).origin_mm == pytest.approx([0, 0, TOP])


def skin_points(body):
    """Points all over the outside of a body."""
    turn = np.linspace(0, 2 * np.pi, 181)
    ring = np.column_stack([np.cos(turn), np.sin(turn)])
    share = np.linspace(0, 1, 201)
    if isinstance(body, Box):
        x, y = np.meshgrid(np.linspace(-1, 1, 101) * body.half_x, np.linspace(-1, 1, 101) * body.half_y)
        flat = np.column_stack([x.ravel(), y.ravel()])
        return np.vstack(
            [np.column_stack([flat, np.full(len(flat), z)]) for z in np.linspace(body.bottom, body.top, 41)]
        )
    if isinstance(body, Disc):
        levels = [(s * body.radius, z) for s in share for z in (body.bottom, body.top)]
        levels += [(body.radius, z) for z in np.linspace(body.bottom, body.top, 101)]
    else:
        h, a = body.top - body.bottom, body.foot_radius
        radius = (a * a + h * h) / (2 * h)
        angles = share * np.arcsin(a / radius)
        levels = [(radius * np.sin(t), body.top - radius * (1 - np.cos(t))) for t in angles]
        levels += [(s * a, body.bottom) for s in share]
    return np.vstack([np.column_stack([r * ring, np.full(len(ring), z)]) for r, z in levels])


BODIES = [Box(1.25, 1.0, 0.0, 2.5), Disc(0.8, 2.5, 3.5), Dome(1.0, 2.5, 3.1), Dome(1.0, 2.5, 3.5)]


@for_each("body", BODIES, ids=["box", "disc", "dome", "hemisphere"])
def test_reach_and_distance_are_those_of_the_nearest_skin_point(body):
    skin = skin_points(body)
    random = np.random.default_rng(1)
    for _ in range(40):
        direction = random.normal(size=3) * [0.6, 0.6, 0.2] + [0, 0, 0.7]
        direction /= np.linalg.norm(direction)
        assert body.reach(direction) == pytest.approx((skin @ direction).max(), abs=2e-3)
        point = np.array([*random.uniform(-3, 3, size=2), random.uniform(body.bottom + 0.05, body.top + 2)])
        outside = body.distance(point)
        if outside > 0.0:
            assert outside == pytest.approx(np.linalg.norm(skin - point, axis=1).min(), abs=5e-3)

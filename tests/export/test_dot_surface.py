"""The drawn dot is the rigid body that the contact knows."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from pressed_box import box_dot

from export.dot_surface import PLATE_THICKNESS_MM, DotPart, dot_parts, in_segment_frame
from tests.cases import for_each


def solid(part: DotPart) -> trimesh.Trimesh:
    return trimesh.Trimesh(part.points_mm, part.triangles, process=True)


@for_each("kind", ["cap", "ridge", "plate"])
def test_every_part_is_a_closed_outward_surface(kind: str) -> None:
    for part in dot_parts(box_dot(kind), (1.0, 1.0)):
        assert solid(part).is_volume
        assert solid(part).volume > 0


def test_cap_has_the_volume_of_a_spherical_cap() -> None:
    radius, height = 0.8, 0.5
    cap, plate = dot_parts(box_dot(), (1.0, 1.0), facets=200)
    assert solid(cap).volume == pytest.approx(np.pi * height**2 * (radius - height / 3), rel=2e-3)
    assert plate.points_mm[:, 2].min() == pytest.approx(height)
    assert np.ptp(plate.points_mm[:, 2]) == pytest.approx(PLATE_THICKNESS_MM)


def test_tall_cap_stands_on_a_cylindrical_foot() -> None:
    tall = replace(box_dot(), height_mm=1.0)
    cap = solid(dot_parts(tall, (1.0, 1.0), facets=200)[0])
    assert cap.volume == pytest.approx(2 / 3 * np.pi * 0.8**3 + np.pi * 0.8**2 * 0.2, rel=2e-3)


def test_cell_has_one_cap_for_each_dot_and_a_plate_under_all() -> None:
    cell = replace(box_dot(), tips_mm=np.array([[0, 0, 0], [2.5, 0, 0], [0, -5.0, 0]]))
    *caps, plate = dot_parts(cell, (1.0, 1.0))
    assert [tuple(solid(cap).bounds.mean(axis=0)[:2].round(6)) for cap in caps] == [(0, 0), (2.5, 0), (0, -5)]
    reach = solid(plate).bounds
    assert all((reach[0, :2] < solid(cap).bounds[0, :2]).all() for cap in caps)


def test_a_lower_dot_of_a_cell_is_a_lower_cap_on_the_same_plate() -> None:
    cell = replace(box_dot(), tips_mm=np.array([[0.0, 0, 0], [2.5, 0, 0.2]]))
    lower = solid(dot_parts(cell, (1.0, 1.0), facets=200)[1])
    assert lower.bounds[:, 2] == pytest.approx([0.2, 0.5])
    assert lower.volume == pytest.approx(np.pi * 0.3**2 * (0.8 - 0.3 / 3), rel=2e-3)


def test_rotation_and_origin_place_the_dot() -> None:
    turn = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
    turned = replace(box_dot(), rotation=turn)
    placed = in_segment_frame(turned, np.array([[0.0, 0, 0], [0, 0, 1]]), np.array([1.0, 2, 3]))
    np.testing.assert_allclose(placed, [[1, 2, 3], [1, 1, 3]])

"""Nodes crowd towards held sides; the parts stay as they are."""

import numpy as np
import pytest

from geometry.dot_at_rest import resolve_dot
from geometry.parameters import Dot, Segment
from mesh.build import build
from mesh.crowding import crowded_mesh
from mesh.options import MeshOptions
from mesh.quality import measure_quality
from tests.cases import for_each

SHAPES = [
    {"shape": "layer"},
    {"shape": "cylinder", "diameter_mm": 1.9},
    {"shape": "block", "length_mm": 1.8, "width_mm": 2.5},
]


def meshed(boundary, effector, section="solid"):
    layer = {"thickness_mm": 0.5, "material": "rubber"}
    segment = Segment.model_validate(
        {"length_mm": 2.5, "width_mm": 2.5, "medium1": layer, "medium2": layer, "boundary": boundary}
        | {"section": section, "film": {"thickness_um": 28.0}, "effector": {"height_mm": 0.5, **effector}}
    )
    options = MeshOptions(mesher="layered", element_size_mm=0.5, contact_element_size_mm=0.2)
    dot = Dot() if section == "solid" else Dot(shape="ridge")
    return segment, build(segment, resolve_dot(dot, segment), options)


@pytest.mark.press
@for_each("effector", SHAPES)
def test_parts_keep_their_volume_and_no_element_is_inverted(effector):
    segment, even = meshed("clamped", effector)
    before, after = measure_quality(even, segment), measure_quality(crowded_mesh(even, segment), segment)
    assert after.inverted == 0
    assert after.region_volume_error == pytest.approx(before.region_volume_error, abs=1e-9)


def test_elements_at_a_held_side_become_smaller_than_the_film_is_thick_and_those_under_the_dot_stay():
    segment, even = meshed("clamped", SHAPES[0])
    moved = crowded_mesh(even, segment).points_mm
    x = np.unique(moved[:, 0].round(6))
    assert x[-1] == pytest.approx(1.25)
    assert x[-1] - x[-2] < 0.028
    middle = np.abs(even.points_mm[:, :2]).max(axis=1) < 0.4 * 1.25  # an edge may end beyond FROM
    assert np.array_equal(moved[middle], even.points_mm[middle])


def test_free_sides_keep_the_mesh():
    segment, even = meshed("free", SHAPES[0])
    assert crowded_mesh(even, segment) is even


def test_a_slice_crowds_towards_its_held_sides_alone():
    segment, even = meshed("clamped", SHAPES[0], "plane-strain")
    moved = crowded_mesh(even, segment)
    x = np.unique(moved.points_mm[:, 0].round(6))
    assert x[-1] - x[-2] < 0.028
    assert np.array_equal(moved.points_mm[:, 1:], even.points_mm[:, 1:])
    assert measure_quality(moved, segment).inverted == 0

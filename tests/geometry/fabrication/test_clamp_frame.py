"""The frame holds what the boundary condition holds, and nothing else."""

import pytest
from build123d import Solid

from geometry.fabrication.clamp_frame import frame_parts
from geometry.fabrication.device import lone_device
from geometry.fabrication.parameters import Fabrication
from geometry.fabrication.part import box, shape_volume_mm3
from geometry.parameters import Effector
from geometry.solids import layer_solids
from tests.cases import for_each

pytestmark = pytest.mark.press

GLUE, AIR = 0.05, 0.3


def parts_of(segment, **keys):
    return {part.label: part for part in frame_parts(lone_device(segment), Fabrication(**keys))}


def apart(part, layer: Solid) -> float:
    return part.solid.distance_to(layer)


def test_held_sides_are_a_glue_line_away_and_free_ones_have_air(make_kit_segment):
    segment = make_kit_segment()
    soft, frame = layer_solids(segment, 0.028), parts_of(segment)
    assert apart(frame["frame-ring"], soft["medium1"]) == pytest.approx(GLUE)
    assert apart(frame["frame-ring"], soft["effector"]) == pytest.approx(GLUE)
    sides = box((-1.25, 1.25), (-1.25, 1.25), (0.1, 1.9))  # of medium 2, without its base
    assert apart(frame["frame-body"], sides) == pytest.approx(0.1)  # its floor
    assert parts_of(make_kit_segment(held_layers=("medium1", "film", "medium2")))["frame-body"].solid.distance_to(
        sides
    ) == pytest.approx(GLUE)


def test_free_sides_of_medium_2_have_air_to_bulge_into(make_kit_segment):
    body = parts_of(make_kit_segment())["frame-body"].solid
    bulged = box((-1.25 - AIR, 1.25 + AIR), (-1.25 - AIR, 1.25 + AIR), (0.0, 2.0))
    assert shape_volume_mm3(body.intersect(bulged)) < 1e-9
    wider = box((-1.35 - AIR, 1.35 + AIR), (-1.35 - AIR, 1.35 + AIR), (0.0, 2.0))
    assert shape_volume_mm3(body.intersect(wider)) > 0.1


def test_soft_layers_and_frame_do_not_overlap(design):
    frame = [part for part in design.kit.parts if part.label.startswith(("frame", "base"))]
    for layer in layer_solids(design.segment, 0.028).values():
        for part in frame:
            assert shape_volume_mm3(part.solid.intersect(layer)) < 1e-9


def test_the_film_is_clamped_between_body_and_ring(make_kit_segment):
    frame = parts_of(make_kit_segment(), film_flange_mm=0.8)
    film = box((-2.05, 2.05), (-2.05, 2.05), (2.0, 2.028))
    for part in frame.values():
        assert shape_volume_mm3(part.solid.intersect(film)) < 1e-9
        assert apart(part, film) < 1e-9
    lower, upper = frame["frame-body"].solid.bounding_box(), frame["frame-ring"].solid.bounding_box()
    assert pytest.approx(0.028) == upper.min.Z - lower.max.Z


def test_the_dot_reaches_the_top_of_the_segment(make_kit_segment):
    for effector in (Effector(), Effector(shape="dome", diameter_mm=2.0, height_mm=0.8)):
        segment = make_kit_segment(effector=effector)
        above = box((-1.25, 1.25), (-1.25, 1.25), (2.03, 9.0))
        for part in parts_of(segment).values():
            assert shape_volume_mm3(part.solid.intersect(above)) < 1e-9


@for_each(("side", "axis", "end"), [("+x", 0, 1), ("-x", 0, 0), ("+y", 1, 1), ("-y", 1, 0)])
def test_the_cable_leaves_on_its_side(make_kit_segment, side, axis, end):
    body = parts_of(make_kit_segment(), cable_exit=side)["frame-body"].solid
    low, high = tuple(body.bounding_box().min), tuple(body.bounding_box().max)
    ends = (-low[axis], high[axis])
    assert ends[end] - ends[1 - end] == pytest.approx(Fabrication().shelf_mm)
    # a tab of 1.6 mm with 0.4 mm of solder under it lies free from the segment to the end of the shelf
    span = (0.0, ends[1]) if end == 1 else (-ends[0], 0.0)
    tab = [(-0.8, 0.8), (-0.8, 0.8), (1.6, 2.028)]
    tab[axis] = span
    assert shape_volume_mm3(body.intersect(box(*tab))) < 1e-9


def test_a_free_segment_stands_on_an_open_base(make_kit_segment):
    (base,) = parts_of(make_kit_segment(boundary="free")).values()
    assert base.label == "base"
    assert pytest.approx(0.0, abs=1e-6) == base.solid.bounding_box().max.Z
    under = box((-1.25, 1.25), (-1.25, 1.25), (-0.4, 0.0))
    assert shape_volume_mm3(base.solid.intersect(under)) == pytest.approx(6.25 * 0.4)


def test_an_array_has_one_window_for_each_segment(make_kit_segment):
    segment = make_kit_segment(length_mm=2.0, width_mm=2.0)
    ring = parts_of(segment, array=(3, 2), pitch_mm=4.0, tab_width_mm=1.2)["frame-ring"].solid
    outer = ring.bounding_box().size
    holes = 6 * (2.0 + 2 * GLUE) ** 2 + 2 * 3.14159265 * 1.1**2
    assert ring.volume == pytest.approx((outer.X * outer.Y - holes) * 1.5, rel=1e-6)

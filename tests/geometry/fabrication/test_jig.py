"""The jig puts the layers above each other."""

import pytest
from build123d import Pos

from geometry.fabrication.device import lone_device
from geometry.fabrication.kit import jig_parts, stacked_tops
from geometry.fabrication.parameters import Fabrication
from geometry.fabrication.part import box, shape_volume_mm3
from geometry.parameters import Effector
from geometry.solids import layer_solids
from tests.cases import for_each

pytestmark = pytest.mark.press

CYLINDER = Effector(shape="cylinder", diameter_mm=1.6, height_mm=0.7)


def parts_of(segment, **keys):
    return {part.label: part.solid for part in jig_parts(lone_device(segment), Fabrication(**keys))}


@for_each("side", ["+x", "-x", "+y", "-y"])
def test_two_sides_of_every_layer_touch_the_stops_and_two_are_open(make_kit_segment, side):
    segment = make_kit_segment(boundary="free", length_mm=3.0)
    jig = parts_of(segment, cable_exit=side)["jig"]
    for layer in layer_solids(segment, 0.028).values():
        assert shape_volume_mm3(jig.intersect(layer)) < 1e-9
        ways = [(0.1, 0.0), (-0.1, 0.0), (0.0, 0.1), (0.0, -0.1)]
        blocked = [way for way in ways if shape_volume_mm3(jig.intersect(Pos(*way, 0) * layer)) > 1e-4]
        assert len(blocked) == 2
        assert blocked[0][0] * blocked[1][0] == 0.0  # one along x, one along y
        tab = {"+x": (0.1, 0.0), "-x": (-0.1, 0.0), "+y": (0.0, 0.1), "-y": (0.0, -0.1)}[side]
        assert tab not in blocked


def test_the_steps_have_the_heights_of_the_stack(make_kit_segment):
    segment = make_kit_segment(boundary="free")
    tops = {
        round(face.center().Z, 6) for face in parts_of(segment)["jig"].faces() if abs(face.normal_at().Z - 1.0) < 1e-9
    }
    assert {2.0, 2.528, 3.528} <= tops


def test_a_film_with_a_flange_stays_out_of_the_jig(make_kit_segment):
    assert stacked_tops(lone_device(make_kit_segment()), Fabrication()) == pytest.approx(
        {"medium1": 0.5, "effector": 1.5}
    )
    whole = stacked_tops(lone_device(make_kit_segment()), Fabrication(film_flange_mm=0.0))
    assert list(whole) == ["medium2", "film", "medium1", "effector"]


def test_the_locator_centres_a_narrow_effector(make_kit_segment):
    segment = make_kit_segment(effector=CYLINDER, boundary="free")
    parts = parts_of(segment)
    effector, locator = layer_solids(segment, 0.028)["effector"], parts["jig-locator"]
    assert shape_volume_mm3(parts["jig"].intersect(locator)) < 1e-9
    assert locator.distance_to(effector) == pytest.approx(0.05)
    assert pytest.approx(2.528) == locator.bounding_box().min.Z
    moved = Pos(0.1, 0, 0) * effector
    assert shape_volume_mm3(locator.intersect(moved)) > 0.01


def test_no_locator_for_a_layer(make_kit_segment):
    assert set(parts_of(make_kit_segment())) == {"jig"}


def test_the_locator_of_a_block_turns_with_the_cable(make_kit_segment):
    block = Effector(shape="block", length_mm=2.0, width_mm=1.0, height_mm=0.7)
    segment = make_kit_segment(effector=block, boundary="free")
    for side in ("+x", "+y"):
        locator = parts_of(segment, cable_exit=side)["jig-locator"]
        hole = box((-1.05, 1.05), (-0.55, 0.55), (2.6, 3.6))
        assert shape_volume_mm3(locator.intersect(hole)) < 1e-9
        assert locator.distance_to(box((-1.0, 1.0), (-0.5, 0.5), (2.6, 3.6))) == pytest.approx(0.05)


@for_each("pin", [0.6, 1.5, 3.0, 5.0])
def test_every_hole_of_the_locator_has_a_wall_around_it(make_kit_segment, pin):
    """At least wall_mm, the thickness of outer walls, from each pin's hole to the edges and to the effector's hole."""
    dome = Effector(shape="dome", diameter_mm=2.0, height_mm=0.8)
    locator = parts_of(make_kit_segment(effector=dome), pin_diameter_mm=pin)["jig-locator"]
    low, high = locator.bounding_box().min, locator.bounding_box().max
    holes = [face for face in locator.faces() if face.geom_type.name == "CYLINDER"]
    rims = [face.bounding_box() for face in holes]
    assert len(rims) == 3
    for rim in rims:
        beside = (rim.min.X - low.X, high.X - rim.max.X, rim.min.Y - low.Y, high.Y - rim.max.Y)
        assert min(beside) > 1.2 - 1e-6
    for number, one in enumerate(holes):
        assert all(one.distance_to(other) > 1.2 - 1e-6 for other in holes[:number])

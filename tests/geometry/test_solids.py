"""Volumes of the solids against closed forms."""

from itertools import product
from math import pi, radians, tan

import pytest
from build123d import GeomType, Vector

from geometry.assembly import (
    CASE_CLEARANCE_MM,
    CASE_FLOOR_MM,
    CASE_WALL_MM,
    PLATE_THICKNESS_MM,
    build_parts,
    dot_solid,
)
from geometry.dot_at_rest import resolve_dot
from geometry.parameters import Dot, Effector
from geometry.solids import PART_COLOURS, layer_solids
from tests.cases import for_each

EXACT = 1e-9
CURVED = 1e-6  # OCC follows the circle between a sphere and a plane within its tolerance


def parts_of(segment, dot=None):
    dot = dot or Dot()
    return {part.label: part for part in build_parts(segment, resolve_dot(dot, segment))}


def bump_volume(dot, segment):
    """Volume of an untilted dot without its plate, which is the widest part of it."""
    solid = dot_solid(resolve_dot(dot, segment), segment)
    size = solid.bounding_box().size
    return solid.volume - size.X * size.Y * PLATE_THICKNESS_MM, size


def test_layers_fill_the_footprint(segment):
    volumes = {name: part.volume_mm3 for name, part in parts_of(segment).items()}
    area = 2.5 * 2.5
    assert volumes["medium2"] == pytest.approx(area * 2.0, rel=EXACT)
    assert volumes["film"] == pytest.approx(area * 0.028, rel=EXACT)
    assert volumes["medium1"] == pytest.approx(area * 0.5, rel=EXACT)
    assert volumes["effector"] == pytest.approx(area * 1.0, rel=EXACT)


@for_each(
    ("effector", "volume"),
    [
        (Effector(shape="block", length_mm=1.5, width_mm=1.0, height_mm=0.7), 1.5 * 1.0 * 0.7),
        (Effector(shape="cylinder", diameter_mm=1.6, height_mm=0.7), pi * 0.8**2 * 0.7),
        (Effector(shape="dome", diameter_mm=2.0, height_mm=1.0), 2 / 3 * pi),
        # foot 1, height 0.5: radius (1 + 0.25) / 1 = 1.25, volume pi h^2 (3R - h) / 3
        (Effector(shape="dome", diameter_mm=2.0, height_mm=0.5), pi * 0.25 * (3.75 - 0.5) / 3),
    ],
    ids=["block", "cylinder", "hemisphere", "dome"],
)
def test_effectors(make_segment, effector, volume):
    part = parts_of(make_segment(effector=effector))["effector"]
    assert part.volume_mm3 == pytest.approx(volume, rel=CURVED)
    box = part.solid.bounding_box()
    assert pytest.approx(2.528, abs=1e-6) == box.min.Z
    assert pytest.approx(2.528 + effector.height_mm, abs=1e-6) == box.max.Z


CAP = pi * 0.5**2 * (3 * 0.8125 - 0.5) / 3
DOTS = {
    "marburg": (Dot(), CAP),
    "cell": (Dot(cell="⠿"), 6 * CAP),
    "eight dots": (Dot(cell="⣿", cell_dot=5), 8 * CAP),
    "hemisphere": (Dot(radius_mm=0.8), 2 / 3 * pi * 0.8**3),
    "footed": (Dot(base_diameter_mm=1.6, height_mm=0.9), 2 / 3 * pi * 0.8**3 + pi * 0.8**2 * 0.1),
}


@for_each(("dot", "volume"), DOTS.values(), ids=DOTS)
def test_dots_on_their_plate(segment, dot, volume):
    found, size = bump_volume(dot, segment)
    assert found == pytest.approx(volume, rel=CURVED)
    assert pytest.approx(resolve_dot(dot, segment).height_mm + PLATE_THICKNESS_MM, abs=1e-6) == size.Z


@for_each(
    ("dot", "section_area"),
    [
        (Dot(shape="ridge", radius_mm=1.15), pi * 1.15**2 / 2),
        (Dot(shape="ridge", radius_mm=0.5, height_mm=0.75), pi * 0.5**2 / 2 + 1.0 * 0.25),
        # circular segment of radius 1 and height 1/2: angle of 60 degrees to each side
        (Dot(shape="ridge", radius_mm=1.0, height_mm=0.5), pi / 3 - 0.5 * 3**0.5 / 2),
    ],
    ids=["half cylinder", "footed", "segment"],
)
def test_ridges_run_over_the_whole_plate(make_segment, dot, section_area):
    segment = make_segment(section="plane-strain", width_mm=16.0)
    found, size = bump_volume(dot, segment)
    assert size.Y > 16.0
    assert found == pytest.approx(section_area * size.Y, rel=1e-8)


def test_a_tilt_and_an_offset_move_the_dot_but_keep_its_volume(segment):
    shape = resolve_dot(Dot(tilt_deg=(5.0, -8.0), offset_mm=(0.2, 0.1)), segment)
    solid = dot_solid(shape, segment)
    assert solid.is_valid
    at = Vector(*(shape.origin_mm + shape.rotation @ [0.0, 0.0, 0.8125]))
    face = max(solid.faces().filter_by(GeomType.PLANE), key=lambda face: face.area)  # the back of the plate
    thickness = PLATE_THICKNESS_MM * face.area
    assert solid.volume - thickness == pytest.approx(CAP, rel=1e-6)
    lowest = solid.distance_to(Vector(0.2, 0.1, 3.528))
    assert lowest == pytest.approx(0.0, abs=1e-6)
    assert tuple(at) == pytest.approx((0.2, 0.1, 3.528 + 0.8125))


def test_no_soft_part_is_within_the_tilted_dot(segment):
    parts = parts_of(segment, Dot(tilt_deg=(11.9, -9.9)))
    common = parts["dot"].solid & parts["effector"].solid
    assert common is None or sum(solid.volume for solid in common.solids()) < 1e-9


def test_the_plate_is_flush_over_the_tilted_footprint(segment):
    dot = Dot(shape="plate", tilt_deg=(0.0, 5.0))
    solid = dot_solid(resolve_dot(dot, segment), segment)
    assert solid.volume > 2.5 * 2.5 * PLATE_THICKNESS_MM
    # the lowest corner of the plate lies beyond the edge that it touches, on the same plane
    box = solid.bounding_box()
    assert pytest.approx(3.528 - (box.max.X - 1.25) * tan(radians(5.0)), abs=0.01) == box.min.Z


def test_the_case_touches_the_held_layers_only(make_segment):
    case = parts_of(make_segment(held_layers=("medium1", "film")))["case"]
    outer = 2.5 + 2 * (CASE_CLEARANCE_MM + CASE_WALL_MM)
    cavity = 2.5**2 * 0.528 + (2.5 + 2 * CASE_CLEARANCE_MM) ** 2 * 2.0
    assert case.volume_mm3 == pytest.approx(outer**2 * (2.528 + CASE_FLOOR_MM) - cavity, rel=EXACT)
    assert pytest.approx(2.528) == case.solid.bounding_box().max.Z


def test_a_case_that_holds_all_layers_is_a_plain_tray(make_segment):
    held = ("effector", "medium1", "film", "medium2")
    case = parts_of(make_segment(held_layers=held, boundary="elastic"))["case"]
    outer = 2.5 + 2 * CASE_WALL_MM
    assert case.volume_mm3 == pytest.approx(outer**2 * (3.528 + CASE_FLOOR_MM) - 2.5**2 * 3.528, rel=EXACT)


def test_a_free_segment_stands_on_a_base_plate(make_segment):
    case = parts_of(make_segment(boundary="free"))["case"]
    assert case.volume_mm3 == pytest.approx((2.5 + 2 * CASE_WALL_MM) ** 2 * CASE_FLOOR_MM, rel=EXACT)
    assert pytest.approx(0.0, abs=1e-6) == case.solid.bounding_box().max.Z


def test_the_case_is_not_filled_by_a_narrow_effector(make_segment):
    case = parts_of(make_segment(effector=Effector(shape="cylinder", diameter_mm=1.0)))["case"]
    assert pytest.approx(2.528) == case.solid.bounding_box().max.Z


def test_a_ledge_thinner_than_a_wall_is_not_printable(make_segment):
    assert parts_of(make_segment(held_layers=("medium1", "film")))["case"].printable
    assert not parts_of(make_segment(held_layers=("film",)))["case"].printable


HELD = [("effector", "medium1", "film"), ("film",), ("medium2",), ("effector",)]
EFFECTORS = [Effector(), Effector(shape="dome", diameter_mm=2.0)]


@for_each(("held", "effector"), [*product(HELD, EFFECTORS), (HELD[0], None)])
def test_soft_parts_and_case_do_not_overlap(make_segment, held, effector):
    parts = list(parts_of(make_segment(held_layers=held, effector=effector)).values())[:-1]
    for k, one in enumerate(parts):
        for other in parts[k + 1 :]:
            common = one.solid & other.solid
            assert common is None or sum(s.volume for s in common.solids()) < 1e-9


def test_parts_carry_label_colour_material_and_kind(segment):
    parts = parts_of(segment)
    assert list(parts) == ["effector", "medium1", "film", "medium2", "case", "dot"]
    for label, part in parts.items():
        code = "#" + "".join(f"{round(255 * value):02x}" for value in part.colour)
        assert code == PART_COLOURS[label]
        assert part.solid.label == label
        assert tuple(part.solid.color)[:3] == pytest.approx(part.colour, abs=1e-6)
        assert part.rigid == (label in ("case", "dot"))
        assert part.printable == part.rigid
    assert parts["film"].material == "pvdf"
    assert parts["dot"].material is None


def test_without_effector_there_is_no_such_part(make_segment):
    assert list(parts_of(make_segment(effector=None))) == ["medium1", "film", "medium2", "case", "dot"]


@for_each("thickness", [0.0, 0.1])
@for_each("shape", ["layer", "dome"])
def test_another_film_moves_what_lies_above_it(make_segment, thickness, shape):
    effector = Effector(shape=shape, diameter_mm=None if shape == "layer" else 2.0)
    solids = layer_solids(make_segment(effector=effector), thickness)
    assert set(solids) == {"medium2", "medium1", "effector"} | ({"film"} if thickness else set())
    z = 0.0
    for name, height in (("medium2", 2.0), ("film", thickness), ("medium1", 0.5), ("effector", 1.0)):
        if name in solids:
            box = solids[name].bounding_box()
            assert pytest.approx([z, z + height], abs=1e-6) == [box.min.Z, box.max.Z]
        z += height
    expected = 2.5**2 if shape == "layer" else 2 / 3 * pi
    assert solids["effector"].volume == pytest.approx(expected, rel=EXACT)

"""Kerf compensation and convex polygons, by hand."""

from math import pi

import pytest

from geometry.fabrication.device import lone_device
from geometry.fabrication.parameters import Fabrication
from geometry.flat.flat_kit import flat_kit
from geometry.flat.pattern import (
    Circle,
    Dimension,
    FlatPattern,
    Outline,
    kerf_compensated_pattern,
    offset_polygon,
    rectangle,
    rotated_pattern,
)
from geometry.parameters import Effector
from geometry.polygons import polygon_gap_mm, shared_area_mm2

SQUARE = ((0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0))


def test_right_angles_grow_by_perimeter_and_four_corners(segment):
    """A polygon of right angles that is moved outwards by d: area A + P d + 4 d^2, perimeter P + 8 d."""
    for cut in flat_kit(lone_device(segment), Fabrication()).patterns[0].cuts:
        if isinstance(cut, Outline):
            moved = Outline("CUT", offset_polygon(cut.points, 0.05))
            assert moved.area_mm2 == pytest.approx(cut.area_mm2 + 0.05 * cut.length_mm + 4 * 0.05**2)
            assert moved.length_mm == pytest.approx(cut.length_mm + 8 * 0.05)


def test_oblique_corner_keeps_its_distance():
    """A right triangle of legs 3 and 4 moved outwards by its inradius 1 is twice as large."""
    larger = offset_polygon(((0.0, 0.0), (4.0, 0.0), (0.0, 3.0)), 1.0)
    assert Outline("CUT", larger).length_mm == pytest.approx(24.0)


def test_the_cut_takes_half_a_kerf_from_the_waste():
    cuts = (Outline("CUT", SQUARE), Circle("CUT", (1.0, 1.0), 0.5), rectangle("CUT", (0.2, 0.4), (0.2, 0.4), hole=True))
    pattern = FlatPattern("a", "a", "a", 1.0, 1, "", cuts, kerf_mm=0.1)
    outer, hole, window = kerf_compensated_pattern(pattern).cuts
    assert outer.area_mm2 == pytest.approx(2.1**2)
    assert hole.area_mm2 == pytest.approx(pi * 0.45**2)
    assert window.area_mm2 == pytest.approx(0.1**2)


def test_convex_polygons_share_and_keep_apart():
    moved = tuple((x + 1.5, y + 0.5) for x, y in SQUARE)
    assert shared_area_mm2(SQUARE, moved) == pytest.approx(0.5 * 1.5)
    assert polygon_gap_mm(SQUARE, moved) == pytest.approx(-0.5)
    assert polygon_gap_mm(SQUARE, tuple((x + 2.7, y + 1.0) for x, y in SQUARE)) == pytest.approx(0.7)


def test_four_quarter_turns_are_none(segment):
    pattern = flat_kit(lone_device(segment), Fabrication()).patterns[0]
    once = rotated_pattern(pattern, 90.0)
    assert rotated_pattern(once, 270.0) == pattern
    assert once.size_mm == pytest.approx(pattern.size_mm[::-1])


def test_dimensions_turn_with_the_part():
    below = Dimension(*SQUARE[:2], "x", -1.0)
    pattern = FlatPattern("a", "a", "a", 1.0, 1, "", (Outline("CUT", SQUARE),), (), (below,))
    (size,) = rotated_pattern(pattern, 90.0).dimensions
    assert (size.along, size.length_mm, size.shift) == ("y", 2.0, 1.0)


def test_sheet_cut_media_have_the_outline_of_their_layer(make_segment):
    """A round effector is a circle, with the cable at y an oblong footprint stays oblong along x."""
    made = Fabrication(cable_exit="+y", routes={"medium1": "sheet", "effector": "sheet"})
    effector = Effector(shape="cylinder", diameter_mm=1.4, height_mm=0.8)
    patterns = {p.name: p for p in flat_kit(lone_device(make_segment(length_mm=4.0, effector=effector)), made).patterns}
    assert patterns["sheet-effector"].cuts[0].length_mm == pytest.approx(pi * 1.4)
    assert patterns["sheet-medium1"].size_mm == pytest.approx((4.1, 2.6))
    assert patterns["sheet-medium1"].thickness_mm == pytest.approx(0.5)


def test_rings_have_the_opening_of_the_frame_as_window(segment):
    """Lower: 0.3 mm of air beside the free medium 2; upper: 0.05 mm of glue beside what the ring holds."""
    patterns = {p.name: p for p in flat_kit(lone_device(segment), Fabrication()).patterns}
    windows = [patterns[f"adhesive-flange-{name}"].cuts[-1].area_mm2 for name in ("lower", "upper")]
    assert windows == pytest.approx([3.1**2, 2.6**2])

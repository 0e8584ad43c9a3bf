"""Plates against closed forms and the cells that they should show."""

from math import pi

import pytest

from foundation.errors import InputError
from geometry.braille_standards import standard_names
from geometry.plates.braille_sizes import braille_sizes
from geometry.plates.height_series import height_series
from geometry.plates.indenter import indenter_tip
from geometry.plates.text_plate import lay_out, text_plate
from tests.cases import for_each

BRAILLE = "⠃⠗⠁⠊⠇⠇⠑"
MARBURG = braille_sizes("marburg-medium")
ALL_DOTS = "⠿"
# standards with a diameter, a height, a dot pitch and a cell pitch: enough for one line
COMPLETE = {
    "nls", "ada", "icc-a117-1", "california", "iso-17049", "marburg-medium", "ukaaf", "en-15823", "australia",
    "sweden", "france", "japan", "jis-t-0921", "gb-t-15720",
}  # fmt: skip
LACKING = {
    "norway": "height-mm", "switzerland": "base-diameter-mm", "jis-press": "dot-pitch-mm",
    "jis-press-small": "dot-pitch-mm", "jis-t-9253": "dot-pitch-mm", "small-english": "dot-pitch-mm",
    "enhanced-line": "dot-pitch-mm", "jumbo": "dot-pitch-mm",
}  # fmt: skip


def cap_volume(diameter, height):
    """A spherical cap; higher than a hemisphere, a hemisphere on a cylinder."""
    a = diameter / 2
    if height > a:
        return 2 / 3 * pi * a**3 + pi * a**2 * (height - a)
    return pi * height * (3 * a**2 + height**2) / 6


def test_volume_is_slab_less_corner_and_caps():
    plate = text_plate([BRAILLE], MARBURG, thickness_mm=2.0, margin_mm=5.0)
    # seven cells of 6 mm, two columns and three rows of 2.5 mm, a dot of 1.5 mm and 5 mm on each side
    length, width = 6 * 6.0 + 2.5 + 1.5 + 10.0, 2 * 2.5 + 1.5 + 10.0
    assert plate.size_mm == pytest.approx((length, width, 2.5))
    slab = (length * width - 2.5**2 / 2) * 2.0
    assert len(plate.dots) == 2 + 4 + 1 + 2 + 3 + 3 + 2
    assert plate.part.volume_mm3 == pytest.approx(slab + 17 * cap_volume(1.5, 0.5), rel=1e-9)
    box = plate.part.solid.bounding_box()
    assert (*box.min, *box.max) == pytest.approx((-length / 2, -width / 2, 0, length / 2, width / 2, 2.5), abs=1e-4)


def test_the_upper_left_corner_is_cut():
    solid = text_plate(["⠁"], MARBURG).part.solid
    box = solid.bounding_box()
    assert not solid.is_inside((box.min.X + 0.1, box.max.Y - 0.1, 1.0))
    for x, y in ((box.max.X, box.max.Y), (box.min.X, box.min.Y), (box.max.X, box.min.Y)):
        assert solid.is_inside((x - 0.1 * (1 if x > 0 else -1), y - 0.1 * (1 if y > 0 else -1), 1.0))


def test_a_reader_above_finds_rows_downwards_and_columns_to_the_right():
    dots = {dot.dot: (dot.x_mm, dot.y_mm) for dot in lay_out([ALL_DOTS], MARBURG, 0.0)}
    assert set(dots) == {1, 2, 3, 4, 5, 6}
    for upper, lower in ((1, 2), (2, 3), (4, 5), (5, 6)):
        assert dots[upper][1] - dots[lower][1] == pytest.approx(2.5)
        assert dots[upper][0] == pytest.approx(dots[lower][0])
    for left, right in ((1, 4), (2, 5), (3, 6)):
        assert dots[right][0] - dots[left][0] == pytest.approx(2.5)
    assert sum(x for x, _ in dots.values()) == pytest.approx(0.0)
    assert sum(y for _, y in dots.values()) == pytest.approx(0.0)


def test_cells_and_lines_follow_at_their_pitch():
    places = {(dot.line, dot.cell): (dot.x_mm, dot.y_mm) for dot in lay_out(["⠁⠁", "⠁⠁"], MARBURG, 0.0)}
    assert places[1, 2][0] - places[1, 1][0] == pytest.approx(6.0)
    assert places[1, 1][1] - places[2, 1][1] == pytest.approx(10.0)
    assert places[2, 2] == pytest.approx((places[1, 2][0], places[2, 1][1]))


def test_eight_dots_need_a_fourth_row():
    dots = {dot.dot: dot.y_mm for dot in lay_out(["⣿"], MARBURG, 0.0)}
    assert dots[1] - dots[7] == pytest.approx(3 * 2.5)
    assert dots[4] - dots[8] == pytest.approx(3 * 2.5)


def test_a_dot_higher_than_a_hemisphere_has_a_foot():
    plate = height_series(1.6, [0.9], thickness_mm=2.0, edge_mm=10.0)
    slab = (20.0**2 - 2.5**2 / 2) * 2.0
    assert plate.part.volume_mm3 == pytest.approx(slab + cap_volume(1.6, 0.9), rel=1e-9)


def test_a_series_grows_from_left_to_right():
    heights = (0.3, 0.5, 0.9)
    plate = height_series(1.5, heights, spacing_mm=10.0)
    assert [dot.height_mm for dot in plate.dots] == list(heights)
    assert [dot.x_mm for dot in plate.dots] == pytest.approx([-10.0, 0.0, 10.0])
    for dot in plate.dots:
        top = dot.base_z_mm + dot.height_mm
        assert plate.part.solid.is_inside((dot.x_mm, dot.y_mm, top - 1e-3))
        assert not plate.part.solid.is_inside((dot.x_mm, dot.y_mm, top + 1e-3))


@for_each(("thread", "hole"), [("M6", 6.0 - 1.0), ("M4", 4.0 - 0.7), ("10-32", 4.04)])
def test_a_tip_has_the_hole_for_a_tap_and_the_dot_on_its_axis(thread, hole):
    tip = indenter_tip(1.5, 0.5, thread)
    solid, top = tip.part.solid, tip.size_mm[2]
    assert not solid.is_inside((hole / 2 - 0.01, 0.0, 1.0))
    assert solid.is_inside((hole / 2 + 0.01, 0.0, 1.0))
    assert solid.is_inside((0.0, 0.0, top - 1e-3))
    assert not solid.is_inside((0.0, 0.0, top + 1e-3))
    assert not solid.is_inside((0.76, 0.0, top - 0.499))  # beside the dot, just over the flat end
    assert solid.is_inside((0.74, 0.0, top - 0.499))


@for_each("name", sorted(COMPLETE))
def test_every_complete_standard_gives_one_sound_solid(name):
    plate = text_plate(["⠃⠗"], braille_sizes(name))
    assert plate.part.solid.is_valid
    assert len(plate.part.solid.solids()) == 1
    height, base = plate.dots[0].height_mm, plate.dots[0].base_diameter_mm
    x, y, _ = plate.size_mm
    margin = (x * y - (5.0 / 2) ** 2 / 2) * 2.0
    assert plate.part.volume_mm3 == pytest.approx(margin + 6 * cap_volume(base, height), rel=1e-9)


def test_every_standard_is_tried():
    assert COMPLETE | set(LACKING) == set(standard_names())


@for_each(("name", "option"), LACKING.items())
def test_a_standard_that_lacks_a_size_names_the_option(name, option):
    with pytest.raises(InputError, match=f"--standard '{name}': has no .*; give it by --{option} or choose another"):
        text_plate(["⠃⠗"], braille_sizes(name))


def test_a_given_size_completes_a_standard():
    sizes = braille_sizes("norway", {"height_mm": 0.4})
    assert {dot.height_mm for dot in text_plate(["⠃"], sizes).dots} == {0.4}
    assert sizes.known["height_mm"].basis == "given"


def test_one_line_needs_no_line_pitch():
    assert len(text_plate(["⠁"], braille_sizes("japan")).dots) == 1
    with pytest.raises(InputError, match="--line-pitch-mm"):
        text_plate(["⠁", "⠁"], braille_sizes("japan"))


@for_each(
    ("given", "lines", "words"),
    [
        ({"base_diameter_mm": 2.5}, ["⠁"], "dot_pitch_mm = 2.5: neighbouring dots would touch"),
        ({"cell_pitch_mm": 4.0}, ["⠁⠁"], "cell_pitch_mm = 4: neighbouring dots would touch, must be more than 4"),
        ({"line_pitch_mm": 6.5}, ["⠁", "⠁"], "line_pitch_mm = 6.5: .* must be more than 6.5"),
        ({"line_pitch_mm": 8.0}, ["⡀", "⠁"], "line_pitch_mm = 8: .* must be more than 9"),
        ({"height_mm": -0.1}, ["⠁"], "--height-mm = -0.1: must be from 0.01 to 1000 mm"),
        ({}, ["⠀⠀"], "no raised dot"),
        ({}, [""], "is empty"),
        ({}, ["abc"], "text = 'a': must be one Unicode Braille character"),
    ],
)
def test_what_cannot_be_laid_out_is_refused(given, lines, words):
    with pytest.raises(InputError, match=words):
        text_plate(lines, braille_sizes("marburg-medium", given))


def test_other_refusals():
    with pytest.raises(InputError, match="no such Braille standard; did you mean 'marburg-medium'"):
        braille_sizes("marburg")
    with pytest.raises(InputError, match="--thread = 'M5': no such thread, known are M6, M4, 10-32"):
        indenter_tip(1.5, 0.5, "M5")
    with pytest.raises(InputError, match="must be less than the post of 10"):
        indenter_tip(10.0, 0.5)
    with pytest.raises(InputError, match="base_diameter_mm = 12: dots 10 mm apart would touch"):
        height_series(12.0, [0.5])
    with pytest.raises(InputError, match="--heights-mm: is empty"):
        height_series(1.5, [])

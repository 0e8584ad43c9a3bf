"""The table against the numbers of its sources, and what a wrong name says."""

import pytest

from foundation.errors import InputError
from geometry.braille_standards import QUANTITIES, standard, standard_names
from tests.cases import for_each

NONE = (None, None, None)
# minimum, nominal, maximum of base diameter, height, dot pitch, cell pitch, line pitch
TABLE = {
    "nls": ((None, 1.44, None), (None, 0.48, None), (None, 2.34, None), (None, 6.2, None), (None, 10.0, None)),
    "ada": ((1.5, 1.55, 1.6), (0.6, 0.75, 0.9), (2.3, 2.4, 2.5), (6.1, 6.85, 7.6), (10.0, 10.1, 10.2)),
    "icc-a117-1": ((1.5, 1.55, 1.6), (0.6, 0.75, 0.9), (2.3, 2.4, 2.5), (6.1, 6.85, 7.6), (10.0, 10.1, 10.2)),
    "california": ((1.5, 1.55, 1.6), (0.6, 0.75, 0.9), (2.5, 2.5, 2.5), (7.6, 7.6, 7.6), (10.0, 10.1, 10.2)),
    "iso-17049": ((1.0, 1.35, 1.7), (0.3, 0.5, 0.7), (2.2, 2.5, 2.8), (5.1, 5.95, 6.8), (10.0, 12.5, 15.0)),
    "marburg-medium": (
        (1.3, 1.5, 1.6), (None, 0.5, None), (None, 2.5, None), (None, 6.0, None), (9.9, 10.0, 10.0),
    ),
    "ukaaf": ((1.25, 1.5, 1.75), (0.4, 0.5, 0.6), (None, 2.5, None), (None, 6.0, None), (None, 10.0, None)),
    "en-15823": (
        (None, 1.6, None), (None, 0.2, None), (None, 2.5, None), (None, 6.0, None), (None, 10.0, None),
    ),
    "australia": ((1.5, 1.55, 1.6), (0.6, 0.75, 0.9), (2.3, 2.4, 2.5), (6.0, 6.5, 7.0), (10.0, 10.5, 11.0)),
    "norway": ((1.4, 1.5, 1.6), NONE, (None, 2.5, None), (None, 6.1, None), (9.9, 10.0, 10.1)),
    "sweden": ((None, 1.0, None), (None, 0.25, None), (None, 2.5, None), (None, 6.0, None), (None, 10.0, None)),
    "france": ((None, 1.2, None), (None, 0.8, None), (2.5, 2.55, 2.6), (6.0, None, None), (10.0, None, None)),
    "switzerland": (NONE, NONE, (None, 2.3, None), (None, 6.4, None), (None, 10.2, None)),
    "japan": ((None, 1.4, None), (0.3, 0.4, 0.5), (2.1, 2.2, 2.3), (5.1, 5.7, 6.3), NONE),
    "jis-press": (NONE, NONE, NONE, (None, 6.1, None), (11.5, None, None)),
    "jis-press-small": (NONE, NONE, NONE, (None, 5.2, None), (11.0, None, None)),
    "jis-t-0921": ((1.0, 1.35, 1.7), (0.3, 0.5, 0.7), (2.2, 2.5, 2.8), (5.1, 5.95, 6.8), (10.0, 12.5, 15.0)),
    "jis-t-9253": (NONE, (0.3, 0.4, 0.5), NONE, NONE, NONE),
    # gaps of 3.5 to 4.0 and 5.0 to 6.0 mm between the nearest dots of neighbouring cells and lines
    "gb-t-15720": (
        (1.0, 1.3, 1.6), (0.2, 0.35, 0.5), (2.2, 2.5, 2.8), (3.5 + 2.2, 6.25, 4.0 + 2.8),
        (5.0 + 2 * 2.2, 10.5, 6.0 + 2 * 2.8),
    ),
    "small-english": (NONE, NONE, NONE, (None, 5.38, None), (None, 8.46, None)),
    "enhanced-line": (NONE, NONE, NONE, (None, 6.10, None), (None, 15.24, None)),
    "jumbo": (NONE, NONE, NONE, (None, 8.76, None), (None, 12.70, None)),
}  # fmt: skip


def test_every_standard_of_the_table_is_checked_here():
    assert set(standard_names()) == set(TABLE)


@for_each(("name", "expected"), TABLE.items())
def test_numbers_are_those_of_the_sources(name, expected):
    quantities = standard(name).quantities
    for quantity, numbers in zip(QUANTITIES, expected, strict=True):
        found = quantities[quantity]
        for value, number in zip((found.minimum_mm, found.nominal_mm, found.maximum_mm), numbers, strict=True):
            assert value == (None if number is None else pytest.approx(number, abs=1e-12)), quantity


@for_each("name", TABLE)
def test_every_number_has_a_source_and_a_confidence(name):
    for quantity in standard(name).quantities.values():
        assert quantity.source
        assert quantity.confidence in ("high", "medium", "low")


@for_each(
    ("name", "quantity", "flag"),
    [
        ("ada", "height_mm", True),
        ("marburg-medium", "line_pitch_mm", False),
        ("france", "cell_pitch_mm", False),
    ],
)
def test_the_middle_of_a_range_is_flagged(name, quantity, flag):
    assert standard(name).quantities[quantity].nominal_is_middle is flag


def test_confidence_differs_within_a_standard():
    marburg, carton = standard("marburg-medium").quantities, standard("en-15823").quantities
    assert marburg["dot_pitch_mm"].confidence == "high"
    assert marburg["base_diameter_mm"].confidence == "medium"
    assert carton["height_mm"].confidence == "high"
    assert carton["base_diameter_mm"].confidence == "medium"
    assert standard("sweden").quantities["height_mm"].confidence == "low"


def test_an_alias_is_the_same_standard():
    assert standard("din-32976") == standard("marburg-medium")
    assert standard("iso-17351") == standard("en-15823")


@for_each(("wrong", "near"), [("marburg", "marburg-medium"), ("NLS", "nls"), ("iso17049", "iso-17049")])
def test_a_wrong_name_suggests_the_nearest(wrong, near):
    with pytest.raises(InputError) as error:
        standard(wrong)
    assert str(error.value) == f"dot.standard = '{wrong}': no such Braille standard; did you mean '{near}'?"


def test_a_name_like_none_lists_all():
    with pytest.raises(InputError, match=r"known are nls, ada, .*, jumbo$"):
        standard("xyzzyx", field="standard")


def test_a_size_that_is_not_fixed_is_named():
    with pytest.raises(InputError) as error:
        standard("norway").nominal_mm("height_mm")
    assert str(error.value) == (
        "dot.standard = 'norway': this standard has no nominal height_mm, only base_diameter_mm, "
        "dot_pitch_mm, cell_pitch_mm, line_pitch_mm; choose another standard or give the size itself"
    )

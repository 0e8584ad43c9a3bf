"""The list of published numbers."""

import pytest

from softdot.studies.paper.published import inconsistencies, published_numbers, table_rows
from tests.cases import for_each


def test_what_the_paper_contradicts_itself_in_is_flagged_beside_the_printed_value():
    numbers = published_numbers()
    assert numbers["table4.C1.S1b"].value == 5.2  # as printed
    assert "6.10" in numbers["table4.C1.S1b"].misprint
    assert numbers["section4.sum.C2+F1.per-mm"].value == 0.915
    assert "0.917" in numbers["section4.sum.C2+F1.per-mm"].misprint
    assert numbers["section4.force.C1"].misprint is None


def test_every_misprint_belongs_to_a_number():
    flagged = [number for number in published_numbers().values() if number.misprint]
    assert len(flagged) == 11


@for_each("sum_", ["C1+F4", "C4+F2"])
def test_voltages_per_depth_are_the_voltages_over_0_3_mm(sum_):
    numbers = published_numbers()
    volts = numbers[f"section4.sum.{sum_}"].value / 1000
    assert numbers[f"section4.sum.{sum_}.per-mm"].value == pytest.approx(volts / 0.3, abs=0.005)


def test_tables_hold_six_cases_each():
    assert list(table_rows("table3")) == ["F1", "F2", "F3", "F4", "F5", "F6"]
    assert list(table_rows("table4")) == ["C1", "C2", "C3", "C4", "C5", "C6"]


def test_gaps_beyond_single_numbers_are_listed():
    words = " ".join(slip.printed + slip.comment for slip in inconsistencies())
    for gap in ("192", "h₂ = 5", "10^-6", "0.417", "width across the drawing", "5 kPa", "56 kN/m"):
        assert gap in words

"""Verdicts on the paper's trends, on presses that were made up to hold or to break them."""

import pytest

from softdot.studies.paper.segments.cases import CASES
from softdot.studies.paper.segments.trends import SHORT_NAMES, TRENDS, claims
from tests.cases import for_each
from tests.studies.paper.stand_in_study import press, study

SLICE = SHORT_NAMES["plane-strain"]


def verdict(beginning, **changes):
    """Whether the trend that begins so holds in the cross-section."""
    found = [claim for claim in claims(study(**changes)) if claim.text.startswith(beginning) and claim.reading == SLICE]
    assert len(found) == 1
    return found[0].holds


@for_each(
    ("beginning", "broken_by"),
    [
        ("Free sides, hard backing: F1 > F2 > F3", {"F2": press(millivolts=200)}),
        ("Free sides: F4 to F6 lie far below", {"F5": press(millivolts=50)}),
        ("Clamped sides: C1 > C3", {"C3": press(millivolts=900)}),
        ("Clamped sides: C1 > C2", {"C2": press(millivolts=900)}),
        ("A thinner medium 1 gives more", {"C6": press(millivolts=900)}),
        ("A softer medium 2 gives more with clamped", {"F4": press(millivolts=900)}),
        ("C1 + F4, C2 + F1 and C4 + F2 all reach", {"C4": press(millivolts=5), "F2": press(millivolts=5)}),
        ("The final design gives more", {"final-free": press(millivolts=0.1)}),
        ("A medium 2 of 1 MPa", {"C1-E2-1": press(force_N=1.0)}),
        ("A medium 1 of 0.5 mm", {"final-clamped": press(force_N=1.0)}),
    ],
)
def test_a_trend_holds_until_a_press_breaks_it(beginning, broken_by):
    assert verdict(beginning) is True
    assert verdict(beginning, **broken_by) is False


def test_differences_within_two_percent_decide_nothing():
    assert verdict("Clamped sides: C1 > C3", C1=press(millivolts=101), C3=press(millivolts=100)) is None
    assert verdict("Clamped sides: C1 > C3", C1=press(millivolts=103), C3=press(millivolts=100)) is True
    assert verdict("Clamped sides: C1 > C3", C1=press(millivolts=97), C3=press(millivolts=100)) is False


def test_proportionality_needs_an_exponent_of_one():
    linear = {name: press(exponent=1.0) for name in CASES}
    assert verdict("The voltage is proportional to the depth", **linear) is True
    assert verdict("The voltage is proportional to the depth", **(linear | {"C1": press(exponent=2.0)})) is False


def test_proportionality_to_bending_softness_needs_its_ratios():
    follows = {"C1": press(millivolts=1250), "C3": press(millivolts=80), "C5": press(millivolts=10)}
    assert verdict("Clamped sides: the output is proportional", **follows) is True
    assert verdict("Clamped sides: the output is proportional") is False


def test_every_trend_is_tested_in_both_readings_and_says_why():
    tested = claims(study())
    assert len(tested) == 2 * len(TRENDS)
    assert all(claim.holds or any(letter.isdigit() for letter in claim.evidence) for claim in tested)


def test_exponent_of_a_power_law():
    assert press(exponent=2.6).exponent == pytest.approx(2.6)

"""An estimate is near the press that follows, within the error that it tells, and never where it cannot know."""

import time

import pytest

from softdot.config.toml import parse_toml
from softdot.studio.design_facts import KnownPress, Origin
from softdot.studio.document import Document
from softdot.studio.estimate import Estimator, dotted
from softdot.studio.work import design, press, slopes
from tests.cases import for_each
from tests.studio.conftest import QUICK

POWERS = {"press.indentation_mm": (2.0, 3.0, 3.0), "segment.medium1.thickness_mm": (0.5, -1.0, -1.0)}


def moved(key, value, text=QUICK):
    document = Document(text)
    document.set(key.split("."), value)
    return document.text


def learned(powers):
    found = Estimator()
    found.learn("hash", QUICK, parse_toml(QUICK, "quick"), (2.0, 400.0, 60.0), (0.0, 0.0, 0.0))
    found.add_exponents("hash", powers)
    return found


def test_powers_of_what_has_moved_are_multiplied():
    estimator = learned(POWERS)
    text = moved("press.indentation_mm", 0.12, moved("segment.medium1.thickness_mm", 0.45))
    found = estimator.estimate(text)
    assert found["voltage_V"]["value"] == pytest.approx(60.0 * 1.2**3 / 0.9)
    assert found["force_N"]["value"] == pytest.approx(2.0 * 1.2**2 * 0.9**0.5)
    assert found["voltage_V"]["error"] > estimator.estimate(moved("press.indentation_mm", 0.12))["voltage_V"]["error"]


@for_each(
    ("key", "value"),
    {
        "segment.boundary": "clamped",
        "segment.film.thickness_um": 50.0,  # no exponent is known
        "press.indentation_mm": 0.21,  # too far
        "segment.medium1.thickness_mm": -1.0,
    }.items(),
)
def test_what_cannot_be_known_is_not_estimated(key, value):
    assert learned(POWERS).estimate(moved(key, value)) is None
    assert learned(POWERS).estimate("[segment") is None


def test_a_press_that_was_missed_widens_what_is_told_from_then_on():
    estimator, text = learned(POWERS), moved("press.indentation_mm", 0.11)
    before = estimator.estimate(text)["voltage_V"]
    found = 2.0, 400.0, before["value"] + 3 * before["error"]
    estimator.learn("other", text, parse_toml(text, "other"), found, (0.0, 0.0, 0.0))
    after = estimator.estimate(moved("press.indentation_mm", 0.105))["voltage_V"]
    fresh = learned(POWERS).estimate(moved("press.indentation_mm", 0.105))["voltage_V"]
    assert after["error"] > 2 * fresh["error"]


def test_an_estimate_takes_a_few_milliseconds():
    estimator = learned(POWERS)
    texts = [moved("press.indentation_mm", 0.1 + 1e-4 * number) for number in range(1, 101)]
    began = time.process_time()
    assert all(estimator.estimate(text) for text in texts)
    assert time.process_time() - began < 100 * 0.01


@pytest.mark.press
def test_presses_lie_within_the_error_of_their_estimates():
    """From the accurate press of a slice and its derivatives."""

    def pressed(text):
        found = press.accurate_press(text, lambda _: None)
        return KnownPress(Origin(0, text), "", "accurate", found, True, 1)

    estimator = Estimator()
    values, first = design.examine(QUICK)["values"], pressed(QUICK)
    estimator.learn("hash", QUICK, values, first.answer, first.mesh_errors)
    estimator.add_exponents("hash", slopes.exponents(QUICK, [], lambda _: None))
    for key, factor in (
        ("press.indentation_mm", 1.2),
        ("segment.medium1.thickness_mm", 0.7),
        ("segment.medium2.thickness_mm", 1.4),
        ("segment.film.thickness_um", 1.3),
        ("segment.length_mm", 0.85),
    ):
        text = moved(key, factor * dotted(values)[key])
        found = estimator.estimate(text)
        for name, value in zip(("force_N", "charge_pC", "voltage_V"), pressed(text).answer, strict=True):
            assert abs(found[name]["value"] - value) < found[name]["error"], (key, name)
            assert found[name]["error"] < 0.3 * abs(value)

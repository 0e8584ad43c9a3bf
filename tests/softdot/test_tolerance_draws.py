"""Draws of a tolerance budget: a response that is known in closed form, and what the process must not be asked."""

import numpy as np
import pytest

from softdot.tolerances.draws import DRAWS, ToleranceBox, drawn
from softdot.tolerances.questions import PressAnswer, Response
from softdot.tolerances.tolerances import Tolerance

ROWS = [
    Tolerance("thickness", 0.5, 0.1, "mm", "", "high", {"t": 2.0}),
    Tolerance("modulus", None, 30.0, "%", "", "high", {"e": 0.01}),
    Tolerance("height", 0.5, 0.1, "mm", "", "high", {"t": -2.0}, counted=False),
    Tolerance("depth", 0.3, 0.02, "mm", "", "high", {"d": 1.0}),
]
NOMINAL = {"t": 1.0, "e": 1.0, "d": 0.3}


def press(changes, scale=1.0):
    """Force e d^1.5 / t^2 and voltage -3 d / (t sqrt(e)), with their exact slopes; scale : of a coarser mesh."""
    t, e, d = (NOMINAL[key] + changes.get(key, 0.0) for key in "ted")
    force, voltage = scale * e * d**1.5 / t**2, -3.0 * scale * d / (t * np.sqrt(e))
    slopes = {
        "t": Response(-2.0 * force / t, -voltage / t),
        "e": Response(force / e, -0.5 * voltage / e),
        "d": Response(1.5 * force / d, voltage / d),
    }
    return PressAnswer(Response(force, voltage), slopes)


def test_percentiles_are_those_of_the_response_itself():
    """Against 200,000 draws of the closed form; a coarser mesh that is 5 % too stiff everywhere changes nothing."""
    box = ToleranceBox.of(ROWS, NOMINAL.get)
    found = drawn(box, press({}), [press(box.changes(place), 1.05) for place in box.places], [])
    off = np.random.default_rng(5).uniform(-1.0, 1.0, (200_000, 3)) * [0.2, 0.3, 0.02]
    t, e, d = (NOMINAL[key] + off[:, n] for n, key in enumerate("ted"))
    for name, exact in (("force_N", e * d**1.5 / t**2), ("voltage_V", -3.0 * d / (t * np.sqrt(e)))):
        assert list(found[name].values()) == pytest.approx(np.quantile(exact, [0.05, 0.5, 0.95]), rel=0.01)
    assert found["left_out_error"]["force_percent"] < 1.0
    assert found["count"] == DRAWS


def test_the_ends_of_a_quantity_without_slopes_make_a_parabola():
    """An even one only lowers the voltage, an odd one is drawn to both sides."""
    box = ToleranceBox.of(ROWS[:1], NOMINAL.get)
    places = [press(box.changes(place)) for place in box.places]
    force, voltage = press({}).nominal
    even, odd = (Response(force, 0.9 * voltage),) * 2, (Response(force, 1.1 * voltage), Response(force, voltage / 1.1))
    bare, low, wide = (drawn(box, press({}), places, ends)["voltage_V"] for ends in ([], [even], [odd]))
    assert abs(low["below_50_percent"]) < abs(bare["below_50_percent"])
    off, other = (np.random.default_rng(seed).uniform(-1.0, 1.0, 100_000) for seed in (7, 8))
    for ends, found in (((np.log(0.9), 2), low), ((np.log(1.1), 1), wide)):
        exact = voltage / (1.0 + 0.2 * off) * np.exp(ends[0] * other ** ends[1])
        assert list(found.values()) == pytest.approx(np.quantile(exact, [0.05, 0.5, 0.95]), rel=0.01)


def test_a_voltage_that_changes_its_sign_is_not_drawn():
    box = ToleranceBox.of(ROWS, NOMINAL.get)
    places = [press(box.changes(place)) for place in box.places]
    turned = PressAnswer(Response(places[2].nominal.force, -places[2].nominal.voltage), places[2].slopes)
    assert drawn(box, press({}), [*places[:2], turned, *places[3:]], []) is None


def test_places_lie_in_the_box_and_keys_of_several_rows_add():
    box = ToleranceBox.of(
        [*ROWS[:2], Tolerance("radius", None, 10.0, "%", "", "low", {"t": 0.01, "d": 0.003})], NOMINAL.get
    )
    assert np.abs(box.places).max() <= 1.0
    assert not box.places[0].any()
    assert box.changes(np.array([1.0, 0.0, -1.0])) == pytest.approx({"t": 0.1, "e": 0.0, "d": -0.03})

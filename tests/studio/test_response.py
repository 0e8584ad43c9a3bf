"""How a press follows one number: which designs are pressed, what is told of them, and of which design it stays."""

import asyncio
import tomllib

import pytest

from foundation.errors import InputError
from softdot.config.toml import parse_toml
from softdot.studio.design_state import DesignState
from softdot.studio.estimate import Estimator, same_but_for
from softdot.studio.large_messages import large_messages
from softdot.studio.processes import MachineError, TaskRefused
from softdot.studio.response import asked_response, response
from tests.cases import for_each
from tests.studio.test_estimate import POWERS, QUICK, learned, moved

KEY = ["segment", "medium1", "thickness_mm"]
DEPTH = "press.indentation_mm"
VALUES = parse_toml(QUICK, "quick")


def along(asked, press, known=None):
    told = []
    found = asyncio.run(response(press, QUICK, asked, known, told.append))
    return found, told


def test_the_values_lie_evenly_around_the_present_one_which_is_among_them():
    asked = asked_response(VALUES, KEY, None, None)
    assert len(asked.values) == 7
    assert asked.values[3] == asked.present == 0.5
    ratios = [b / a for a, b in zip(asked.values[:-1], asked.values[1:], strict=True)]
    assert ratios == pytest.approx([1.5 ** (1 / 3)] * 6, rel=1e-3)
    assert asked_response({"offset": 0.0}, ["offset"], -0.3, 0.3).values == (-0.3, -0.2, -0.1, 0.0, 0.1, 0.2, 0.3)
    assert asked_response({"steps": 6}, ["steps"], 4, 9).values == (4, 5, 6, 7, 8, 9)
    assert 0.5 not in asked_response(VALUES, KEY, 0.6, 0.9).values


@for_each(
    ("key", "low", "high", "said"),
    [
        (KEY, 0.6, 0.4, "the smaller one first"),
        (KEY, "a", 0.4, "must be two numbers"),
        (KEY, float("nan"), 0.4, "must be two numbers"),
        (["segment", "boundary"], None, None, "is not a number"),
        (["segment", "wing"], None, None, "has no such key"),
        ("segment", None, None, "no such key"),
        ([], None, None, "no such key"),
    ],
)
def test_what_cannot_be_asked_for_is_refused(key, low, high, said):
    with pytest.raises(InputError, match=said):
        asked_response(VALUES, key, low, high)


def test_each_value_is_pressed_once_the_nearest_first_and_one_that_fails_says_why():
    pressed = []

    async def press(text, tell):
        pressed.append(tomllib.loads(text)["segment"]["medium1"]["thickness_mm"])
        tell({"progress": {"stage": "press", "done": 1, "count": 3, "left_s": 1.0}})
        if pressed[-1] > 0.7:
            raise TaskRefused("not converged")
        return {"force_N": 1.0, "charge_pC": 2.0, "voltage_V": 1.0 / pressed[-1], "warnings": []}

    known = {"force_N": 1.0, "charge_pC": 2.0, "voltage_V": 2.0, "warnings": []}
    found, told = along(asked_response(VALUES, KEY, None, None), press, known)
    assert len(pressed) == 6  # the present design is pressed already
    assert pressed == sorted(pressed, key=lambda one: abs(one - 0.5))
    assert [point["value"] for point in found["points"]] == sorted([*pressed, 0.5])
    assert found["points"][-1] == {"value": 0.75, "said": "not converged"}
    assert [one.get("voltage_V") for one in found["points"][:3]] == [1.0 / one["value"] for one in found["points"][:3]]
    counts = [len(one["points"]) for one in told if "points" in one]
    assert counts == [2, 3, 4, 5, 6, 7]
    assert {one["progress"]["done"] for one in told if "progress" in one} == set(range(6))


def test_what_the_machine_ends_is_no_answer_of_a_design():
    async def press(*_):
        raise MachineError("ended twice")

    with pytest.raises(MachineError):
        along(asked_response(VALUES, KEY, None, None), press)


def test_a_design_is_the_same_but_for_one_number():
    key = ".".join(KEY)
    assert same_but_for(key, QUICK, moved(key, 0.7))
    assert same_but_for(DEPTH, QUICK, QUICK + "\n# a comment\n")
    assert not same_but_for(key, QUICK, moved(DEPTH, 0.2, moved(key, 0.7)))
    assert not same_but_for(key, QUICK, "[segment")


def test_a_response_stays_current_while_its_own_number_moves():
    state = DesignState(QUICK)
    result = {"key": ".".join(KEY), "range": [0.4, 0.6], "points": []}
    state.made("response", state.present, {"result": result})

    def is_current():
        return state.told()["artefacts"]["response"]["current"]

    for number, expected in ((".".join(KEY), True), (DEPTH, False)):
        state.document.write(moved(number, 0.17, state.text))
        state.edited()
        assert is_current() is expected
    state.document.undo()
    state.edited()
    assert is_current()


def test_its_line_is_the_estimate_from_one_press_and_follows_what_is_learned():
    state = DesignState(QUICK)
    result = {"key": ".".join(KEY), "range": [0.2, 0.8], "points": []}
    state.made("response", state.present, {"result": result})
    before, content = large_messages(state)["response"]
    assert content()["result"]["line"] == []
    state.estimator = learned(POWERS)
    after, content = large_messages(state)["response"]
    assert after != before
    line = content()["result"]["line"]
    assert line[0]["value"] >= 0.25  # no farther than a factor of two
    assert line[-1]["value"] == pytest.approx(0.8)
    for one in line:
        assert one["voltage_V"]["value"] == pytest.approx(60.0 * 0.5 / one["value"])
    errors = [one["voltage_V"]["error"] / one["voltage_V"]["value"] for one in line if one["value"] > 0.5]
    assert errors == sorted(errors)
    assert Estimator().along(QUICK, result["key"], [0.4, 0.5]) == []

"""A goal in the page: against optima in closed form, by the derivatives of a press and by a family."""

import numpy as np
import pytest
import tomlkit

from foundation.errors import InputError
from softdot.families.family import Family, Region
from softdot.families.folder import write_family
from softdot.families.quantity import FamilyQuantity
from softdot.families.space import FamilySpace
from softdot.studio.document import Document
from softdot.studio.goal import design_goal
from softdot.studio.work.goal import along, answer, by_family, by_law
from tests.cases import for_each
from tests.softdot.families.test_families import DEPTH, FACTS, THICKNESS, places_of, power_law, space_of
from tests.studio.test_estimate import POWERS, QUICK, learned
from tests.studio.test_response import VALUES

DEPTH_PATH, THICKNESS_PATH = ["press", "indentation_mm"], ["segment", "medium1", "thickness_mm"]
NUMBERS = [[DEPTH_PATH, 0.05, 0.2], [THICKNESS_PATH, 0.25, 1.0]]
GOAL = {"enough": "voltage_V", "target": 66.0, "least": "force_N", "numbers": NUMBERS}


def sought(law=None, **asked):
    goal = design_goal(VALUES, {**GOAL, **asked})
    return by_law(law or learned(POWERS).law(QUICK), goal.as_dict())


def test_the_cheapest_way_to_a_voltage_is_that_of_the_linear_program():
    """F = 2 d^2 t^0.5 and V = 60 d^3 / t: the thickness lowers F and raises V, the depth pays for the rest.

    Of the reach of ln 2 the depth gives back what the thickness gains too much: -3 a + b = ln 1.1, a + b = ln 2.
    """
    found = sought()
    depth, thickness = (value for _, value in found["changes"])
    less = (np.log(2.0) - np.log(1.1)) / 4.0
    assert found["reached"]
    assert depth == pytest.approx(0.1 * np.exp(-less), rel=1e-3)
    assert thickness == pytest.approx(0.5 * np.exp(less - np.log(2.0)), rel=1e-3)
    assert found["gives"] == pytest.approx(66.0, rel=1e-3)


def test_one_number_alone_goes_just_as_far_as_the_goal_needs():
    found = sought(numbers=[[DEPTH_PATH, 0.05, 0.2]])
    assert found["changes"] == [[DEPTH_PATH, pytest.approx(0.1 * 1.1 ** (1 / 3), rel=1e-3)]]
    less = sought(numbers=[[DEPTH_PATH, 0.05, 0.2]], target=30.0)
    assert less["changes"] == [[DEPTH_PATH, pytest.approx(0.1 * 0.5 ** (1 / 3), rel=1e-3)]]


def test_what_is_out_of_reach_is_said_with_the_most_that_there_is():
    found = sought(target=1000.0)
    assert not found["reached"]
    assert found["gives"] == pytest.approx(60.0 * 2.0**3, rel=1e-3)  # all of the reach into the depth
    at_an_end = sought(target=1000.0, numbers=[[DEPTH_PATH, 0.05, 0.11]])
    assert at_an_end["gives"] == pytest.approx(60.0 * 1.1**3, rel=1e-3)


@for_each(
    ("asked", "said"),
    [
        ({"enough": "volts"}, "needs two of"),
        ({"enough": "force_N"}, "needs two of"),
        ({"target": -1.0}, "above 0"),
        ({"target": "ten"}, "above 0"),
        ({"numbers": [[DEPTH_PATH, 0.2, 0.3]]}, "cannot move between"),
        ({"numbers": [[["segment", "wing"], 0.2, 0.3]]}, "no such key"),
        ({"numbers": [[["segment", "film", "thickness_um"], 50.0, 200.0]]}, "choose others"),
        ({"numbers": []}, "choose others"),
    ],
)
def test_what_cannot_be_sought_is_refused(asked, said):
    with pytest.raises(InputError, match=said):
        sought(**asked)


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """Folder of a family with a charge, and the design in its middle."""
    space = FamilySpace(space_of(THICKNESS, DEPTH))
    places = places_of(9, 2)
    courses, slopes = power_law(places, space)
    for found in (courses, slopes):
        found["film_charge_pC"] = found["open_circuit_voltage_V"]
    quantities = {name: FamilyQuantity(places, courses[name], slopes[name]) for name in courses}
    region = Region(np.vstack([places, [[0.6, 0.6]]]), np.array([[0.95, 0.95]]), ("it overlaps",))
    folder = tmp_path_factory.mktemp("family")
    write_family(Family(space, quantities, region, FACTS), folder)
    return str(folder), tomlkit.dumps(space.config_at(np.zeros(2)).model_dump(mode="json", exclude_none=True))


def moved(text, key, value):
    document = Document(text)
    document.set(key, value)
    return document.text


def test_a_family_answers_for_its_designs_alone(made):
    folder, text = made
    found = answer(folder, moved(moved(text, THICKNESS_PATH, 0.5), DEPTH_PATH, 0.1))
    assert found["voltage_V"]["value"] == pytest.approx(-3.0 * 0.1**2 / 0.5, rel=1e-3)
    assert 0.0 < found["voltage_V"]["error"] < 0.1 * abs(found["voltage_V"]["value"])
    assert answer(folder, moved(text, THICKNESS_PATH, 0.9)) is None
    assert answer(folder, moved(text, ["segment", "medium2", "thickness_mm"], 0.9)) is None
    line = along(folder, text, DEPTH_PATH, [0.07, 0.09, 0.1, 0.3])
    assert [one["value"] for one in line] == [0.09, 0.1]


def test_a_family_finds_the_least_force_for_a_voltage(made):
    """The closed form of tests/softdot/families/test_goals.py."""
    folder, text = made
    goal = design_goal({}, {"enough": "voltage_V", "target": 0.07, "least": "force_N"}).as_dict()
    found = by_family(folder, text, goal)
    moves = {".".join(path): value for path, value in found["changes"]}
    assert found["reached"]
    assert found["gives"] == pytest.approx(0.07, rel=0.01)
    assert moves["segment.medium1.thickness_mm"] == pytest.approx(0.4, rel=0.02)
    assert moves["press.indentation_mm"] == pytest.approx(np.sqrt(0.07 * 0.4 / 3.0), rel=0.02)
    assert not by_family(folder, text, {**goal, "target": 1.0})["reached"]
    present = answer(folder, text)
    pressed = [present["force_N"]["value"], present["charge_pC"]["value"], 0.9 * present["voltage_V"]["value"]]
    again = by_family(folder, text, goal, pressed)  # a press that gives 10 % less asks for so much more
    moves = {".".join(path): value for path, value in again["changes"]}
    assert moves["press.indentation_mm"] == pytest.approx(np.sqrt(0.07 / 0.9 * 0.4 / 3.0), rel=0.02)
    with pytest.raises(InputError, match=r"medium2\.thickness_mm: differs"):
        by_family(folder, moved(text, ["segment", "medium2", "thickness_mm"], 0.9), goal)

"""Goals in a family: against the optimum of products of powers in closed form, and where no design meets them."""

import numpy as np
import pytest

from foundation.errors import InputError
from softdot.families import goal_folder
from softdot.families.goal import Goal, met_goal
from softdot.progress import Logged
from tests.softdot.families.test_families import family  # noqa: F401  (a fixture)

VOLTAGE, FORCE = "open_circuit_voltage_V", "reaction_force_N"


def exact(space, place):
    """Force 8 t^-0.5 d^1.5 and voltage 3 d^2 / t at a place."""
    t, d = (float(one.values(at)) for one, at in zip(space.ranges, place, strict=True))
    return 8.0 * t**-0.5 * d**1.5, 3.0 * d**2 / t


def test_the_least_force_for_a_voltage_is_that_of_the_closed_form(family):  # noqa: F811
    """With V = 3 d^2 / t the force is 8 (V / 3)^0.75 t^0.25: the thinnest layer, just as deep as the voltage needs."""
    target = 0.07
    found = met_goal(family, Goal(VOLTAGE, target, FORCE))
    assert found.reached
    force, voltage = exact(family.space, found.place)
    assert voltage == pytest.approx(target, rel=0.01)
    assert force == pytest.approx(8.0 * (target / 3.0) ** 0.75 * 0.4**0.25, rel=0.01)
    assert found.place[0] == pytest.approx(-1.0, abs=0.05)


def test_a_batch_costs_force_until_nearly_all_of_it_reach_the_voltage(family):  # noqa: F811
    """The thickness is drawn from 0.4 to 0.6: 3 d^2 / t must do at its 95 % point, t = 0.59."""
    target = 0.045
    found = met_goal(family, Goal(VOLTAGE, target, FORCE, ("medium1_thickness_mm",)))
    assert found.reached
    assert found.probability == pytest.approx(0.955, abs=0.01)
    depth = float(family.space.ranges[1].values(found.place[1]))
    assert depth == pytest.approx(np.sqrt(target * 0.59 / 3.0), rel=0.01)
    sure = met_goal(family, Goal(VOLTAGE, target, FORCE, ("segment.medium1.thickness_mm",), 0.5))
    assert sure.least[1] < found.least[1]


def test_what_no_design_gives_is_said(family):  # noqa: F811
    found = met_goal(family, Goal(VOLTAGE, 1.0, FORCE))
    assert not found.reached
    assert found.probability == 0.0
    with pytest.raises(InputError, match="--batch width: this family varies medium1_thickness_mm"):
        met_goal(family, Goal(VOLTAGE, 0.07, FORCE, ("width",)))
    with pytest.raises(InputError, match="'volts': this family answers"):
        met_goal(family, Goal("volts", 0.07, FORCE))
    with pytest.raises(InputError, match="none is left to choose"):
        met_goal(family, Goal(VOLTAGE, 0.07, FORCE, tuple(family.keys)))


def test_a_press_corrects_the_family_until_a_press_bears_the_goal_out(family, monkeypatch):  # noqa: F811
    """A mesh of its own gives 2 % less voltage, a little more where it is deeper: the next design is that much more."""
    goal, presses = Goal(VOLTAGE, 0.07, FORCE), []

    def press(_, place):
        force, voltage = exact(family.space, place)
        presses.append(0.98 * voltage**1.001)
        return {FORCE: force, VOLTAGE: presses[-1]}

    monkeypatch.setattr(goal_folder, "_pressed", press)
    found, pressed = goal_folder._sought(family, goal, Logged())
    assert [one[VOLTAGE] for one in pressed] == presses
    assert presses[0] < 0.07 <= presses[-1] < 0.0703
    assert len(presses) == 2
    assert found.reached
    assert found.enough[1] == pytest.approx(presses[-1], rel=1e-3)
    assert goal_folder.goal_warnings(goal, found, pressed) == []


def test_a_goal_beyond_the_family_is_pressed_once_and_told(family, monkeypatch):  # noqa: F811
    goal = Goal(VOLTAGE, 1.0, FORCE)
    monkeypatch.setattr(
        goal_folder, "_pressed", lambda _, place: dict(zip((FORCE, VOLTAGE), exact(family.space, place), strict=True))
    )
    found, pressed = goal_folder._sought(family, goal, Logged())
    assert len(pressed) == 1
    (said,) = goal_folder.goal_warnings(goal, found, pressed)
    assert "no design of this family was found" in said

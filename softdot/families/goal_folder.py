"""The folder of a goal: the design as a configuration, and goal.json with what a full press of it gives."""

from pathlib import Path
from typing import Any

import tomlkit

from foundation.arrays import Floats
from softdot.families.family import Family
from softdot.families.folder import load_family
from softdot.families.goal import Goal, MetGoal, met_goal
from softdot.json_files import plain, write_json
from softdot.output import Product, staged_folder
from softdot.prepared_press import PreparedPress
from softdot.progress import Logged, Progress
from softdot.summary import history
from solve.solution.full_load import StoppedShortError

GOAL = Product("softdot-goal/1", "goal.json", frozenset({"goal.json", "design.toml"}))


def run_goal(folder: Path, goal: Goal, out: Path, progress: Progress | None = None) -> dict[str, Any]:
    """Find the best design of the family in folder, press it in full, and write both into out; content of goal.json.

    InputError, MeshingError, LinearSolveError, StoppedShortError.
    """
    told = progress or Logged()
    family = load_family(folder)
    with staged_folder(out, GOAL) as staging:
        told.stage("search")
        found = met_goal(family, goal)
        told.stage("press")
        pressed = _pressed(family, found.place)
        summary: dict[str, Any] = plain(_content(family, goal, found, pressed))
        (staging / "design.toml").write_text(design_text(family, found, goal), "utf-8")
        write_json(staging / GOAL.summary, summary)
    return summary


def design_text(family: Family, found: MetGoal, goal: Goal) -> str:
    """The configuration of the design, for softdot run."""
    config = family.space.config_at(found.place).model_dump(mode="json", exclude_none=True)
    word = "meets" if found.reached else "comes nearest to"
    head = f"# The design of this family that {word} {goal.enough} >= {goal.target:g} with the least {goal.least}."
    return f"{head}\n# {family.space.told(found.place)}\n\n{tomlkit.dumps(config)}"


def _pressed(family: Family, place: Floats) -> dict[str, float]:
    """Sizes at full load of a press with a mesh of its own, batches in their middle."""
    prepared = PreparedPress(family.space.config_at(place))
    result = prepared.solve()
    if not result.converged:
        raise StoppedShortError(str(result.failure))
    last = result.steps[-1]
    voltage = history(result).open_circuit_voltage_V[-1]
    return {
        "reaction_force_N": abs(float(last.reaction_force_N)),
        "film_charge_pC": abs(float(1e12 * last.film_charge_C.sum())),
        "open_circuit_voltage_V": abs(float(voltage)),
    }


def _content(family: Family, goal: Goal, found: MetGoal, pressed: dict[str, float]) -> dict[str, Any]:
    answered = {
        name: abs(float(one.course_values(found.place[None])[0, -1])) for name, one in family.quantities.items()
    }
    known = [name for name in pressed if name in answered]
    ranges = family.space.ranges
    return {
        "format": GOAL.format,
        "goal": {"enough": goal.enough, "target": goal.target, "least": goal.least, "probability": goal.probability,
                 "batch": goal.batch},
        "reached": found.reached,
        "design": {one.keys[0]: float(one.values(at)) for one, at in zip(ranges, found.place, strict=True)},
        "at_an_end": [one.keys[0] for one, at in zip(ranges, found.place, strict=True) if abs(at) > 0.999],
        "probability": found.probability,
        "probability_at_the_low_end_of_the_interval": found.surely,
        goal.enough: dict(zip(("below_5_percent", "below_50_percent", "below_95_percent"), found.enough, strict=True)),
        goal.least: dict(zip(("below_5_percent", "below_50_percent", "below_95_percent"), found.least, strict=True)),
        "in_the_middle": {
            name: {"answered": answered[name], "pressed": pressed[name],
                   "off_percent": 100.0 * (answered[name] / pressed[name] - 1.0)} for name in known
        },
        "warnings": goal_warnings(goal, found, pressed[goal.enough]),
    }  # fmt: skip


def goal_warnings(goal: Goal, found: MetGoal, pressed: float) -> list[str]:
    """Sentences on a goal that is not met, or that is met by the family and not by the press, with its size there."""
    if not found.reached:
        return [
            f"no design of this family gives {goal.enough} >= {goal.target:g} with a probability of "
            f"{goal.probability:g}; the nearest gives it with {found.probability:.3g}"
        ]
    if pressed < goal.target:
        return [
            f"the press of this design, on a mesh of its own, gives {goal.enough} = {pressed:.4g}, "
            f"{100.0 * (1.0 - pressed / goal.target):.2g} % less than {goal.target:g}: ask for that much more"
        ]
    return []

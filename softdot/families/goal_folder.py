"""The folder of a goal: the design as a configuration, and goal.json with what a full press of it gives."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import tomlkit

from foundation.arrays import Floats
from softdot.families.family import Family
from softdot.families.folder import load_family
from softdot.families.goal import Goal, MetGoal, corrections_by, judged_goal, met_goal
from softdot.json_files import plain, write_json
from softdot.output import Product, staged_folder
from softdot.prepared_press import PreparedPress
from softdot.progress import Logged, Progress
from softdot.summary import history
from solve.solution.full_load import StoppedShortError

MOST_PRESSES = 4
"""Of designs that are sought one after the other, each corrected by the press before."""
GOAL = Product("softdot-goal/1", "goal.json", frozenset({"goal.json", "design.toml"}))


def run_goal(folder: Path, goal: Goal, out: Path, progress: Progress | None = None) -> dict[str, Any]:
    """Find the best design of the family in folder, press it in full, and write both into out; content of goal.json.

    InputError, MeshingError, LinearSolveError, StoppedShortError.
    """
    told = progress or Logged()
    family = load_family(folder)
    with staged_folder(out, GOAL) as staging:
        found, pressed = _sought(family, goal, told)
        summary: dict[str, Any] = plain(_content(family, goal, found, pressed))
        (staging / "design.toml").write_text(design_text(family, found, goal), "utf-8")
        write_json(staging / GOAL.summary, summary)
    return summary


def _sought(family: Family, goal: Goal, told: Progress) -> tuple[MetGoal, list[dict[str, float]]]:
    """The best design, judged by its press, and the presses that led there; the last one is its own."""
    corrections: dict[str, float] = {}
    pressed: list[dict[str, float]] = []
    while True:
        told.stage("search")
        found = met_goal(family, goal, corrections)
        is_within_reach = found.reached
        told.stage("press")
        pressed.append(_pressed(family, found.place))
        corrections = corrections_by(_answered(family, found.place), pressed[-1])
        found = judged_goal(family, goal, found.place, corrections)
        if found.reached or not is_within_reach or len(pressed) == MOST_PRESSES:
            return found, pressed


def _answered(family: Family, place: Floats) -> dict[str, float]:
    """Sizes at full load by the family."""
    return {name: abs(float(one.course_values(place[None])[0, -1])) for name, one in family.quantities.items()}


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


def _content(family: Family, goal: Goal, found: MetGoal, presses: list[dict[str, float]]) -> dict[str, Any]:
    answered, pressed = _answered(family, found.place), presses[-1]
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
        "presses": len(presses),
        "warnings": goal_warnings(goal, found, presses),
    }  # fmt: skip


def goal_warnings(goal: Goal, found: MetGoal, presses: Sequence[object]) -> list[str]:
    """Sentences on a goal that no press has borne out."""
    if found.reached:
        return []
    return [
        f"no design of this family was found that gives {goal.enough} >= {goal.target:g} with a probability of "
        f"{goal.probability:g}; the last of {len(presses)} that were pressed gives it with {found.probability:.3g}"
    ]

"""The design that meets a goal by what is known without a press: the derivatives of a press, or a family."""

from collections.abc import Mapping, Sequence
from functools import lru_cache
from math import exp, log
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import linprog

from foundation.errors import InputError
from softdot.config.toml import key_path
from softdot.families.family import Family
from softdot.families.folder import load_family
from softdot.families.goal import Goal, corrections_by, met_goal
from softdot.studio.document import Document
from softdot.studio.estimate import QUANTITIES
from softdot.studio.work.design import config_of

OF_FAMILY = dict(zip(QUANTITIES, ("reaction_force_N", "film_charge_pC", "open_circuit_voltage_V"), strict=True))
"""What families call the quantities."""
DIGITS = 4
"""Significant digits of a number that is moved."""


def by_law(law: Mapping[str, Any], goal: Mapping[str, Any]) -> dict[str, Any]:
    """Where a design is moved to give enough of one quantity for the least of another, to first order in logarithms.

    The shifts s of the numbers solve a linear program: least q.s, with p.s >= ln(target / answer), each s within its
    ends and the sum of |s| within the reach of the law; p and q are the exponents of the two quantities.

    law : as of softdot.studio.estimate.Estimator.law. goal : as of softdot.studio.goal.DesignGoal. changes : path and
    value of each number that moves; reached : whether the target is within reach; gives : size of the quantity there.
    InputError where no number is left to move.
    """
    numbers = [one for one in goal["numbers"] if one["key"] in law["exponents"]]
    if not numbers:
        raise InputError("of none of the numbers that may move is known how the press follows it; choose others")
    rows = np.array([law["exponents"][one["key"]] for one in numbers])
    enough, least = (rows[:, QUANTITIES.index(goal[name])] for name in ("enough", "least"))
    lacking = log(goal["target"] / abs(law["answer"][goal["enough"]]))
    low, high = (np.array([log(one[end] / one["present"]) for one in numbers]) for end in ("low", "high"))
    shifts = _least(least, enough, lacking, (low, high), law["reach"])
    reached = shifts is not None
    if shifts is None:
        shifts = _least(-enough, enough, -np.inf, (low, high), law["reach"])
    if shifts is None:
        raise InputError("the numbers that may move cannot move")
    gives = abs(law["answer"][goal["enough"]]) * exp(float(enough @ shifts))
    moved = [
        [one["path"], float(f"{one['present'] * exp(shift):.{DIGITS}g}")]
        for one, shift in zip(numbers, shifts, strict=True)
        if abs(shift) > 1e-6
    ]
    return {"changes": moved, "reached": reached, "gives": gives, "by": "derivatives"}


def _least(cost: Any, enough: Any, lacking: float, ends: tuple[Any, Any], reach: float) -> Any:
    """Shifts of least cost with enough . shifts >= lacking; None where there are none. Each is up minus down."""
    both = np.concatenate([cost, -cost])
    rows, bounds = [np.ones(len(both))], [reach]
    if np.isfinite(lacking):
        rows.append(-np.concatenate([enough, -enough]))
        bounds.append(-lacking)
    room = [(0.0, max(one, 0.0)) for one in np.concatenate([ends[1], -ends[0]])]
    found = linprog(both, A_ub=np.array(rows), b_ub=bounds, bounds=room)
    return found.x[: len(cost)] - found.x[len(cost) :] if found.success else None


def by_family(
    folder: str, text: str, goal: Mapping[str, Any], pressed: Sequence[float] | None = None
) -> dict[str, Any]:
    """As by_law, from a family of designs of which this is one but for its numbers: the best of its whole range.

    pressed : force, charge and voltage of its press, where there is one, which correct what the family answers.
    InputError for a design of which the family is not.
    """
    family = _family(folder)
    _of_family(family, text, np.zeros(family.space.count))
    corrections = {}
    answered = answer(folder, text) if pressed is not None else None
    if answered is not None and pressed is not None:
        sizes = {key: abs(answered[name]["value"]) for name, key in OF_FAMILY.items()}
        corrections = corrections_by(sizes, dict(zip(OF_FAMILY.values(), np.abs(pressed), strict=True)))
    asked = Goal(OF_FAMILY[goal["enough"]], goal["target"], OF_FAMILY[goal["least"]])
    found = met_goal(family, asked, corrections)
    changes = _changes(family, found.place)
    return {"changes": changes, "reached": found.reached, "gives": found.enough[1], "by": "family"}


def answer(folder: str, text: str) -> dict[str, Any] | None:
    """Force, charge and voltage of a design by a family, {quantity: {"value", "error"}}, the error half of the interval
    on its larger side; None where the design is none of the family.
    """
    try:
        course = _family(folder).press_config(config_of(text))
    except InputError:
        return None
    found: dict[str, Any] = {"by": "family"}
    for name, key in OF_FAMILY.items():
        if key not in course.courses:
            return None
        value, (low, high) = course.courses[key][-1], course.interval[key]
        found[name] = {"value": float(value), "error": float(max(high[-1] - value, value - low[-1]))}
    return found


def along(folder: str, text: str, path: Sequence[str | int], values: Sequence[float]) -> list[dict[str, Any]]:
    """As softdot.studio.estimate.Estimator.along, by a family; none for values outside of it."""
    found = []
    for value in values:
        document = Document(text)
        document.set(path, value)
        one = answer(folder, document.text)
        if one is not None:
            found.append({"value": value, **{name: one[name] for name in QUANTITIES}})
    return found


@lru_cache(maxsize=1)
def _family(folder: str) -> Family:
    return load_family(Path(folder))


def _changes(family: Family, place: Any) -> list[list[Any]]:
    """Path and value of every number of a family at a place, within its ends."""
    found = []
    for one, at in zip(family.space.ranges, place, strict=True):
        value = min(max(float(f"{float(one.values(at)):.{DIGITS}g}"), one.low), one.high)
        found += [[list(key_path(key)), value] for key in one.keys]
    return found


def _of_family(family: Family, text: str, place: Any) -> None:
    """InputError unless a design is one of the family once its numbers are moved to a place."""
    document = Document(text)
    for path, value in _changes(family, place):
        document.set(path, value)
    family.press_config(config_of(document.text))

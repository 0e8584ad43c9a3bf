"""A goal that a tab asks for: enough of one quantity for the least of another, by numbers that may move."""

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from foundation.errors import InputError
from softdot.studio.design_facts import Json
from softdot.studio.document import dotted_key
from softdot.studio.estimate import QUANTITIES
from softdot.studio.response import number_at

MOST_NUMBERS = 40


@dataclass(frozen=True)
class DesignGoal:
    """enough : quantity whose size is to reach target, in its unit; least : quantity that is to be small. numbers : of
    each that may move its path, dotted key, present value and ends; empty for all those of a family.
    """

    enough: str
    target: float
    least: str
    numbers: tuple[Json, ...]

    def as_dict(self) -> Json:
        """For another process."""
        return asdict(self)


def design_goal(values: Mapping[str, Any], asked: Mapping[str, Any]) -> DesignGoal:
    """What a tab has asked for, {"enough", "target", "least", "numbers": [[path, low, high], ...]}. InputError."""
    enough, least = asked.get("enough"), asked.get("least")
    target: Any = asked.get("target")
    if enough not in QUANTITIES or least not in QUANTITIES or enough == least:
        raise InputError(f"a goal needs two of {', '.join(QUANTITIES)}")
    if type(target) not in (int, float) or not math.isfinite(target) or target <= 0:
        raise InputError(f"the goal is {target}: it must be a number above 0")
    numbers = []
    for path, low, high in asked.get("numbers", ())[:MOST_NUMBERS]:
        present, name = number_at(values, path), dotted_key(path)
        if any(type(end) not in (int, float) for end in (low, high)) or not 0 < low <= present <= high:
            raise InputError(f"{name} = {present:g}: cannot move between {low} and {high}")
        numbers.append({"path": path, "key": name, "present": present, "low": low, "high": high})
    return DesignGoal(enough, float(target), least, tuple(numbers))

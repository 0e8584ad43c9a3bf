"""How a press follows one number of a design: full presses at some of its values, one after the other."""

import math
import time
from collections.abc import Awaitable, Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from foundation.errors import InputError
from softdot.studio.design_facts import Json
from softdot.studio.document import Document, Key, dotted_key
from softdot.studio.processes import TaskRefused

POINTS = 7
REACH = 1.5
"""Values are asked for from the present one over this to the present one times this, where no others are."""
DRAWN = 33
"""Values at which a line is drawn."""
SAME = 1e-3
"""Relative difference below which a value is taken for the present one, so that it is not pressed again."""
QUEUE = "waiting", "loading"
"""Stages of a press that are told as they are; of others the number of the press is told."""


@dataclass(frozen=True)
class AskedResponse:
    """A number of a design with the values at which it is to be pressed, in order of size. present : its value now."""

    key: Key
    values: tuple[float, ...]
    present: float


def asked_response(values: Mapping[str, Any], key: Any, low: Any, high: Any) -> AskedResponse:
    """POINTS values from low to high, even in their ratios where all are above zero; the present one is among them.

    values : of the design. low, high : None for REACH around the present value. InputError.
    """
    present, name = number_at(values, key), dotted_key(key)
    if (low is None or high is None) and present <= 0:
        raise InputError(f"{name} = {present:g}: state from and to, as no range follows from this value")
    ends = [present / REACH if low is None else low, present * REACH if high is None else high]
    if any(type(end) not in (int, float) or not math.isfinite(end) for end in ends) or ends[0] >= ends[1]:
        raise InputError(f"{name} from {ends[0]} to {ends[1]}: must be two numbers, the smaller one first")
    found = [float(f"{one:.4g}") for one in spread(ends[0], ends[1], POINTS)]
    if ends[0] <= present <= ends[1]:
        found = [one for one in found if abs(one - present) > SAME * abs(present)] + [present]
    if type(present) is int:
        found = [round(one) for one in found]
    return AskedResponse(tuple(key), tuple(sorted(set(found))), present)


def spread(low: float, high: float, count: int) -> list[float]:
    """Numbers from low to high, even in their ratios where both are above zero."""
    shares = [number / (count - 1) for number in range(count)]
    if low > 0:
        return [low * (high / low) ** share for share in shares]
    return [low + share * (high - low) for share in shares]


def number_at(values: Mapping[str, Any], key: Any) -> float:
    """The number under a path of names and indices. InputError."""
    if not isinstance(key, list) or not key or any(type(part) not in (str, int) for part in key):
        raise InputError("there is no such key")
    place: Any = values
    try:
        for part in key:
            place = place[part]
    except (KeyError, IndexError, TypeError):
        raise InputError(f"{dotted_key(key)}: this design has no such key") from None
    if type(place) not in (int, float):
        raise InputError(f"{dotted_key(key)}: is not a number of this design")
    return float(place) if type(place) is float else place


async def response(
    press: Callable[..., Awaitable[Json]],
    text: str,
    asked: AskedResponse,
    known: Json | None,
    tell: Callable[[Json], None],
) -> Json:
    """Press a design at all values of a number, the nearest first; told of after every press.

    press : of a text, by work.press.full_load. known : its answer at the present value, None where that is pressed too.
    Points have value, force_N, charge_pC, voltage_V and warnings, or said, why there is no answer. MachineError.
    """
    points: dict[float, Json] = {} if known is None else {asked.present: known}
    wanted = sorted((one for one in asked.values if one not in points), key=lambda one: abs(one - asked.present))
    began = time.monotonic()
    for number, value in enumerate(wanted):
        left = (time.monotonic() - began) / number * (len(wanted) - number) if number else None
        words = f"{dotted_key(asked.key[-1:])} = {value:g}"
        progress = {"stage": "press", "done": number, "count": len(wanted), "left_s": left, "text": words}
        tell({"progress": progress})

        def on_way(told: Json, progress: Json = progress) -> None:
            stage = told["progress"]["stage"]
            tell({"progress": {**progress, "stage": stage if stage in QUEUE else "press"}})

        points[value] = await _point(press, text, asked.key, value, on_way)
        tell(_told(asked, points))
    return _told(asked, points)


async def _point(
    press: Callable[..., Awaitable[Json]], text: str, key: Key, value: float, tell: Callable[[Json], None]
) -> Json:
    try:
        document = Document(text)
        document.set(key, value)
        return await press(document.text, tell)
    except (InputError, TaskRefused) as error:
        return {"said": str(error)}


def _told(asked: AskedResponse, points: Mapping[float, Json]) -> Json:
    found = [{"value": value, **points[value]} for value in sorted(points)]
    about = {"key": dotted_key(asked.key), "path": list(asked.key), "present": asked.present}
    return {**about, "range": [asked.values[0], asked.values[-1]], "points": found, "count": len(asked.values)}


def drawn_values(ends: Sequence[float]) -> list[float]:
    """Values at which a line from end to end is drawn."""
    return spread(ends[0], ends[1], DRAWN)

"""What would mend a warning or a mistake: a change of one key, tried before it is offered."""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import Any

from foundation.errors import InputError
from softdot.config.default_design import with_default_design
from softdot.config.schema import Config
from softdot.config.toml import key_path, with_value
from solve.mechanisms.layers.film_yield import FILM_YIELD

KEY = r"([\w\-.\[\]\"]+)"
BOUND = re.compile(KEY + r" = \S+: must be (at least|at most|above|below|less than)\D*? ([\d.eE+-]+)")
MEANT = re.compile(KEY + r" is not a key; did you mean '([\w.]+)'\?")
GAP = re.compile(KEY + r" = \S+: leaves a gap of \S+ mm along \w at the pitch of ([\d.]+) mm")
MISSING = re.compile(r"(segment\.effector\.\w+_mm) is missing: ")
OF_THE_SEGMENT = 0.8
"""Size of an effector that has none."""
GAP_SHARE = 0.08
"""Of the pitch: 0.2 mm of 2.5 mm."""
SHARES = 0.95, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1
JUST_INSIDE = 1e-3
MOST = 8
"""Sentences for which changes are tried; each takes some checks of the design."""
Check = Callable[[Mapping[str, Any]], list[str]]
"""The warnings of a design; InputError for a mistake."""


def remedies(tables: Mapping[str, Any], told: Sequence[str], check: Check) -> list[dict[str, Any] | None]:
    """For each sentence about a design a change that does away with it: {"says", "changes": [[key, value], ...]}.

    A value of None takes its key out. None for a sentence that no single change mends, and for those after MOST.
    """
    tried = [_first_that_mends(tables, sentence, check) for sentence in told[:MOST]]
    return [*tried, *[None for _ in told[MOST:]]]


YIELDS = re.compile(r"the film's largest principal stress of \S+ MPa exceeds its yield stress of ([\d.e+-]+) MPa")
BEYOND = re.compile(r"the strain of ([\d.e+-]+) % in \w+ is beyond the fitted range of its material \(([\d.e+-]+) %\)")


def late_remedies(config: Config, warnings: Sequence[str]) -> list[dict[str, Any] | None]:
    """As remedies, for what only a press tells: the press with the change tells whether it was enough."""
    return [_late(config, sentence) for sentence in warnings]


def _late(config: Config, sentence: str) -> dict[str, Any] | None:
    """Let a film yield that would; press less deep where a strain is beyond the data, as strain grows with depth."""
    yields, beyond, depth = YIELDS.match(sentence), BEYOND.match(sentence), config.press.indentation_mm
    if yields is not None:
        film = {"name": FILM_YIELD.name, "component": "film", "parameters": {"yield_stress_MPa": float(yields[1])}}
        return {"says": "let the film yield", "changes": [[["mechanisms", len(config.mechanisms)], film]]}
    if beyond is not None and depth is not None:
        less = float(f"{depth * min(1.0, float(beyond[2]) / float(beyond[1])):.2g}")
        return {"says": f"press {less:g} mm deep", "changes": [[["press", "indentation_mm"], less]]}
    return None


def _first_that_mends(tables: Mapping[str, Any], sentence: str, check: Check) -> dict[str, Any] | None:
    for says, changes in _candidates(tables, sentence):
        with suppress(InputError, ValueError):
            if sentence not in _told(_changed(tables, changes), check):
                return {"says": says, "changes": changes}
    return None


def _told(tables: Mapping[str, Any], check: Check) -> list[str]:
    """Every sentence about a design: a mistake, or its warnings."""
    try:
        return check(tables)
    except InputError as error:
        return [str(error)]


def _changed(tables: Mapping[str, Any], changes: Sequence[Sequence[Any]]) -> Mapping[str, Any]:
    for key, value in changes:
        if value is not None:
            tables = with_value(tables, _written(key), value)
        else:
            *way, last = key
            tables = with_value(tables, _written(key), 0)  # a copy in which the way exists
            place: Any = tables
            for part in way:
                place = place[part]
            del place[last]
    return tables


def _written(key: Sequence[str | int]) -> str:
    """('dot', 'offset_mm', 1) -> 'dot.offset_mm[1]'."""
    return "".join(f"[{part}]" if isinstance(part, int) else f'."{part}"' for part in key).removeprefix(".")


def _candidates(tables: Mapping[str, Any], sentence: str) -> Iterator[tuple[str, list[list[Any]]]]:
    """Changes that might mend a sentence, the smallest first."""
    yield from _of_the_key(tables, sentence)
    whole = with_default_design(tables)
    press = whole.get("press", {})
    depth = press.get("indentation_mm", 0.3) if isinstance(press, dict) else None
    if "indentation" in sentence and isinstance(depth, int | float) and "force_N" not in press:
        for share in SHARES:
            value = float(f"{share * depth:.2g}")
            yield f"press {value:g} mm deep", [[["press", "indentation_mm"], value]]
    segment = whole.get("segment", {})
    held = segment.get("held_layers", ["effector", "medium1", "film"]) if isinstance(segment, dict) else []
    for layer in held if isinstance(held, list) else ():
        if layer in sentence:
            rest = [one for one in held if one != layer]
            yield f"do not hold the sides of {layer}", [[["segment", "held_layers"], rest]]
    if "holds nothing" in sentence:
        yield "let the sides free", [[["segment", "boundary"], "free"]]


def _of_the_key(tables: Mapping[str, Any], sentence: str) -> Iterator[tuple[str, list[list[Any]]]]:
    """A key beyond its bound, or one that is no key."""
    bound, meant = BOUND.match(sentence), MEANT.match(sentence)
    if bound is not None:
        key, word, limit = list(key_path(bound[1])), bound[2], float(bound[3].rstrip("."))
        inside = {"at least": limit, "at most": limit}.get(word, limit * (1 + JUST_INSIDE))
        if word in ("below", "less than"):
            inside = limit * (1 - JUST_INSIDE)
        elif word == "above" and limit == 0.0:
            inside = 0.1
        allowed = int(inside) if inside == int(inside) and word.startswith("at ") else inside
        yield f"set {bound[1]} to {allowed:g}", [[key, allowed]]
    if meant is not None:
        wrong = list(key_path(meant[1]))
        right = list(key_path(meant[2])) if "." in meant[2] else [*wrong[:-1], meant[2]]
        value: Any = tables
        for part in wrong:
            value = value[part]
        yield f"call it {meant[2]}", [[wrong, None], [right, value]]
    segment, missing = with_default_design(tables).get("segment", {}), MISSING.match(sentence)
    if missing is not None and isinstance(segment, dict):
        sides = [side for name in ("length_mm", "width_mm") if isinstance(side := segment.get(name), int | float)]
        size = float(f"{OF_THE_SEGMENT * min(sides, default=1.0):.2g}")
        yield f"set {missing[1]} to {size:g}", [[list(key_path(missing[1])), size]]
    gap = GAP.match(sentence)
    if gap is not None:
        size = float(f"{(1 - GAP_SHARE) * float(gap[2]):.3g}")
        yield f"set {gap[1]} to {size:g}", [[list(key_path(gap[1])), size]]
    first = sentence.split(" ", 1)[0]
    if (":" in sentence or "is not a key" in sentence) and re.fullmatch(KEY, first):
        yield f"take {first} out", [[list(key_path(first)), None]]

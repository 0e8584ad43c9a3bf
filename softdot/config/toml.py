"""TOML files, and dotted keys in their tables."""

import copy
import re
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from foundation.errors import InputError
from foundation.files import read_text

MOST_LEVELS = 100
"""Most levels of a dotted key or of nested brackets: far more than any table of softdot has."""


def read_toml(path: Path) -> dict[str, Any]:
    """The tables of a TOML file. InputError when it is missing, unreadable, not UTF-8 or not TOML."""
    return parse_toml(read_text(path, f"configuration '{path}'"), str(path))


def parse_toml(text: str, name: str) -> dict[str, Any]:
    """The tables of a TOML text. InputError with line and column when it is none."""
    try:
        tables = tomllib.loads(text)
    except RecursionError:
        raise InputError(f"configuration '{name}': brackets are nested too deeply") from None
    except ValueError as error:
        raise InputError(f"configuration '{name}': not valid TOML, {error}") from None
    if _deeper_than(tables, MOST_LEVELS):
        raise InputError(f"configuration '{name}': tables are nested more than {MOST_LEVELS} levels deep")
    return tables


def _deeper_than(tables: dict[str, Any], levels: int) -> bool:
    """Whether dictionaries and lists are nested more deeply; breadth first, as recursion would end in an error."""
    layer: list[Any] = [tables]
    for _ in range(levels):
        layer = [
            inner
            for item in layer
            if isinstance(item, dict | list)
            for inner in (item.values() if isinstance(item, dict) else item)
        ]
        if not layer:
            return False
    return True


KEY_PART = re.compile(r'(?:(?:^|\.)(?:"([^"]+)"|([^.\[\]"\s]+)))|\[(\d+)\]')


def key_path(key: str) -> tuple[str | int, ...]:
    """The path of a key: 'dot.offset_mm[1]' -> ('dot', 'offset_mm', 1); a name with a dot is quoted. ValueError."""
    parts: list[str | int] = []
    end = 0
    while end < len(key):
        match = KEY_PART.match(key, end)
        if match is None or (not parts and match[3]):
            raise ValueError("must be names joined by dots, with [0], [1], … for elements of lists")
        parts.append(int(match[3]) if match[3] else match[1] or match[2])
        end = match.end()
    if not parts:
        raise ValueError("must not be empty")
    return tuple(parts)


def leaves(tables: Mapping[str, Any], way: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], Any]]:
    """Path, as a tuple of keys, and value of everything in nested tables that is no table."""
    for name, value in tables.items():
        if isinstance(value, Mapping):
            yield from leaves(value, (*way, name))
        else:
            yield (*way, name), value


def with_value(tables: Mapping[str, Any], key: str, value: Any) -> dict[str, Any]:
    """A copy of the tables with one value set; missing tables on the way are made.

    InputError when the way leads through something that is no table, or to an element that a list does not have.
    """
    changed = copy.deepcopy(dict(tables))
    *way, last = key_path(key)
    place: Any = changed
    for number, part in enumerate(way):
        _require(place, part, key)
        if isinstance(part, str) and part not in place:
            place[part] = {}
            if isinstance([*way, last][number + 1], int):
                place[part] = []
        place = place[part]
    _require(place, last, key)
    place[last] = value
    return changed


def _require(place: Any, part: str | int, key: str) -> None:
    """InputError unless a name meets a table, and a number a list that has this element."""
    if isinstance(part, str) and not isinstance(place, dict):
        raise InputError(f"'{key}': the part before '{part}' is not a table in this file")
    if isinstance(part, int) and not isinstance(place, list):
        raise InputError(f"'{key}': the part before [{part}] is not a list in this file")
    if isinstance(part, int) and part >= len(place):
        has = f"has {len(place)}" if place else "is empty or absent in this file"
        raise InputError(f"'{key}': there is no element [{part}], the list {has}; write it out first")

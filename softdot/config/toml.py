"""TOML files, and dotted keys in their tables."""

import copy
import re
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from foundation.errors import InputError
from foundation.files import read_text

INCLUDE = "include"
"""Key of the files whose tables a configuration takes."""
MOST_LEVELS = 100
"""Most levels of a dotted key or of nested brackets: far more than any table of softdot has."""


def read_toml(path: Path) -> dict[str, Any]:
    """The tables of a TOML file and of those that it includes.

    InputError when one is missing, unreadable, not UTF-8 or not TOML.
    """
    tables = parse_toml(read_text(path, f"configuration '{path}'"), str(path))
    return with_included(tables, path) if INCLUDE in tables else tables


def with_included(tables: Mapping[str, Any], path: Path) -> dict[str, Any]:
    """Tables of a file with those of the files that it includes, its own values before theirs, lists joined.

    InputError for anything but a list of files beside it, and for one that includes others.
    """
    names = tables[INCLUDE]
    if not isinstance(names, list) or not all(isinstance(name, str) for name in names):
        raise InputError(f"{INCLUDE} = {names!r}: must be a list of files, such as ['material.toml']")
    whole = {key: value for key, value in tables.items() if key != INCLUDE}
    for name in reversed(names):
        other = parse_toml(read_text(path.parent / name, f"{INCLUDE}: '{name}'"), name)
        if INCLUDE in other:
            raise InputError(f"{INCLUDE}: '{name}' includes other files itself; name them in '{path}'")
        whole = _merged(other, whole)
    return whole


def _merged(below: Mapping[str, Any], above: Mapping[str, Any]) -> dict[str, Any]:
    """Tables of both, values of above before those of below, lists of tables joined."""
    both = {**below, **above}
    for key in below.keys() & above.keys():
        if isinstance(below[key], dict) and isinstance(above[key], dict):
            both[key] = _merged(below[key], above[key])
        elif isinstance(below[key], list) and isinstance(above[key], list) and key == "mechanisms":
            both[key] = [*above[key], *below[key]]
    return both


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

"""TOML files, dotted keys in their tables, and what they leave out of the default design.

A file that states all three thicknesses describes its whole stack: without [segment.effector] it has none. A file
that leaves one out starts from the default design: its thicknesses, its effector, the material of its medium 2. All
other keys of the default design are the defaults of the schema. Recordings are never completed: rig.toml says what
was built.

--set key=value: one value of the configuration from the command line.
"""

import copy
import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

from geometry.base import InputError
from geometry.files import read_text

DEEPEST = 100
"""Levels of a dotted key or of brackets: far more than any table of softdot has."""


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
    if _deeper_than(tables, DEEPEST):
        raise InputError(f"configuration '{name}': tables are nested more than {DEEPEST} levels deep")
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


PART = re.compile(r'(?:(?:^|\.)(?:"([^"]+)"|([^.\[\]"\s]+)))|\[(\d+)\]')


def parsed(key: str) -> tuple[str | int, ...]:
    """'dot.offset_mm[1]' -> ('dot', 'offset_mm', 1); a name with a dot stands in quotes. ValueError."""
    parts: list[str | int] = []
    end = 0
    while end < len(key):
        match = PART.match(key, end)
        if match is None or (not parts and match[3]):
            raise ValueError("must be names joined by dots, with [0], [1], … for elements of lists")
        parts.append(int(match[3]) if match[3] else match[1] or match[2])
        end = match.end()
    if not parts:
        raise ValueError("must not be empty")
    return tuple(parts)


def with_value(tables: Mapping[str, Any], key: str, value: Any) -> dict[str, Any]:
    """A copy of the tables with a value in one place; missing tables on the way are made.

    InputError when the way leads through something that is no table, or to an element that a list does not have.
    """
    changed = copy.deepcopy(dict(tables))
    *way, last = parsed(key)
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
    """A name needs a table, a number a list that has so many elements."""
    if isinstance(part, str) and not isinstance(place, dict):
        raise InputError(f"'{key}': the part before '{part}' is not a table in this file")
    if isinstance(part, int) and not isinstance(place, list):
        raise InputError(f"'{key}': the part before [{part}] is not a list in this file")
    if isinstance(part, int) and part >= len(place):
        has = f"has {len(place)}" if place else "is empty or absent in this file"
        raise InputError(f"'{key}': there is no element [{part}], the list {has}; write it out first")


THICKNESSES = {"medium1": "thickness_mm", "film": "thickness_um", "medium2": "thickness_mm"}
DOT_SIZES = {"standard", "base_diameter_mm", "height_mm", "radius_mm"}


@cache
def default_design() -> dict[str, Any]:
    """The tables of default.toml."""
    return parse_toml(files(__package__).joinpath("default.toml").read_text("utf-8"), "default.toml")


def completed(tables: Mapping[str, Any]) -> dict[str, Any]:
    """The tables of a file with what it leaves out of the default design; what is malformed stays as it is."""
    segment, dot = tables.get("segment", {}), tables.get("dot", {})
    if not isinstance(segment, dict) or not isinstance(dot, dict):
        return dict(tables)
    whole = dict(tables)
    default = default_design()["segment"]
    if not _states_its_stack(segment):
        filled = {name: {**default[name], **_table(segment, name)} for name in THICKNESSES}
        wrong = {name: table for name, table in segment.items() if not isinstance(table, dict) and name in THICKNESSES}
        whole["segment"] = {"effector": default["effector"], **segment, **filled, **wrong}
        if dot.get("shape") != "plate" and not DOT_SIZES & dot.keys():
            whole["dot"] = dot = {"standard": default_design()["dot"]["standard"], **dot}
    if segment.get("section") == "plane-strain" and "shape" not in dot:
        whole["dot"] = {"shape": "ridge", **dot}  # the default's cap has no slice
    return whole


def from_default(tables: Mapping[str, Any], config: Mapping[str, Any]) -> tuple[str, ...]:
    """Dotted keys of the default design that a file does not state and that hold in its configuration.

    tables : the file as read. config : the whole configuration as nested tables.
    """
    standard = ("dot", "standard")  # also where the schema leaves it open, and the dot is that of the default
    absent = (key for key in _leaves(default_design()) if _at(tables, key) is None)
    kept = [key for key in absent if _at(config, key) is not None or key == standard]
    dot = config.get("dot", {})
    if dot.get("shape") == "plate" or any(dot.get(size) is not None for size in DOT_SIZES):
        kept = [key for key in kept if key != standard or dot.get("standard") is not None]
    return tuple(".".join(key) for key in kept)


def _states_its_stack(segment: Mapping[str, Any]) -> bool:
    return all(key in _table(segment, name) for name, key in THICKNESSES.items())


def _table(tables: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    found = tables.get(name, {})
    return found if isinstance(found, dict) else {}


def _leaves(tables: Mapping[str, Any], way: tuple[str, ...] = ()) -> Iterator[tuple[str, ...]]:
    for name, value in tables.items():
        if isinstance(value, dict):
            yield from _leaves(value, (*way, name))
        else:
            yield (*way, name)


def _at(tables: Any, way: tuple[str, ...]) -> Any:
    """The value at a dotted key, None where there is none."""
    for name in way:
        tables = tables.get(name) if isinstance(tables, Mapping) else None
    return tables


def told(keys: Sequence[str], config: Mapping[str, Any]) -> str:
    """What came from the default design, in a line: its keys, or that all of it did."""
    return f"from the default design: {'everything' if tuple(keys) == from_default({}, config) else ', '.join(keys)}"


BARE_WORD = re.compile(r"[A-Za-z][\w-]*")


def with_settings(tables: Mapping[str, Any], settings: Sequence[str]) -> dict[str, Any]:
    """The tables with each 'dotted.key=value' put in its place, the value as TOML writes it.

    A bare word that is no TOML value counts as a text: quotes would need quotes of their own in a shell.
    InputError naming the flag.
    """
    changed = dict(tables)
    given: list[tuple[str | int, ...]] = []
    for setting in settings:
        key, equals, text = setting.partition("=")
        if not equals:
            raise InputError(f"--set {setting}: must be key=value, such as press.indentation_mm=0.2")
        try:
            way = parsed(key.strip())
            if any(way == earlier[: len(way)] for earlier in given):
                raise ValueError("this key, or one inside it, is given before; state each once")
            given.append(way)
            changed = with_value(changed, key.strip(), _value(text.strip()))
        except (InputError, ValueError) as error:
            raise InputError(f"--set {setting}: {error}") from None
    return changed


@contextmanager
def naming_the_flag(settings: Sequence[str]) -> Iterator[None]:
    """A refusal of a key that --set gave names the flag."""
    try:
        yield
    except InputError as error:
        for setting in settings:
            if str(error).startswith(setting.partition("=")[0].strip()):
                raise InputError(f"--set {setting}: {error}") from None
        raise


def _value(text: str) -> Any:
    try:
        read = tomllib.loads(f"value = {text}\n")
    except (ValueError, RecursionError):
        if BARE_WORD.fullmatch(text):
            return text
        raise ValueError("the value is not TOML; a text needs quotes, a list square brackets") from None
    if set(read) != {"value"}:
        raise ValueError("must be a single value")
    return read["value"]

"""What a configuration leaves out comes from the default design, and the summary says what did.

A file that states all three thicknesses describes its whole stack: without [segment.effector] it has none. A file
that leaves one out starts from the default design: its thicknesses, its effector, the material of its medium 2. All
other keys of the default design are the defaults of the schema. Recordings are never completed: rig.toml says what
was built.

--set key=value: one value of the configuration from the command line.
"""

import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cache
from importlib.resources import files
from typing import Any

from geometry.base import InputError
from softdot.config.toml import parse_toml, with_value

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
    for setting in settings:
        key, equals, text = setting.partition("=")
        if not equals:
            raise InputError(f"--set {setting}: must be key=value, such as press.indentation_mm=0.2")
        try:
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

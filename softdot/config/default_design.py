"""What a configuration leaves out of the default design.

A file that states all three thicknesses describes its whole stack: without [segment.effector] it has none. A file
that leaves one out starts from the default design: its thicknesses, its effector, the material of its medium 2. All
other keys of the default design are the defaults of the schema. Recordings are never completed: rig.toml says what
was built.
"""

from collections.abc import Mapping, Sequence
from functools import cache
from importlib.resources import files
from typing import Any

from softdot.config.toml import leaves, parse_toml

THICKNESSES = {"medium1": "thickness_mm", "film": "thickness_um", "medium2": "thickness_mm"}
"""Layer -> its key of the thickness; a segment that states all of them has a stack of its own."""
DOT_SIZES = {"standard", "base_diameter_mm", "height_mm", "radius_mm", "profile_csv"}
"""Keys that give a dot a size; with any of them the standard of the default dot is not taken."""
UNSIZED_DOTS = ("plate", "profile")


@cache
def default_design() -> dict[str, Any]:
    """The tables of default.toml."""
    return parse_toml(files(__package__).joinpath("default.toml").read_text("utf-8"), "default.toml")


def with_default_design(tables: Mapping[str, Any]) -> dict[str, Any]:
    """The tables of a file with all that it leaves out of the default design; malformed tables stay as they are."""
    segment, dot = tables.get("segment", {}), tables.get("dot", {})
    if not isinstance(segment, dict) or not isinstance(dot, dict):
        return dict(tables)
    whole = dict(tables)
    default = default_design()["segment"]
    if not _states_its_stack(segment):
        filled = {name: {**default[name], **_table(segment, name)} for name in THICKNESSES}
        wrong = {name: table for name, table in segment.items() if not isinstance(table, dict) and name in THICKNESSES}
        whole["segment"] = {"effector": default["effector"], **segment, **filled, **wrong}
        if dot.get("shape") not in UNSIZED_DOTS and not DOT_SIZES & dot.keys():
            whole["dot"] = dot = {"standard": default_design()["dot"]["standard"], **dot}
    if segment.get("section") == "plane-strain" and "shape" not in dot:
        whole["dot"] = {"shape": "ridge", **dot}  # the default's cap has no slice
    return whole


def keys_from_default(tables: Mapping[str, Any], config: Mapping[str, Any]) -> tuple[str, ...]:
    """Dotted keys of the default design that a file does not state and that hold in its configuration.

    tables : the file as read. config : the whole configuration as nested tables.
    """
    standard = ("dot", "standard")  # also where the schema leaves it open, and the dot is that of the default
    absent = (key for key, _ in leaves(default_design()) if _value_at(tables, key) is None)
    kept = [key for key in absent if _value_at(config, key) is not None or key == standard]
    dot = config.get("dot", {})
    if dot.get("shape") in UNSIZED_DOTS or any(dot.get(size) is not None for size in DOT_SIZES):
        kept = [key for key in kept if key != standard or dot.get("standard") is not None]
    return tuple(".".join(key) for key in kept)


def _states_its_stack(segment: Mapping[str, Any]) -> bool:
    """Whether a table [segment] gives all three thicknesses."""
    return all(key in _table(segment, name) for name, key in THICKNESSES.items())


def _table(tables: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    """The inner table of that name, empty where there is none."""
    found = tables.get(name, {})
    return found if isinstance(found, dict) else {}


def _value_at(tables: Any, way: tuple[str, ...]) -> Any:
    """The value at a dotted key, None where there is none."""
    for name in way:
        tables = tables.get(name) if isinstance(tables, Mapping) else None
    return tables


def default_design_line(keys: Sequence[str], config: Mapping[str, Any]) -> str:
    """A line that names the keys taken from the default design, or says that everything was."""
    return (
        f"from the default design: {'everything' if tuple(keys) == keys_from_default({}, config) else ', '.join(keys)}"
    )

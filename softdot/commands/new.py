"""softdot new: a configuration to start from, in which every key of the schema is explained in words.

What a template states stands there as it is; every other key is a comment with its default, or left out in short. The
text is made from the schema, so it cannot name a key that is gone or leave a new one out.
"""

import json
import sys
import textwrap
from argparse import Namespace
from collections.abc import Mapping
from importlib.resources import files
from typing import Any

from geometry.parameters import ActsWith
from softdot.config.schema import config_schema
from softdot.console import GOOD

JsonTable = dict[str, Any]

UNITS = {
    "_N_per_mm3": "N/mm³",
    "_pC_per_N": "pC/N",
    "_kg_m3": "kg/m³",
    "_g_cm3": "g/cm³",
    "_percent": "%",
    "_min": "min",
    "_MPa": "MPa",
    "_MOhm": "MΩ",
    "_deg": "degree",
    "_mm": "mm",
    "_um": "µm",
    "_pF": "pF",
    "_Hz": "Hz",
    "_N": "N",
    "_V": "V",
    "_g": "g",
    "_h": "h",
    "_s": "s",
}
"""Ending of a key -> its unit; the first that fits counts."""


def unit_of_key(key: str) -> str:
    """The unit that the ending of a key names, a dash for none."""
    return next((name for ending, name in UNITS.items() if key.endswith(ending)), "–")


def allowed_values(value: JsonTable) -> str:
    """The values that the schema of a key allows, in words."""
    if "$ref" in value or isinstance(value.get("additionalProperties"), dict):
        return "a table"
    if "anyOf" in value:
        return " or ".join(dict.fromkeys(allowed_values(one) for one in value["anyOf"] if one.get("type") != "null"))
    if "enum" in value or "const" in value:
        return ", ".join(f"`{toml_value(one)}`" for one in value.get("enum", [value.get("const")]))
    if value["type"] == "array":
        return _allowed_lists(value)
    words = {
        "number": "number",
        "integer": "whole number",
        "string": "text",
        "object": "table",
        "boolean": "true, false",
    }
    bounds = {"exclusiveMinimum": "above", "minimum": "at least", "exclusiveMaximum": "below", "maximum": "at most"}
    limits = [f"{word} {value[name]:g}" for name, word in bounds.items() if name in value]
    return " ".join([words[value["type"]], " and ".join(limits)]).strip()


def _allowed_lists(value: JsonTable) -> str:
    pieces = value.get("prefixItems")
    if pieces:
        return f"list of {len(pieces)}: " + "; ".join(dict.fromkeys(allowed_values(piece) for piece in pieces))
    if "$ref" in value["items"]:
        return "tables"
    least = ", at least one" if value.get("minItems") else ""
    return f"list{least}, each: {allowed_values(value['items'])}"


def toml_value(value: Any) -> str:
    """A value as TOML writes it on one line."""
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {toml_value(item)}" for key, item in value.items()) + " }"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(toml_value(item) for item in value) + "]"
    return json.dumps(value, ensure_ascii=False)


LINE_WIDTH = 110
TABLES = {
    "": "Config", "segment": "Segment", "segment.effector": "Effector", "segment.medium1": "Medium",
    "segment.film": "Film", "[segment.film.electrodes]": "Electrode", "segment.medium2": "Medium",
    "[segment.bonds]": "Bond", "array": "Array", "[array.grooves]": "Groove", "dot": "Dot", "press": "Press",
    "press.waveform": "Waveform", "readout": "Readout", "readout.amplifier": "Amplifier",
    "mesh": "MeshOptions", "[mechanisms]": "Mechanism",
    "fabrication": "Fabrication", "fabrication.casting.my-rubber": "CastingNumbers",
}  # fmt: skip
"""Table -> its definition in the schema; those in brackets may be repeated."""
HARMLESS_TABLES = {"mesh", "fabrication"}
"""Tables that change nothing while they are empty, so that their keys can be switched on one by one."""
MATERIALS_TEXT = """\
# Materials of your own: softdot list materials shows the built-in ones and their keys. A table with the name of a
# built-in material changes the constants that it states.
# [materials.my-rubber]
# model = "neo-hookean"
# youngs_modulus_MPa = 1.0
# poisson_ratio = 0.495
# density_kg_m3 = 1000.0"""


def command(chosen: Namespace) -> int:
    """Print the configuration of chosen.template, in short if chosen.short; 0."""
    sys.stdout.write(template_text(chosen.template, chosen.short))
    return GOOD


def template_text(name: str, short: bool = False) -> str:
    """The text of a whole configuration file made from a template. short : with the keys alone that it states."""
    from softdot.config.default_design import default_design
    from softdot.config.toml import parse_toml

    text = files("softdot.templates").joinpath(f"{name}.toml").read_text("utf-8")
    own = parse_toml(text, f"{name}.toml")
    values = _merge_tables(default_design(), own)
    if values["dot"].keys() & {"radius_mm", "base_diameter_mm"}:
        del values["dot"]["standard"]
    schema = config_schema()
    definitions = {**schema["$defs"], "Config": schema}
    head = [text.split("\n")[0], f"# Made by softdot new --template {name}; a key without # is stated, others show"]
    head[1] += " their default."
    if short:
        tables = [
            _short_table(title, definitions[kind], _stated_table(values, title)) for title, kind in TABLES.items()
        ]
        head[1] = f"# Made by softdot new --short --template {name}; without --short every other key is explained."
        return "\n\n".join(["\n".join(head), *(one for one in tables if one)]) + "\n"
    parts = ["\n".join(head)]
    parts += [_table(title, definitions[kind], _stated_table(values, title)) for title, kind in TABLES.items()]
    return "\n\n".join([*parts, MATERIALS_TEXT]) + "\n"


def _merge_tables(below: Mapping[str, Any], above: Mapping[str, Any]) -> dict[str, Any]:
    """The tables of both, those above in place of those below."""
    merged = dict(below)
    for key, value in above.items():
        both = isinstance(value, dict) and isinstance(merged.get(key), dict)
        merged[key] = _merge_tables(merged[key], value) if both else value
    return merged


def _stated_table(values: Mapping[str, Any], title: str) -> Mapping[str, Any] | None:
    """The values of a table, None where the template does not state it; of repeated tables the first."""
    found: Any = values
    for part in title.strip("[]").split(".") if title else ():
        found = found.get(part)
        if found is None:
            return None
    return found[0] if isinstance(found, list) else found  # type: ignore[no-any-return]


def _table(title: str, definition: JsonTable, values: Mapping[str, Any] | None) -> str:
    """The text of a table, its head and its keys; all of it a comment where values is None."""
    lines = [*_comment(definition["description"].strip().replace("\n", " "))] if title else []
    if title:
        lines.append(f"[{title}]" if values is not None or title in HARMLESS_TABLES else f"# [{title}]")
    for key, value in definition["properties"].items():
        if _is_table(value):
            continue
        lines += _comment(_key_remark(key, value, key in definition.get("required", [])))
        stated = values is not None and key in values
        shown = (
            toml_value(values[key])
            if stated and values
            else toml_value(value["default"])
            if _has_default(value)
            else "..."
        )
        lines.append(f"{'' if stated else '# '}{key} = {shown}")
    return "\n".join(lines)


def _short_table(title: str, definition: JsonTable, values: Mapping[str, Any] | None) -> str:
    """The stated keys of a table, each with its meaning behind it; "" where the template states none."""
    properties = definition["properties"]
    stated = {
        key: value for key, value in (values or {}).items() if key in properties and not _is_table(properties[key])
    }
    if not stated:
        return ""
    lines = {f"{key} = {toml_value(value)}": properties[key].get("description", "") for key, value in stated.items()}
    width = max(map(len, lines))
    return "\n".join(
        [*([f"[{title}]"] if title else []), *(f"{line:<{width}}  # {said}" for line, said in lines.items())]
    )


def _key_remark(key: str, value: JsonTable, required: bool) -> str:
    """The meaning of a key, its unit, allowed values and default."""
    measured = unit_of_key(key)
    said = [value.get("description", value["title"].lower()), f"unit {measured}" if measured != "–" else ""]
    said.append(f"allowed: {allowed_values(value)}".replace("`", ""))
    default = f"default {toml_value(value['default'])}" if _has_default(value) else "may be left out"
    said.append("required" if required else default)
    said += [acting_condition(value)] if acting_condition(value) else []
    return "; ".join(part for part in said if part)


def acting_condition(value: JsonTable) -> str:
    """The condition under which a key acts, in words; "" where it always does."""
    said = []
    for tags in value.get("x-acts-with", []):
        wanted: JsonTable = {key: tuple(one) if isinstance(one, list) else one for key, one in tags.items()}
        said.append(ActsWith(**wanted).words)
    return f"acts only {' and '.join(said)}" if said else ""


def _has_default(value: JsonTable) -> bool:
    return value.get("default") is not None


def _is_table(value: JsonTable) -> bool:
    """Whether a key has tables of its own."""
    inner = [value, *value.get("anyOf", []), value.get("items", {})]
    return any("$ref" in one for one in inner) or "$ref" in json.dumps(value.get("additionalProperties", {}))


def _comment(text: str) -> list[str]:
    return textwrap.wrap(text, LINE_WIDTH, initial_indent="# ", subsequent_indent="#   ")

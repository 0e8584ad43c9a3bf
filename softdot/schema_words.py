"""What the schema says of a key, in words: unit, bounds, a value as TOML."""

import json
from typing import Any

Json = dict[str, Any]

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


def unit(key: str) -> str:
    """The unit that the ending of a key names, a dash for none."""
    return next((name for ending, name in UNITS.items() if key.endswith(ending)), "–")


def allowed(value: Json) -> str:
    """What the schema allows, in words."""
    if "$ref" in value or isinstance(value.get("additionalProperties"), dict):
        return "a table"
    if "anyOf" in value:
        return " or ".join(dict.fromkeys(allowed(one) for one in value["anyOf"] if one.get("type") != "null"))
    if "enum" in value or "const" in value:
        return ", ".join(f"`{toml(one)}`" for one in value.get("enum", [value.get("const")]))
    if value["type"] == "array":
        return _allowed_list(value)
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


def _allowed_list(value: Json) -> str:
    pieces = value.get("prefixItems")
    if pieces:
        return f"list of {len(pieces)}: " + "; ".join(dict.fromkeys(allowed(piece) for piece in pieces))
    if "$ref" in value["items"]:
        return "tables"
    least = ", at least one" if value.get("minItems") else ""
    return f"list{least}, each: {allowed(value['items'])}"


def toml(value: Any) -> str:
    """A value as TOML writes it on one line."""
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {toml(item)}" for key, item in value.items()) + " }"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(toml(item) for item in value) + "]"
    return json.dumps(value, ensure_ascii=False)

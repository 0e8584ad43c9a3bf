"""softdot list: the built-in materials, Braille standards, mechanisms and amplifiers, with where they come from."""

import sys
from argparse import Namespace
from typing import Any

from softdot.console import GOOD
from softdot.json_files import json_text

ORIGIN_KEYS = ("model", "source", "confidence")


def command(chosen: Namespace) -> int:
    """Print the list that chosen.what names; 0."""
    entries = LISTS[chosen.what]()
    if chosen.json:
        sys.stdout.write(json_text({"format": f"softdot-{chosen.what}/1", chosen.what: entries}))
    else:
        print("\n".join(_entry_text(entry) for entry in entries))
    return GOOD


def _entry_text(entry: dict[str, Any]) -> str:
    """The text of an entry: name and kind on one line, then one line per remark."""
    head = [entry["name"], entry["is"]]
    values = ", ".join(f"{key} = {_value_text(value)}" for key, value in entry["values"].items())
    about = [f"    {key}: {entry[key]}" for key in ("components", "confidence", "source") if entry.get(key)]
    return "\n".join(["  ".join(head), *([f"    {values}"] if values else []), *about])


def _value_text(value: Any) -> str:
    return str(value) if isinstance(value, str) else json_text(value).replace("\n", "").replace("  ", "")


def _materials() -> list[dict[str, Any]]:
    from solve.materials.parameters import library_tables

    return [
        {
            "name": name, "is": table["model"],
            "values": {key: value for key, value in table.items() if key not in ORIGIN_KEYS},
            "confidence": table["confidence"], "source": table["source"],
        }
        for name, table in library_tables().items()
    ]  # fmt: skip


def _standards() -> list[dict[str, Any]]:
    from geometry.braille_standards import QUANTITIES, standard, standard_names

    found = [standard(name) for name in standard_names()]
    return [
        {
            "name": one.name, "is": one.title,
            "values": {key: size for key in QUANTITIES if (size := one.quantities[key].nominal_mm) is not None},
            "confidence": one.confidence, "source": one.source,
        }
        for one in found
    ]  # fmt: skip


def _mechanisms() -> list[dict[str, Any]]:
    from solve.mechanisms import MECHANISMS
    from solve.mechanisms.base import in_short

    return [
        {
            "name": name, "is": (kind.parameters.__doc__ or "").split("\n")[0],
            "values": {key: field.description or "" for key, field in kind.parameters.model_fields.items()},
            "components": ", ".join(in_short(kind.components)),
            "source": f"docs/mechanisms.md#{name}: equation, source and typical values",
        }
        for name, kind in MECHANISMS.items()
    ]  # fmt: skip


def _amplifiers() -> list[dict[str, Any]]:
    from solve.readout.part import ABOUT, amplifier_parts

    return [
        {
            "name": name, "is": part["is"],
            "values": {key: value for key, value in part.items() if key not in ABOUT}, "source": part["source"],
        }
        for name, part in amplifier_parts().items()
    ]  # fmt: skip


LISTS = {"materials": _materials, "standards": _standards, "mechanisms": _mechanisms, "amplifiers": _amplifiers}

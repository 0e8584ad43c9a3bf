"""What differs between designs, and what they give: rows of a table."""

from collections.abc import Mapping, Sequence
from typing import Any

from softdot.config.toml import leaves

LEFT_OUT = {"fabrication", "materials"}
"""Tables that a comparison leaves out: of materials the layer names which."""


def differences(before: Mapping[str, Any], after: Mapping[str, Any]) -> dict[str, Any]:
    """Dotted key -> value after, of all values that differ."""
    old, new = _leaves(before), _leaves(after)
    return {key: new.get(key) for key in {**new, **old} if old.get(key) != new.get(key)}


def design_words(before: Mapping[str, Any] | None, after: Mapping[str, Any] | None) -> str:
    """What distinguishes a design from another, such as medium1.thickness_mm = 0.47; empty where nothing does."""
    if before is None or after is None:
        return "a design before"
    changed = differences(before, after)
    words = [f"{key.removeprefix('segment.')} = {value}" for key, value in changed.items()]
    return ", ".join(words[:2]) + (f" and {len(words) - 2} more" if len(words) > 2 else "")


def _leaves(tables: Mapping[str, Any]) -> dict[str, Any]:
    return {".".join(way): value for way, value in leaves(tables) if way[0] not in LEFT_OUT}


NUMBERS = (
    ("reaction_force_N", "force at full load", "N"),
    ("film_charge_pC", "charge at full load", "pC"),
    ("open_circuit_voltage_V", "open-circuit voltage", "V"),
    ("readout_voltage_V", "voltage at the amplifier", "V"),
)


def compared(designs: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Rows {"label", "unit", "cells"}: first what they give at their last step, then every key in which they differ.

    designs : each with values (of the configuration) and numbers (of its press, None where it has none).
    """
    rows = [
        {"label": label, "unit": unit, "cells": [_last(design["numbers"], name) for design in designs]}
        for name, label, unit in NUMBERS
    ]
    errors = [(design["numbers"] or {}).get("uncertainty", {}).get("voltage_percent") for design in designs]
    rows.append({"label": "uncertainty of the voltage", "unit": "%", "cells": errors})
    strains = [((design["numbers"] or {}).get("film") or {}).get("max_principal_strain") for design in designs]
    rows.append({"label": "strain of the film", "unit": "%", "cells": [s and 100 * s for s in strains]})
    rows = [row for row in rows if any(cell is not None for cell in row["cells"])]
    stated = [_leaves(design["values"]) for design in designs]
    for key in dict.fromkeys(key for one in stated for key in one):
        cells = [one.get(key) for one in stated]
        if any(cell != cells[0] for cell in cells):
            rows.append({"label": key, "unit": "", "cells": cells})
    return rows


def _last(numbers: Mapping[str, Any] | None, name: str) -> float | None:
    values = (numbers or {}).get(name)
    return values[-1] if values else None

"""The lines of rig.toml that describe one run."""

import json
from collections.abc import Mapping


def run_text(
    file: str,
    label: str,
    drive: str,
    *,
    temperature_C: float | None = None,
    nuisance: Mapping[str, float] | None = None,
    noise: Mapping[str, float] | None = None,
) -> str:
    """A table [[runs]] with its sub-tables."""
    lines = ["[[runs]]", f"file = {_quoted(file)}", f"label = {_quoted(label)}", f"drive = {_quoted(drive)}"]
    if temperature_C is not None:
        lines.append(f"temperature_C = {temperature_C}")
    for name, table in (("nuisance", nuisance), ("noise", noise)):
        if table:
            lines += [f"[runs.{name}]", *(f"{_key(key)} = {value:.3g}" for key, value in table.items())]
    return "\n".join(lines) + "\n"


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)


def _key(name: str) -> str:
    return f'"{name}"' if "." in name else name

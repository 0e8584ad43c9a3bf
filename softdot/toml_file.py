"""Read a TOML file, or say in one sentence why not."""

import tomllib
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

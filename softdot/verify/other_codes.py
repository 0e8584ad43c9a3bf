"""What other codes computed once, with their version, their mesh and the command that does it again."""

import tomllib
from dataclasses import dataclass
from functools import cache
from importlib.resources import files


@dataclass(frozen=True)
class ByAnotherCode:
    """One number; source : code, version and mesh in words; command : of this project, that computes it again."""

    value: float
    source: str
    command: str


@cache
def references() -> dict[str, ByAnotherCode]:
    """All of them by name, from other_codes.toml."""
    tables = tomllib.loads(files(__package__).joinpath("other_codes.toml").read_text("utf-8"))
    return {name: ByAnotherCode(**table) for name, table in tables.items()}


def reference(name: str) -> ByAnotherCode:
    """One of them."""
    return references()[name]

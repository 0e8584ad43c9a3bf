"""Results that other codes computed once, with their version, mesh and the command that computes them again."""

import tomllib
from dataclasses import dataclass
from functools import cache
from importlib.resources import files


@dataclass(frozen=True)
class ByAnotherCode:
    """A number from another code. source : code, version and mesh in words. command : by which to compute it again."""

    value: float
    source: str
    command: str


@cache
def references() -> dict[str, ByAnotherCode]:
    """Results of other codes by name, from other_codes.toml."""
    tables = tomllib.loads(files(__package__).joinpath("other_codes.toml").read_text("utf-8"))
    return {name: ByAnotherCode(**table) for name, table in tables.items()}


def reference(name: str) -> ByAnotherCode:
    """The result of another code with this name. KeyError."""
    return references()[name]

"""The built-in materials and the search for a material by name."""

import tomllib
from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from typing import Any

from pydantic import TypeAdapter

from geometry.errors import InputError
from solve.materials.parameters import AnyMaterial, Material
from solve.nearest import nearest


@cache
def library_tables() -> dict[str, dict[str, Any]]:
    """The built-in materials as they stand in library.toml."""
    return tomllib.loads(files(__package__).joinpath("library.toml").read_text("utf-8"))


@cache
def library() -> dict[str, Material]:
    """The built-in materials by name."""
    adapter: TypeAdapter[Material] = TypeAdapter(AnyMaterial)
    return {name: adapter.validate_python(table) for name, table in library_tables().items()}


def find_material(name: str, own: Mapping[str, Material], key: str) -> Material:
    """A material by name, the user's own before the built-in ones.

    key : the configuration key that names it. InputError with the nearest name for an unknown one.
    """
    known = {**library(), **own}
    if name in known:
        return known[name]
    raise InputError(f"{key} = '{name}': no such material; {nearest(name, known)}")

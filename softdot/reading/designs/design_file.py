"""DESIGNS.toml: the configuration of an array, the axes along which it varies, and the rules of the search. [sweep] is
that of softdot sweep: it states what varies and which designs are tried first. [search] states what follows.
"""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Self

from pydantic import Field, ValidationError, model_validator

from foundation.errors import InputError
from geometry.parameters import Table
from softdot.arrays.case import ArrayCase
from softdot.config.default_design import with_default_design
from softdot.config.errors import sentence
from softdot.config.idle import take_out_idle
from softdot.config.loading import config_from
from softdot.config.schema import Config
from softdot.config.settings import naming_the_flag, with_settings
from softdot.config.toml import key_path, read_toml, with_value
from softdot.sweeps.space import Space, space_from


class ComparedDesign(Table):
    """A design that is pressed and read beside those that the search chooses."""

    name: Annotated[str, Field(min_length=1)] = Field(description="as it is called in table and picture")
    set: dict[str, Any] = Field({}, description="dotted keys with their values, instead of those of the file")


class DesignSearch(Table):
    """The rules by which a search goes on after the designs of [sweep]."""

    rounds: Annotated[int, Field(ge=0, le=100)] = Field(2, description="of designs that the search chooses")
    each: Annotated[int, Field(ge=1, le=100)] = Field(4, description="designs in each round")
    accuracy: Annotated[float, Field(gt=0.0, lt=1.0)] = Field(
        0.99, description="share of the characters that must be read"
    )
    repeats: Annotated[int, Field(ge=1, le=100)] = Field(
        2, description="readings of the text at each depth, each with other scatter, tremor and noise"
    )
    compared: tuple[ComparedDesign, ...] = Field((), description="designs beside those of the search")

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        names = [one.name for one in self.compared]
        for name in names:
            if names.count(name) > 1:
                raise ValueError(f"compared: '{name}' is the name of two designs")
        return self


class _SearchFile(Table):
    search: DesignSearch = DesignSearch()


@dataclass(frozen=True)
class TriedDesign:
    """A design that is tried. values : of the axes, or those that a compared design sets. config : None, with a reason,
    for a design that has no configuration.
    """

    name: str
    values: Mapping[str, Any]
    config: Config | None
    reason: str | None = None


@dataclass(frozen=True)
class DesignRequest:
    """The request of DESIGNS.toml. base : tables of the configuration. text : the file as written."""

    base: Mapping[str, Any]
    space: Space
    search: DesignSearch
    compared: tuple[TriedDesign, ...]
    text: str

    @property
    def first(self) -> list[TriedDesign]:
        """The designs that fill the space."""
        return [
            TriedDesign(f"design {number}", point.values, point.config, point.reason)
            for number, point in enumerate(self.space.points, 1)
        ]

    def chosen(self, number: int, row: Sequence[Any]) -> TriedDesign:
        """The design with these values of the axes. number : counted from 1 over all designs of the search."""
        pairs = zip(self.space.sweep.axes, row, strict=True)
        return design_with_values(
            self.base, f"design {number}", {key: value for axis, value in pairs for key in axis.names()}
        )

    def row(self, design: TriedDesign) -> list[Any]:
        """The values of the axes for a design of the search."""
        return [design.values[axis.names()[0]] for axis in self.space.sweep.axes]


def design_with_values(base: Mapping[str, Any], name: str, values: Mapping[str, Any]) -> TriedDesign:
    """The design with these values in the tables, or the reason for its refusal. InputError for a key without a
    table.
    """
    tables = tables_with_values(base, values)
    try:
        return TriedDesign(name, values, config_from(with_default_design(tables)))
    except InputError as error:
        return TriedDesign(name, values, None, str(error))


def tables_with_values(base: Mapping[str, Any], values: Mapping[str, Any]) -> dict[str, Any]:
    """The tables of a configuration with these values, without keys that do not act beside them.

    InputError for a key that leads nowhere.
    """
    tables = dict(base)
    for key, value in values.items():
        tables = with_value(tables, key, value)
    for key in values:
        take_out_idle(tables, key_path(key))
    return tables


def load_request(path: Path, settings: Sequence[str] = ()) -> DesignRequest:
    """Read and check DESIGNS.toml. InputError with one sentence for what is malformed, for an axis with a value that
    no design can have, for a compared design that cannot be, and for a configuration without an array.

    settings : 'dotted.key=value' after the file.
    """
    with naming_the_flag(settings):
        tables = with_settings(read_toml(path), settings)
        search = _search(tables)
        space = space_from({name: table for name, table in tables.items() if name != "search"})
    base = {name: table for name, table in tables.items() if name not in ("sweep", "search")}
    compared = tuple(_compared_design(base, number, one) for number, one in enumerate(search.compared))
    config = next(point.config for point in space.points if point.config is not None)
    ArrayCase(config).refuse_kernel()
    return DesignRequest(base, space, search, compared, path.read_text("utf-8-sig"))


def _search(tables: Mapping[str, Any]) -> DesignSearch:
    """The table [search]. InputError."""
    own = {"search": tables.get("search", {})}
    try:
        return _SearchFile.model_validate_json(json.dumps(own, default=str), strict=True).search
    except ValidationError as error:
        raise InputError(sentence(error, own, _SearchFile)) from None


def _compared_design(base: Mapping[str, Any], number: int, one: ComparedDesign) -> TriedDesign:
    """A compared design. InputError where it has no configuration."""
    where = f"search.compared[{number}]"
    try:
        found = design_with_values(base, one.name, one.set)
    except (InputError, ValueError) as error:
        raise InputError(f"{where}.set: {error}") from None
    if found.config is None:
        raise InputError(f"{where} = '{one.name}': {found.reason}")
    return found

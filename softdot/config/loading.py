"""A configuration read from its file, with every default and every used material filled in."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from foundation.errors import InputError
from geometry.stack import layers
from softdot.config.default_design import default_design, keys_from_default, with_default_design
from softdot.config.errors import refuse_absurd_numbers, sentence, without_round_off
from softdot.config.schema import Config
from softdot.config.settings import naming_the_flag, with_settings
from softdot.config.toml import read_toml
from solve.materials.parameters import find_material, library_tables
from solve.model import DEFAULT_INDENTATION_MM


def load_config(path: Path | str | None = None, settings: Sequence[str] = ()) -> Config:
    """Read a configuration, or the default one, with every default and every used material filled in.

    What the file leaves out of the default design comes from there. settings : 'dotted.key=value' after the file.
    InputError with one sentence for a file that cannot be read and for anything in it that is not allowed.

    >>> load_config().segment.film.thickness_um
    28.0
    """
    tables = with_settings(default_design() if path is None else read_toml(Path(path)), settings)
    with naming_the_flag(settings):
        config = config_from(with_default_design(tables))
    stated = tables if path is not None else with_settings({}, settings)
    config._from_default = keys_from_default(stated, config.model_dump(mode="json"))
    return config


def config_from(tables: Mapping[str, Any]) -> Config:
    """A complete configuration from the tables of a TOML file. InputError with one sentence."""
    tables = without_round_off(_with_layer_tables(with_built_in_constants(tables)))
    try:
        # JSON, because only there pydantic is strict about numbers and yet takes a list for a tuple
        config = Config.model_validate_json(json.dumps(tables, default=str), strict=True)
    except ValidationError as error:
        raise InputError(sentence(error, tables, Config)) from None
    refuse_absurd_numbers(tables)
    return with_implied_values(config)


def _with_layer_tables(tables: Mapping[str, Any]) -> dict[str, Any]:
    """The tables with an empty one for each missing layer, so that a message names the thickness and not the table."""
    filled = dict(tables)
    segment = filled.get("segment", {})
    if isinstance(segment, dict):
        filled["segment"] = {"medium1": {}, "film": {}, "medium2": {}, **segment}
    return filled


def with_built_in_constants(tables: Mapping[str, Any]) -> dict[str, Any]:
    """The tables, with the unstated constants of each material that overrides a built-in one of the same model."""
    own = tables.get("materials", {})
    if not isinstance(own, dict):
        return dict(tables)
    return {**tables, "materials": {name: _with_built_in_constants(name, table) for name, table in own.items()}}


def _with_built_in_constants(name: str, table: Any) -> Any:
    """A table of a material on top of the built-in material with its name, where both are of one model."""
    if not isinstance(table, dict):
        return table
    built_in = library_tables().get(name, {"model": "neo-hookean"})
    if table.get("model", built_in["model"]) != built_in["model"]:
        return table
    about = ("source", "confidence", "max_fitted_strain")
    return {**{key: value for key, value in built_in.items() if key not in about}, **table}


def with_implied_values(config: Config) -> Config:
    """The configuration with the materials it uses and the default indentation written out."""
    used = {layer.material for layer in layers(config.segment)}
    found = {name: find_material(name, config.materials, "material") for name in sorted(used)}
    press = config.press
    if press.indentation_mm is None and press.force_N is None:
        press = press.model_copy(update={"indentation_mm": DEFAULT_INDENTATION_MM})
    return config.model_copy(update={"materials": {**found, **config.materials}, "press": press})


def unused_material_warnings(config: Config) -> list[str]:
    """A warning for each material of the configuration that no layer is made of: its name may be mistyped."""
    used = {layer.material for layer in layers(config.segment)}
    return [f"materials.{name}: no layer is of this material" for name in config.materials if name not in used]

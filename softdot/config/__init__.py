"""The configuration: one schema for every command."""

import hashlib
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Self

from pydantic import Field, PrivateAttr, ValidationError, model_validator

from geometry.array.parameters import Array
from geometry.base import InputError
from geometry.fabrication.parameters import Fabrication
from geometry.parameters import Dot, Segment, Table
from geometry.stack import layers
from mesh.options import MeshOptions
from softdot.config.errors import refuse_absurd_numbers, sentence, without_round_off
from softdot.config.toml import completed, default_design, from_default, naming_the_flag, read_toml, with_settings
from solve.materials.parameters import AnyMaterial, Material, PiezoelectricFilm, find_material, library_tables
from solve.mechanisms import Mechanism, refuse_repeated
from solve.model import DEFAULT_INDENTATION_MM, Press, Readout


class Config(Table):
    """All that a command needs to know. Every number carries its unit in its key."""

    segment: Segment = Field(description="the sensor segment")
    materials: dict[str, AnyMaterial] = Field({}, description="materials beside or instead of the built-in ones")
    array: Array | None = Field(None, description="several segments side by side; leave out for one segment")
    dot: Dot = Field(Dot(), description="the rigid Braille dot")
    press: Press = Field(Press(), description="how the dot is pressed")
    readout: Readout | None = Field(None, description="the amplifier; leave out for open circuit")
    mesh: MeshOptions = Field(MeshOptions(), description="element sizes and mesher")
    mechanisms: tuple[Mechanism, ...] = Field((), description="physics beyond the baseline")
    fabrication: Fabrication = Field(Fabrication(), description="how the parts are made")
    seed: int = Field(0, ge=0, description="seed of everything random; in a run only the mesher is")

    _from_default: tuple[str, ...] = PrivateAttr(())

    @property
    def from_default(self) -> tuple[str, ...]:
        """Dotted keys of the default design that the file did not state."""
        return self._from_default

    def __eq__(self, other: object) -> bool:
        """Whether all values are equal, wherever they came from."""
        return isinstance(other, Config) and self.__dict__ == other.__dict__

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        if self.press.indentation_mm is not None and self.press.force_N is not None:
            raise ValueError(f"press.force_N = {self.press.force_N:g}: give either indentation_mm or force_N, not both")
        refuse_repeated(self.mechanisms)
        self.layer_materials()
        return self

    def layer_materials(self) -> dict[str, Material]:
        """Layer name -> material. InputError for an unknown one or one of the wrong kind."""
        return {layer.name: _fitting(layer.name, layer.material, self.materials) for layer in layers(self.segment)}


def _fitting(layer: str, name: str, own: Mapping[str, Material]) -> Material:
    """The material of a layer: piezoelectric for the film, not so for the media."""
    key = f"segment.{layer}.material"
    material = find_material(name, own, key)
    if isinstance(material, PiezoelectricFilm) != (layer == "film"):
        needs = "the film needs a piezoelectric-film" if layer == "film" else f"{layer} must not be one"
        raise InputError(f"{key} = '{name}': this material is of model '{material.model}'; {needs}")
    return material


def load_config(path: Path | str | None = None, settings: Sequence[str] = ()) -> Config:
    """Read a configuration, or the default one, with every default and every used material filled in.

    What the file leaves out of the default design comes from there. settings : 'dotted.key=value' after the file.
    InputError with one sentence for a file that cannot be read and for anything in it that is not allowed.

    >>> load_config().segment.film.thickness_um
    28.0
    """
    tables = with_settings(default_design() if path is None else read_toml(Path(path)), settings)
    with naming_the_flag(settings):
        config = config_from(completed(tables))
    stated = tables if path is not None else with_settings({}, settings)
    config._from_default = from_default(stated, config.model_dump(mode="json"))
    return config


def config_from(tables: Mapping[str, Any]) -> Config:
    """A complete configuration from the tables of a TOML file. InputError with one sentence."""
    tables = without_round_off(_with_parents(with_built_in_constants(tables)))
    try:
        # JSON, because only there pydantic is strict about numbers and yet takes a list for a tuple
        config = Config.model_validate_json(json.dumps(tables, default=str), strict=True)
    except ValidationError as error:
        raise InputError(sentence(error, tables, Config)) from None
    refuse_absurd_numbers(tables)
    return resolved(config)


def _with_parents(tables: Mapping[str, Any]) -> dict[str, Any]:
    """Empty tables for missing layers, so that a message names the thickness and not the table."""
    filled = dict(tables)
    segment = filled.get("segment", {})
    if isinstance(segment, dict):
        filled["segment"] = {"medium1": {}, "film": {}, "medium2": {}, **segment}
    return filled


def with_built_in_constants(tables: Mapping[str, Any]) -> dict[str, Any]:
    """A table that overrides a built-in material of the same model keeps the constants it does not state."""
    own = tables.get("materials", {})
    if not isinstance(own, dict):
        return dict(tables)
    return {**tables, "materials": {name: _overriding(name, table) for name, table in own.items()}}


def _overriding(name: str, table: Any) -> Any:
    if not isinstance(table, dict):
        return table
    built_in = library_tables().get(name, {"model": "neo-hookean"})
    if table.get("model", built_in["model"]) != built_in["model"]:
        return table
    about = ("source", "confidence", "max_fitted_strain")
    return {**{key: value for key, value in built_in.items() if key not in about}, **table}


def resolved(config: Config) -> Config:
    """The configuration with the materials it uses and the default indentation written out."""
    used = {layer.material for layer in layers(config.segment)}
    found = {name: find_material(name, config.materials, "material") for name in sorted(used)}
    press = config.press
    if press.indentation_mm is None and press.force_N is None:
        press = press.model_copy(update={"indentation_mm": DEFAULT_INDENTATION_MM})
    return config.model_copy(update={"materials": {**found, **config.materials}, "press": press})


def idle_materials(config: Config) -> list[str]:
    """A warning for each material of the user's own that no layer is of: its name may be mistyped."""
    used = {layer.material for layer in layers(config.segment)}
    return [f"materials.{name}: no layer is of this material" for name in config.materials if name not in used]


def config_hash(config: Config) -> str:
    """SHA-256 of the canonical text of the resolved configuration, in hexadecimal.

    How the parts are made is left out: it changes no press.

    >>> six, seven = load_config(None, ["press.load_steps=6"]), load_config(None, ["press.load_steps=7"])
    >>> config_hash(six) == config_hash(seven)
    False
    """
    tables = resolved(config).model_dump(mode="json", exclude={"fabrication"})
    text = json.dumps(tables, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()


def input_hash(config: Config) -> str:
    """SHA-256 of configuration and of the files of its waveform and mesh, where it names them: all that a user states
    of a press.
    """
    waveform = config.press.waveform
    file = Path(waveform.file) if waveform is not None and waveform.file is not None else None
    content = file.read_bytes() if file is not None and file.is_file() else b""
    if config.mesh.file is not None:
        from mesh.files.own import contents

        content += contents(config.mesh.file)
    return hashlib.sha256(config_hash(config).encode() + content).hexdigest()


def config_schema() -> dict[str, Any]:
    """JSON Schema (draft 2020-12): description, unit, bounds and default of every key.

    >>> config_schema()["$defs"]["Press"]["properties"]["load_steps"]["default"]
    6
    """
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **Config.model_json_schema()}

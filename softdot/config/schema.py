"""The configuration: one schema for every command."""

from collections.abc import Mapping
from typing import Any, Self

from pydantic import Field, PrivateAttr, model_validator

from foundation.errors import InputError
from geometry.array.parameters import Array
from geometry.fabrication.parameters import Fabrication
from geometry.parameters import Dot, Segment, Table
from geometry.stack import layers
from mesh.options import MeshOptions
from solve.materials.parameters import AnyMaterial, Material, PiezoelectricFilm, find_material
from solve.mechanisms import Mechanism, refuse_repeated
from solve.model import Press, Readout

INCLUDE_KEY = {
    "title": "Include", "type": "array", "items": {"type": "string"}, "default": [],
    "description": "files beside this one whose tables it takes, such as material.toml of softdot material",
}  # fmt: skip
"""The key that is gone once a file is read."""


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
        return {
            layer.name: _layer_material(layer.name, layer.material, self.materials) for layer in layers(self.segment)
        }


def _layer_material(layer: str, name: str, own: Mapping[str, Material]) -> Material:
    """The material of a layer: a piezoelectric one for the film, another one for the media. InputError."""
    key = f"segment.{layer}.material"
    material = find_material(name, own, key)
    if isinstance(material, PiezoelectricFilm) != (layer == "film"):
        needs = "the film needs a piezoelectric-film" if layer == "film" else f"{layer} must not be one"
        raise InputError(f"{key} = '{name}': this material is of model '{material.model}'; {needs}")
    return material


def config_schema() -> dict[str, Any]:
    """JSON Schema (draft 2020-12): description, unit, bounds and default of every key.

    >>> config_schema()["$defs"]["Press"]["properties"]["load_steps"]["default"]
    6
    """
    schema = {"$schema": "https://json-schema.org/draft/2020-12/schema", **Config.model_json_schema()}
    schema["properties"] = {"include": INCLUDE_KEY, **schema["properties"]}
    return schema

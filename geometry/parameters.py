"""The parameters of a segment and of the dot, as the configuration writes them.

Origin: centre of the base of medium 2. x along the length, y along the width,
z from the base towards the dot. Lengths in millimetres, the film in micrometres.
"""

import json
from collections.abc import Mapping, Sequence
from typing import Annotated, Any, Literal, Self

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    GetJsonSchemaHandler,
    SerializerFunctionWrapHandler,
    model_serializer,
    model_validator,
)
from pydantic_core import CoreSchema

Positive = Annotated[float, Field(gt=0, allow_inf_nan=False)]
NonNegative = Annotated[float, Field(ge=0, allow_inf_nan=False)]
# beyond 1e6 (a glue of 1 GPa and 1 um) a bond is as good as perfect, and round-off would rule
BondStiffness = Annotated[float, Field(gt=0, le=1e6)]
Finite = Annotated[float, Field(allow_inf_nan=False)]
LayerName = Literal["effector", "medium1", "film", "medium2"]


STATED: Literal["stated"] = "stated"
ABSENT: Literal["absent"] = "absent"
JsonSchema = dict[str, Any]


class ActsWith:
    """The condition on which a key acts: a key named here has one of these values, is STATED at all, or is ABSENT.

    Annotated[NonNegative, ActsWith(shape=("ramp", "trapezoid"))] is the type of a key that acts with two shapes. It is
    the member of a tagged union to which the key belongs, said at the key. Classes of their own for all members would
    say the same, but a segment would need one for each boundary, and whoever reads segment.boundary would have to
    distinguish them; here all members are one class, whose other keys hold their defaults.
    """

    def __init__(self, needed: bool = False, **tags: tuple[str, ...] | Literal["stated", "absent"]) -> None:
        """tags : key -> values with which this one acts. needed : whether the key must be stated where it acts."""
        self.tags, self.needed = tags, needed

    def holds(self, values: Mapping[str, Any]) -> bool:
        """Whether the key acts beside the values of a table."""
        return any(self._is_wanted(values[key], wanted) for key, wanted in self.tags.items())

    @staticmethod
    def _is_wanted(value: Any, wanted: tuple[str, ...] | str) -> bool:
        if isinstance(wanted, tuple):
            return value in wanted
        return (value is not None) == (wanted == STATED)

    @property
    def words(self) -> str:
        """The condition in words, for example "with shape = 'ramp' or 'trapezoid'"."""
        return " or ".join(self._tag_text(key, wanted) for key, wanted in self.tags.items())

    @staticmethod
    def _tag_text(key: str, wanted: tuple[str, ...] | str) -> str:
        if isinstance(wanted, tuple):
            return f"with {key} = {' or '.join(repr(one) for one in wanted)}"
        return f"with{'' if wanted == STATED else 'out'} {key}"

    def stated_tags(self, table: BaseModel) -> str:
        """The values of the tags in a table, for example "shape = 'half-sine'"; empty where one is missing."""
        stated = {key: getattr(table, key) for key in self.tags}
        tables = {key for key, value in stated.items() if isinstance(value, BaseModel)}
        shown = (f"{key} = {value!r}" for key, value in stated.items() if value is not None and key not in tables)
        return ", ".join([*shown, *(f"[{key}] is stated" for key in stated if key in tables)])

    def condition(self, defaults: JsonSchema) -> JsonSchema:
        """The condition as JSON Schema of the whole table. defaults : of its keys, which need not be stated."""
        return {"anyOf": [self._tag_condition(key, wanted, defaults.get(key)) for key, wanted in self.tags.items()]}

    @staticmethod
    def _tag_condition(key: str, wanted: tuple[str, ...] | str, default: Any) -> JsonSchema:
        if isinstance(wanted, tuple):
            one_of: JsonSchema = {"properties": {key: {"enum": list(wanted)}}}
            return one_of if default in wanted else {**one_of, "required": [key]}
        stated = {"required": [key], "properties": {key: {"not": {"type": "null"}}}}
        return stated if wanted == STATED else {"not": stated}

    def __get_pydantic_json_schema__(self, core: CoreSchema, handler: GetJsonSchemaHandler) -> JsonSchema:
        """The schema of the key with the tags that it acts with, as "x-acts-with"."""
        made = handler(core)
        return {**made, "x-acts-with": [*made.get("x-acts-with", []), self.tags]}


def _message_value(value: Any) -> str:
    """A value as messages show it."""
    if isinstance(value, float):
        return f"{value:g}"
    return repr(value) if isinstance(value, str) else json.dumps(value, default=str)


class Table(BaseModel):
    """A configuration table: unknown keys are refused, and so are those that do not act beside the others.

    Values cannot change after reading. What does not act is not written either: whatever is written can be read.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, strict=False)

    @classmethod
    def conditional_keys(cls) -> list[tuple[str, ActsWith]]:
        """Name and condition of the keys that act beside some others only, once for each condition."""
        fields = cls.model_fields.items()
        return [(name, one) for name, field in fields for one in field.metadata if isinstance(one, ActsWith)]

    @classmethod
    def override_keys(cls, inherited: Mapping[str, Any], stated: Mapping[str, Any]) -> dict[str, Any]:
        """Inherited keys with the stated ones in their place, without inherited keys that no longer act."""
        merged = {**inherited, **stated}
        values = {**{name: field.default for name, field in cls.model_fields.items()}, **merged}
        idle = {name for name, acts in cls.conditional_keys() if name not in stated and not acts.holds(values)}
        return {name: value for name, value in merged.items() if name not in idle}

    def lacks(self, name: str) -> bool:
        """Whether a needed key is missing."""
        return getattr(self, name) is None

    @model_validator(mode="after")
    def _refuse_idle_keys(self) -> Self:
        for name, acts in self.conditional_keys():
            value = getattr(self, name)
            if name in self.model_fields_set and value is not None and not acts.holds(self.__dict__):
                here = acts.stated_tags(self)
                raise ValueError(
                    f"{name} = {_message_value(value)}: acts only {acts.words}{f', here {here}' if here else ''}"
                )
        for name, acts in self.conditional_keys():
            if acts.needed and self.lacks(name) and acts.holds(self.__dict__):
                raise ValueError(f"{name} is missing: {acts.stated_tags(self)} needs it")
        return self

    @model_serializer(mode="wrap")
    def _write_acting_keys(self, write: SerializerFunctionWrapHandler) -> dict[str, Any]:
        idle = {name for name, acts in self.conditional_keys() if not acts.holds(self.__dict__)}
        return {name: value for name, value in write(self).items() if name not in idle}

    @classmethod
    def __get_pydantic_json_schema__(cls, core: CoreSchema, handler: GetJsonSchemaHandler) -> JsonSchema:
        """The JSON Schema of the table, with the conditions of the keys that act beside some others only."""
        made = handler(core)
        table = handler.resolve_ref_schema(made)
        defaults = {name: field.default for name, field in cls.model_fields.items()}
        for name, acts in cls.conditional_keys():
            condition = acts.condition(defaults)
            conditions = table.setdefault("dependentSchemas", {}).setdefault(name, {"allOf": []})
            conditions["allOf"].append(condition)
            if acts.needed:
                table.setdefault("allOf", []).append({"if": condition, "then": {"required": [name]}})
        return made


def require_one_of_each(per: str, **lists: Sequence[float]) -> None:
    """Raise ValueError where one of the lists of a table, given by their keys, is not as long as the first."""
    (first, known), *others = lists.items()
    for name, values in others:
        if len(values) != len(known):
            raise ValueError(f"{name} has {len(values)} values but {first} has {len(known)}: one of each per {per}")


class Effector(Table):
    """The protruding part that touches the dot."""

    shape: Literal["layer", "block", "cylinder", "dome"] = Field(
        "layer", description="layer covers the whole footprint; block, cylinder and dome stand on medium 1"
    )
    height_mm: Positive = Field(1.0, description="height above medium 1")
    length_mm: Annotated[Positive | None, ActsWith(shape=("block",))] = Field(None, description="size in x")
    width_mm: Annotated[Positive | None, ActsWith(shape=("block",))] = Field(None, description="size in y")
    diameter_mm: Annotated[Positive | None, ActsWith(shape=("cylinder", "dome"))] = Field(
        None, description="diameter of the base"
    )
    material: str = Field("rubber", description="name of a material")


class Medium(Table):
    """One elastic layer over the whole footprint."""

    thickness_mm: Positive = Field(description="thickness in z")
    material: str = Field("vnr", description="name of a material")


RECTANGLE = ActsWith(needed=True, shape=("rectangle",))
CIRCLE = ActsWith(needed=True, shape=("circle",))
POLYGON = ActsWith(needed=True, shape=("polygon",))
Place = tuple[Finite, Finite]


class Electrode(Table):
    """A piece of metal on the film; charge is collected under it only."""

    name: str = Field(description="name shown in the results")
    shape: Literal["rectangle", "circle", "polygon"] = Field("rectangle", description="outline of the metal")
    center_mm: Annotated[Place, ActsWith(shape=("rectangle", "circle"))] = Field(
        (0.0, 0.0), description="centre, x and y"
    )
    size_mm: Annotated[tuple[Positive, Positive] | None, RECTANGLE] = Field(None, description="size in x and y")
    radius_mm: Annotated[Positive | None, CIRCLE] = Field(None, description="radius of the circle")
    corners_mm: Annotated[tuple[Place, ...] | None, POLYGON] = Field(
        None, description="corners in order, x and y of each"
    )


class Film(Table):
    """The piezoelectric film between medium 1 and medium 2."""

    thickness_um: Positive = Field(description="thickness in micrometres")
    material: str = Field("pvdf", description="name of a piezoelectric-film material")
    draw_angle_deg: Finite = Field(0.0, description="draw direction (axis 1) against x, about z")
    electrodes: tuple[Electrode, ...] = Field((), description="none: one electrode on the whole interface")


class Bond(Table):
    """A compliant bond line between two neighbouring layers."""

    between: tuple[LayerName | Literal["base"], LayerName | Literal["base"]] = Field(
        description="two neighbouring layers, or medium2 and base"
    )
    normal_stiffness_N_per_mm3: BondStiffness = Field(description="traction per opening")
    shear_stiffness_N_per_mm3: BondStiffness = Field(description="traction per slip")


class Segment(Table):
    """The sensor segment: a stack of layers on a fixed base."""

    length_mm: Positive = Field(2.5, description="size in x")
    width_mm: Positive = Field(
        2.5, description="size in y; with plane-strain, the width to which force and charge are scaled"
    )
    section: Literal["solid", "plane-strain"] = Field(
        "solid", description="plane-strain: one thin slice without strain in y"
    )
    boundary: Literal["free", "clamped", "elastic"] = Field("clamped", description="what the case does to the sides")
    held_layers: Annotated[tuple[LayerName, ...], ActsWith(boundary=("clamped", "elastic"))] = Field(
        ("effector", "medium1", "film"), description="layers whose sides the case holds"
    )
    side_stiffness_N_per_mm3: Annotated[NonNegative, ActsWith(boundary=("elastic",))] = Field(
        5.0, description="normal and tangential traction per displacement of the held sides"
    )
    effector: Effector | None = Field(None, description="leave the table out for a segment without effector")
    medium1: Medium
    film: Film
    medium2: Medium
    bonds: tuple[Bond, ...] = Field((), description="compliant bonds; none: perfect")


SIZED_DOTS = ("cap", "ridge")
"""Dots that radius and height describe."""
ROUND = ActsWith(shape=SIZED_DOTS)


class Dot(Table):
    """The rigid object that is pressed onto the segment."""

    shape: Literal["cap", "ridge", "plate", "profile"] = Field(
        "cap", description="cap: spherical, on a plate; ridge: a cylinder along y; plate: flat; profile: measured"
    )
    profile_csv: Annotated[str | None, ActsWith(needed=True, shape=("profile",))] = Field(
        None, description="CSV file with radius_mm and height_mm (or _um), from the tip to the plate"
    )
    standard: Annotated[str | None, ROUND] = Field(None, description="Braille standard whose nominal sizes are used")
    base_diameter_mm: Annotated[Positive | None, ROUND] = Field(None, description="with height_mm: explicit size")
    height_mm: Annotated[Positive | None, ROUND] = Field(None, description="height of the dot over its plate")
    radius_mm: Annotated[Positive | None, ROUND] = Field(
        None, description="radius of the sphere or cylinder instead of base_diameter_mm"
    )
    offset_mm: tuple[Finite, Finite] = Field((0.0, 0.0), description="position of the pressed dot, x and y")
    tilt_deg: tuple[Finite, Finite] = Field((0.0, 0.0), description="rotation of the dot about x and y")
    gap_mm: NonNegative = Field(0.0, description="gap between the dot at rest and its first touch")
    cell: str | None = Field(None, description="a Braille character: its other dots surround the pressed one")
    cell_dot: Annotated[int, Field(ge=1, le=8), ActsWith(cell=STATED)] = Field(
        1, description="which dot of the cell is pressed"
    )
    cell_heights_mm: Annotated[tuple[Positive, ...], ActsWith(cell=STATED)] = Field(
        (), description="height of each raised dot of the cell, in the order of their numbers; none: the standard's"
    )

    def lone(self, **changes: Any) -> Self:
        """The same dot without a cell; changes : of other keys."""
        return self.model_copy(update={"cell": None, "cell_dot": 1, "cell_heights_mm": (), **changes})

"""The parameters of a segment and of the dot, as the configuration writes them.

Origin: centre of the base of medium 2. x along the length, y along the width,
z from the base towards the dot. Lengths in millimetres, the film in micrometres.
"""

from collections.abc import Sequence
from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Field

Positive = Annotated[float, Field(gt=0, allow_inf_nan=False)]
NonNegative = Annotated[float, Field(ge=0, allow_inf_nan=False)]
# beyond 1e6 (a glue of 1 GPa and 1 um) a bond is as good as perfect, and round-off would rule
BondStiffness = Annotated[float, Field(gt=0, le=1e6)]
Finite = Annotated[float, Field(allow_inf_nan=False)]
LayerName = Literal["effector", "medium1", "film", "medium2"]


class Table(BaseModel):
    """A configuration table: unknown keys are refused, values cannot change after reading."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=False)


def require_one_of_each(per: str, **lists: Sequence[float]) -> None:
    """ValueError where one of the lists of a table, given by their keys, is not as long as the first."""
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
    length_mm: Positive | None = Field(None, description="block only: size in x")
    width_mm: Positive | None = Field(None, description="block only: size in y")
    diameter_mm: Positive | None = Field(None, description="cylinder and dome: diameter of the base")
    material: str = Field("rubber", description="name of a material")


class Medium(Table):
    """One elastic layer over the whole footprint."""

    thickness_mm: Positive = Field(description="thickness in z")
    material: str = Field("vnr", description="name of a material")


class Electrode(Table):
    """A rectangle of metal on the film; charge is collected under it only."""

    name: str = Field(description="name shown in the results")
    center_mm: tuple[Finite, Finite] = Field((0.0, 0.0), description="centre, x and y")
    size_mm: tuple[Positive, Positive] = Field(description="size in x and y")


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
    held_layers: tuple[LayerName, ...] = Field(
        ("effector", "medium1", "film"), description="layers whose sides the case holds (clamped, elastic)"
    )
    side_stiffness_N_per_mm3: NonNegative = Field(
        5.0, description="elastic only: normal and tangential traction per displacement of the held sides"
    )
    effector: Effector | None = Field(None, description="leave the table out for a segment without effector")
    medium1: Medium
    film: Film
    medium2: Medium
    bonds: tuple[Bond, ...] = Field((), description="compliant bonds; none: perfect")


class Dot(Table):
    """The rigid object that is pressed onto the segment."""

    shape: Literal["cap", "ridge", "plate"] = Field(
        "cap", description="cap: spherical, on a plate; ridge: a cylinder along y; plate: flat"
    )
    standard: str | None = Field(None, description="Braille standard whose nominal sizes are used")
    base_diameter_mm: Positive | None = Field(None, description="with height_mm: explicit size of a cap or ridge")
    height_mm: Positive | None = Field(None, description="height of the dot over its plate")
    radius_mm: Positive | None = Field(None, description="radius of the sphere or cylinder instead of base_diameter_mm")
    offset_mm: tuple[Finite, Finite] = Field((0.0, 0.0), description="position of the pressed dot, x and y")
    tilt_deg: tuple[Finite, Finite] = Field((0.0, 0.0), description="rotation of the dot about x and y")
    gap_mm: NonNegative = Field(0.0, description="gap between the dot at rest and its first touch")
    cell: str | None = Field(None, description="a Braille character: its other dots surround the pressed one")
    cell_dot: Annotated[int, Field(ge=1, le=8)] = Field(1, description="which dot of the cell is pressed")
    cell_heights_mm: tuple[Positive, ...] = Field(
        (), description="height of each raised dot of the cell, in the order of their numbers; none: the standard's"
    )

    def lone(self, **changes: Any) -> Self:
        """One dot of the same kind without a cell; changes : of other keys."""
        return self.model_copy(update={"cell": None, "cell_dot": 1, "cell_heights_mm": (), **changes})

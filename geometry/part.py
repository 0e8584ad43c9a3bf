"""A labelled, coloured solid of the assembly."""

from dataclasses import dataclass
from typing import Any

from geometry.colours import PART_COLOURS


@dataclass(frozen=True)
class Part:
    """One solid, with its label and colour set on the build123d shape as well.

    solid : build123d Solid in the segment frame, millimetres.
    colour : red, green, blue from 0 to 1.
    material : name of a material; None for a rigid part.
    rigid : not deformed by the press.
    printable : made on a 3D printer; soft layers are cast or cut.
    volume_mm3 : exact volume of the solid.
    """

    label: str
    solid: Any
    colour: tuple[float, float, float]
    material: str | None
    rigid: bool
    printable: bool
    volume_mm3: float


def labelled_part(label: str, solid: Any, material: str | None, printable: bool) -> Part:
    """A part from a build123d Solid; without a material it is rigid. Its label names its colour."""
    from build123d import Color

    code = PART_COLOURS[label].lstrip("#")
    red, green, blue = (int(code[k : k + 2], 16) / 255 for k in (0, 2, 4))
    solid.label, solid.color = label, Color(red, green, blue)
    return Part(label, solid, (red, green, blue), material, material is None, printable, volume_mm3(solid))


def volume_mm3(solid: Any) -> float:
    """Volume within 1e-9 of itself; solid.volume is 0.1 % off for caps near a hemisphere."""
    from OCP.BRepGProp import BRepGProp  # type: ignore[import-untyped]
    from OCP.GProp import GProp_GProps  # type: ignore[import-untyped]

    properties = GProp_GProps()
    BRepGProp.VolumeProperties_s(solid.wrapped, properties, 1e-9)
    return float(properties.Mass())

"""build123d solids of the deformable layers, each labelled and coloured. Lengths in millimetres."""

from dataclasses import dataclass
from typing import Any

from geometry.parameters import Segment
from geometry.stack import Box as BoxBody
from geometry.stack import Disc, Dome, bodies, layers


def layer_solids(segment: Segment, film_thickness_mm: float = 0.0) -> dict[str, Any]:
    """Solids by name, from medium2 upwards, with a film of the given thickness in mm.

    Without thickness there is no film: medium 1 and the effector lie directly on medium 2, moved down.
    """
    down = segment.film.thickness_um * 1e-3 - film_thickness_mm
    solids = {}
    for layer in layers(segment):
        if layer.name == "film" and film_thickness_mm == 0.0:
            continue
        bottom = layer.bottom_mm - (down if layer.name in ("medium1", "effector") else 0.0)
        top = layer.top_mm - (0.0 if layer.name == "medium2" else down)
        if layer.name == "effector":
            solids[layer.name] = _effector(segment, bottom)
        else:
            solids[layer.name] = upright_box(segment.length_mm / 2, segment.width_mm / 2, bottom, top)
    return solids


def upright_box(half_x: float, half_y: float, bottom: float, top: float) -> Any:
    """A box centred on the z axis, in mm."""
    from build123d import Plane, Solid

    return Solid.make_box(2 * half_x, 2 * half_y, top - bottom, Plane((-half_x, -half_y, bottom)))


def sphere(radius: float) -> Any:
    """A sphere about the origin whose poles lie aside on y: a pole at the top gives a degenerate facet."""
    from build123d import Rot, Solid

    return Rot(90, 0, 0) * Solid.make_sphere(radius, angle1=-90, angle2=90, angle3=360)


def upright_cylinder(radius: float, bottom: float, top: float) -> Any:
    """A cylinder on the z axis, in mm."""
    from build123d import Pos, Solid

    return Pos(0, 0, bottom) * Solid.make_cylinder(radius, top - bottom)


def _effector(segment: Segment, bottom: float) -> Any:
    """The effector of the exact outline, moved to stand at the given height."""
    from build123d import Pos

    body = bodies(segment)[-1]
    if isinstance(body, BoxBody):
        return upright_box(body.half_x, body.half_y, bottom, bottom + body.top - body.bottom)
    if isinstance(body, Disc):
        return upright_cylinder(body.radius, bottom, bottom + body.top - body.bottom)
    assert isinstance(body, Dome)
    reach = 2 * body.radius
    dome = (Pos(0, 0, body.centre_z) * sphere(body.radius)) & upright_box(reach, reach, body.bottom, body.top + reach)
    return Pos(0, 0, bottom - body.bottom) * dome.solid()


PART_COLOURS: dict[str, str] = {
    "medium2": "#9dbbd6",
    "film": "#b5263b",
    "medium1": "#7fbf9f",
    "effector": "#e9b872",
    "dot": "#8c929b",
    "case": "#d3d6da",
}
"""Hex colours; "dot" stands for the dots and their plate, "case" for whatever holds the sides."""


@dataclass(frozen=True)
class Part:
    """A labelled and coloured solid; label and colour are set on the build123d shape as well.

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
    """Volume in mm^3 within a relative 1e-9; solid.volume is 0.1 % off for caps near a hemisphere."""
    from OCP.BRepGProp import BRepGProp  # type: ignore[import-untyped]
    from OCP.GProp import GProp_GProps  # type: ignore[import-untyped]

    properties = GProp_GProps()
    BRepGProp.VolumeProperties_s(solid.wrapped, properties, 1e-9)
    return float(properties.Mass())

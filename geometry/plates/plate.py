"""A printable plate with dots: a slab on its foot, dots upwards."""

from collections.abc import Sequence
from copy import deepcopy
from dataclasses import dataclass
from typing import Any

from geometry.assembly import cap_solid
from geometry.dot_size import dot_size_from_base
from geometry.solids import Part, volume_mm3


@dataclass(frozen=True)
class PlacedDot:
    """One dot of a plate, in mm in the frame of the plate.

    x_mm, y_mm : its axis; base_z_mm : the face that it stands on.
    line, cell, dot : from 1, which dot of which cell; for a plate without text the cell counts the dots.
    """

    x_mm: float
    y_mm: float
    base_z_mm: float
    base_diameter_mm: float
    height_mm: float
    line: int = 1
    cell: int = 1
    dot: int = 1


@dataclass(frozen=True)
class Plate:
    """A plate or tip as it stands on the printer: z upwards, its foot at z = 0, its middle at x = y = 0.

    size_mm : (x, y, z) of the whole, dots included.
    """

    part: Part
    dots: tuple[PlacedDot, ...]
    size_mm: tuple[float, float, float]


PLATE_COLOUR = (0xE9 / 255, 0xDD / 255, 0xC7 / 255)
"""A colour between white and sand, on which the shadow of the dots is seen."""


def dotted_slab(
    size_xy_mm: tuple[float, float], thickness_mm: float, dots: Sequence[PlacedDot], corner_mm: float
) -> Plate:
    """A plate with its dots as one solid; its upper left corner is cut off, so that it is not read upside down."""
    solid = _slab_solid(size_xy_mm, thickness_mm, corner_mm).fuse(*standing_dots(dots)).solid()
    highest = max(dot.base_z_mm + dot.height_mm for dot in dots)
    return Plate(printed_part("plate", solid), tuple(dots), (*size_xy_mm, highest))


def standing_dots(dots: Sequence[PlacedDot]) -> list[Any]:
    """The dots, tips upwards, at their places: copies, because OCC leaves gaps where one shape is meshed twice."""
    from build123d import Pos

    shapes = {size: _upward_dot(*size) for size in {(dot.base_diameter_mm, dot.height_mm) for dot in dots}}
    return [
        Pos(dot.x_mm, dot.y_mm, dot.base_z_mm) * deepcopy(shapes[dot.base_diameter_mm, dot.height_mm]) for dot in dots
    ]


def printed_part(label: str, solid: Any) -> Part:
    """A rigid, printable part in the colour of plates."""
    from build123d import Color

    solid.label, solid.color = label, Color(*PLATE_COLOUR)
    return Part(label, solid, PLATE_COLOUR, None, True, True, volume_mm3(solid))


def _slab_solid(size_xy_mm: tuple[float, float], thickness_mm: float, corner_mm: float) -> Any:
    from build123d import Face, Solid, Vector, Wire

    x, y = size_xy_mm[0] / 2, size_xy_mm[1] / 2
    outline = [(-x, -y), (x, -y), (x, y), (corner_mm - x, y), (-x, y - corner_mm)]
    face = Face(Wire.make_polygon([Vector(px, py, 0) for px, py in outline]))
    return Solid.extrude(face, Vector(0, 0, thickness_mm))


def _upward_dot(base_diameter_mm: float, height_mm: float) -> Any:
    """One dot with its base at z = 0 and its tip upwards."""
    from build123d import Pos, Rot

    size = dot_size_from_base(base_diameter_mm, height_mm)
    return Pos(0, 0, height_mm) * Rot(180, 0, 0) * cap_solid(size.radius_mm, size.height_mm, size.foot_mm)


SLAB_THICKNESS_MM = 2.0
"""Stiff under a finger, and above the thinnest wall of every printer."""

"""A printable plate with dots: where each lies, the slab that carries them, and an indenter tip for a force gauge."""

from collections.abc import Sequence
from copy import deepcopy
from dataclasses import dataclass
from typing import Any

from geometry.assembly import cap_solid
from geometry.base import InputError
from geometry.braille import from_base
from geometry.solids import Part, upright_cylinder, volume_mm3


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
"""Between white and sand: dots throw a shadow that is seen."""


def dotted_slab(
    size_xy_mm: tuple[float, float], thickness_mm: float, dots: Sequence[PlacedDot], corner_mm: float
) -> Plate:
    """A plate with its dots as one solid; its upper left corner is cut, so that it is not read upside down."""
    solid = _slab(size_xy_mm, thickness_mm, corner_mm).fuse(*standing_dots(dots)).solid()
    highest = max(dot.base_z_mm + dot.height_mm for dot in dots)
    return Plate(printed_part("plate", solid), tuple(dots), (*size_xy_mm, highest))


def standing_dots(dots: Sequence[PlacedDot]) -> list[Any]:
    """The dots, tips upwards, at their places: copies, because OCC leaves gaps where one shape is meshed twice."""
    from build123d import Pos

    shapes = {size: _tip_up(*size) for size in {(dot.base_diameter_mm, dot.height_mm) for dot in dots}}
    return [
        Pos(dot.x_mm, dot.y_mm, dot.base_z_mm) * deepcopy(shapes[dot.base_diameter_mm, dot.height_mm]) for dot in dots
    ]


def printed_part(label: str, solid: Any) -> Part:
    """A rigid, printable part in the colour of plates."""
    from build123d import Color

    solid.label, solid.color = label, Color(*PLATE_COLOUR)
    return Part(label, solid, PLATE_COLOUR, None, True, True, volume_mm3(solid))


def _slab(size_xy_mm: tuple[float, float], thickness_mm: float, corner_mm: float) -> Any:
    from build123d import Face, Solid, Vector, Wire

    x, y = size_xy_mm[0] / 2, size_xy_mm[1] / 2
    outline = [(-x, -y), (x, -y), (x, y), (corner_mm - x, y), (-x, y - corner_mm)]
    face = Face(Wire.make_polygon([Vector(px, py, 0) for px, py in outline]))
    return Solid.extrude(face, Vector(0, 0, thickness_mm))


def _tip_up(base_diameter_mm: float, height_mm: float) -> Any:
    """One dot with its base at z = 0."""
    from build123d import Pos, Rot

    size = from_base(base_diameter_mm, height_mm)
    return Pos(0, 0, height_mm) * Rot(180, 0, 0) * cap_solid(size.radius_mm, size.height_mm, size.foot_mm)


POST_MM = 10.0
"""Diameter of the post; half of it is the thickness over the hole."""
CONE = 1.2
"""Height over radius of the cone that ends the hole: steeper than 45 degrees."""


@dataclass(frozen=True)
class GaugeThread:
    """A male thread of force gauges. hole_mm : diameter of the hole that is tapped; depth_mm : of the thread."""

    hole_mm: float
    depth_mm: float


THREADS = {
    "M6": GaugeThread(5.0, 10.0),
    "M4": GaugeThread(3.3, 8.0),
    "10-32": GaugeThread(4.04, 10.0),
}
"""Holes: nominal diameter less pitch for ISO coarse threads (ISO 2306), drill no. 21 for 10-32 UNF."""


def indenter_tip(base_diameter_mm: float, height_mm: float, thread: str = "M6") -> Plate:
    """A post, foot at z = 0, with a dot on its flat end and a blind hole for the thread of the gauge.

    The hole ends in a cone, so that it prints without a support. InputError for an unknown thread and for a dot
    wider than the post.
    """
    if thread not in THREADS:
        raise InputError(f"--thread = '{thread}': no such thread, known are {', '.join(THREADS)}")
    if base_diameter_mm >= POST_MM:
        raise InputError(f"base_diameter_mm = {base_diameter_mm:g}: must be less than the post of {POST_MM:g}")
    hole = THREADS[thread]
    top = hole.depth_mm + CONE * hole.hole_mm / 2 + POST_MM / 2
    dot = PlacedDot(0.0, 0.0, top, base_diameter_mm, height_mm)
    post = upright_cylinder(POST_MM / 2, 0.0, top).cut(_hole(hole)).solid()
    solid = post.fuse(*standing_dots([dot])).solid()
    return Plate(printed_part("tip", solid), (dot,), (POST_MM, POST_MM, top + height_mm))


def _hole(hole: GaugeThread) -> Any:
    """A cylinder with a cone on top, from below the foot."""
    from build123d import Pos, Solid

    radius, start = hole.hole_mm / 2, -1.0
    bore = upright_cylinder(radius, start, hole.depth_mm)
    cone = Pos(0, 0, hole.depth_mm) * Solid.make_cone(radius, 0.0, CONE * radius)
    return bore.fuse(cone).solid()

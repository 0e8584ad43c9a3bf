"""Printable plates: lines of Braille, single dots, dots that grow, and an indenter tip for a force gauge."""

from collections.abc import Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass
from typing import Any

from geometry.assembly import cap_solid
from geometry.base import InputError
from geometry.braille import COLUMN_AND_ROW, QUANTITIES, Quantity, QuantityName, from_base, raised_dots, standard
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


SHORTEST_MM, LONGEST_MM = 0.01, 1000.0
"""Between a fifth of the thinnest layer and more than any printer builds."""


@dataclass(frozen=True)
class BrailleSize:
    """One size in mm with where it comes from; basis: "nominal", "middle of the range", "minimum" or "given".

    deviation_mm : the smaller distance to a limit of the standard; None where it gives no limits.
    """

    value_mm: float
    basis: str
    source: str
    deviation_mm: float | None


@dataclass(frozen=True)
class BrailleSizes:
    """The sizes that one standard and the explicit sizes give together."""

    standard: str
    title: str
    known: Mapping[QuantityName, BrailleSize]

    def __getitem__(self, name: QuantityName) -> float:
        """A size in mm. InputError, which names the option, where neither the standard nor the user gives it."""
        if name not in self.known:
            raise InputError(
                f"--standard '{self.standard}': has no {name}; give it by --{name.replace('_', '-')} "
                "or choose another standard"
            )
        return self.known[name].value_mm


def braille_sizes(name: str, given: Mapping[QuantityName, float] | None = None) -> BrailleSizes:
    """The sizes of a standard by its name or alias; what is given (mm) comes first.

    Else the nominal size, else the middle of the range, else the minimum. InputError for an unknown standard
    and for a size that is no length of a plate.
    """
    found = standard(name, field="--standard")
    known = {key: size for key in QUANTITIES if (size := _size(found.quantities[key])) is not None}
    for key, value in (given or {}).items():
        require_length(f"--{key.replace('_', '-')}", value)
        known[key] = BrailleSize(value, "given", "the user", None)
    return BrailleSizes(found.name, found.title, known)


def require_length(option: str, value_mm: float) -> None:
    """InputError, which names the option, for a length that no solid is built with."""
    if not SHORTEST_MM <= value_mm <= LONGEST_MM:
        raise InputError(f"{option} = {value_mm:g}: must be from {SHORTEST_MM:g} to {LONGEST_MM:g} mm")


def _size(quantity: Quantity) -> BrailleSize | None:
    """What a plate takes from one quantity of the table."""
    nominal, low, high = quantity.nominal_mm, quantity.minimum_mm, quantity.maximum_mm
    if nominal is None:
        return None if low is None else BrailleSize(low, "minimum", quantity.source, None)
    sides = [abs(limit - nominal) for limit in (low, high) if limit is not None]
    basis = "middle of the range" if quantity.nominal_is_middle else "nominal"
    return BrailleSize(nominal, basis, quantity.source, min(sides) if any(sides) else None)


def lay_out(lines: Sequence[str], sizes: BrailleSizes, face_z_mm: float) -> tuple[PlacedDot, ...]:
    """The dots of lines of Unicode Braille cells, reading along +x, lines along -y, the block about the origin.

    InputError for other characters, for a size that is needed but unknown, and for dots that would overlap.
    """
    width, depth = block_mm(lines, sizes)
    check_spacing(lines, sizes)
    cell_pitch = sizes["cell_pitch_mm"] if max(map(len, lines)) > 1 else 0.0
    line_pitch = sizes["line_pitch_mm"] if len(lines) > 1 else 0.0
    pitch, base, height = sizes["dot_pitch_mm"], sizes["base_diameter_mm"], sizes["height_mm"]
    dots = []
    for row, line in enumerate(lines):
        for column, character in enumerate(line):
            for dot in raised_dots(character, field="text"):
                across, down = COLUMN_AND_ROW[dot]
                x = column * cell_pitch + across * pitch - width / 2
                y = depth / 2 - row * line_pitch - down * pitch
                dots.append(PlacedDot(x, y, face_z_mm, base, height, row + 1, column + 1, dot))
    if not dots:
        raise InputError("text: has no raised dot, there is nothing to print")
    return tuple(dots)


def block_mm(lines: Sequence[str], sizes: BrailleSizes) -> tuple[float, float]:
    """Distance in x and y between the axes of the outermost dot places, raised or not."""
    cells, pitch = max(map(len, lines)), sizes["dot_pitch_mm"]
    width = pitch + (cells - 1) * (sizes["cell_pitch_mm"] if cells > 1 else 0.0)
    depth = _rows(lines) * pitch + (len(lines) - 1) * (sizes["line_pitch_mm"] if len(lines) > 1 else 0.0)
    return width, depth


def check_spacing(lines: Sequence[str], sizes: BrailleSizes) -> None:
    """InputError where neighbouring dots, cells or lines would run into each other."""
    base, pitch = sizes["base_diameter_mm"], sizes["dot_pitch_mm"]
    _require_room("dot_pitch_mm", pitch, base)
    if max(map(len, lines)) > 1:
        _require_room("cell_pitch_mm", sizes["cell_pitch_mm"], pitch + base)
    if len(lines) > 1:
        _require_room("line_pitch_mm", sizes["line_pitch_mm"], _rows(lines) * pitch + base)


def _require_room(name: str, value: float, least: float) -> None:
    if value <= least:
        raise InputError(f"{name} = {value:g}: neighbouring dots would touch, must be more than {least:g}")


def _rows(lines: Sequence[str]) -> int:
    """Dot pitches from the top to the bottom of a cell: three where dot 7 or 8 is used, else two."""
    used = {dot for line in lines for character in line for dot in raised_dots(character, field="text")}
    return 3 if used & {7, 8} else 2


THICKNESS_MM = 2.0
"""Stiff under a finger, and above the thinnest wall of every printer."""
MARGIN_MM = 5.0
"""From the base of the outermost dot places to the edge: room for a clamp."""


def text_plate(
    lines: Sequence[str], sizes: BrailleSizes, thickness_mm: float = THICKNESS_MM, margin_mm: float = MARGIN_MM
) -> Plate:
    """The plate of lines of Unicode Braille cells (U+2800 to U+28FF). InputError as lay_out says."""
    if not lines or not any(lines):
        raise InputError("text: is empty, nothing to write on the plate")
    width, depth = block_mm(lines, sizes)
    around = sizes["base_diameter_mm"] + 2 * margin_mm
    dots = lay_out(lines, sizes, thickness_mm)
    return dotted_slab((width + around, depth + around), thickness_mm, dots, margin_mm / 2)


SPACING_MM = 10.0
"""Between the dots: a segment of 2.5 mm in its case meets one dot alone."""
EDGE_MM = 10.0
"""From the axis of a dot to the edge of the plate: room for a clamp on each side."""
HEIGHTS_MM = (0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9)
"""From the target of medicine cartons to the highest dot of signs."""


def height_series(
    base_diameter_mm: float,
    heights_mm: Sequence[float],
    thickness_mm: float = THICKNESS_MM,
    spacing_mm: float = SPACING_MM,
    edge_mm: float = EDGE_MM,
) -> Plate:
    """A row of dots of one base, from left to right of the given heights; one height gives a plate of one dot.

    InputError for no height, and for dots that would overlap.
    """
    if not heights_mm:
        raise InputError("--heights-mm: is empty, at least one height is needed")
    if spacing_mm <= base_diameter_mm:
        raise InputError(
            f"base_diameter_mm = {base_diameter_mm:g}: dots {spacing_mm:g} mm apart would touch, "
            f"must be less than {spacing_mm:g}"
        )
    length = (len(heights_mm) - 1) * spacing_mm
    dots = [
        PlacedDot(k * spacing_mm - length / 2, 0.0, thickness_mm, base_diameter_mm, height, cell=k + 1)
        for k, height in enumerate(heights_mm)
    ]
    size = (length + 2 * edge_mm, 2 * edge_mm)
    return dotted_slab(size, thickness_mm, dots, edge_mm / 4)

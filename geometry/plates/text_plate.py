"""Plates with lines of Braille or with dots that grow: sizes from the standard, places, and the solid."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from geometry.base import InputError
from geometry.braille import COLUMN_AND_ROW, QUANTITIES, Quantity, QuantityName, raised_dots, standard
from geometry.plates.plate import PlacedDot, Plate, dotted_slab

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

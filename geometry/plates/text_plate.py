"""A plate with lines of Braille."""

from collections.abc import Sequence

from foundation.errors import InputError
from geometry.braille_cells import COLUMN_AND_ROW, raised_dots
from geometry.plates.braille_sizes import BrailleSizes
from geometry.plates.plate import SLAB_THICKNESS_MM, PlacedDot, Plate, dotted_slab


def lay_out(lines: Sequence[str], sizes: BrailleSizes, face_z_mm: float) -> tuple[PlacedDot, ...]:
    """Lay out the dots of lines of Unicode Braille cells, reading along +x, lines along -y, the block about the origin.

    InputError for other characters, for a size that is needed but unknown, and for dots that would overlap.
    """
    width, depth = block_size_mm(lines, sizes)
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


def block_size_mm(lines: Sequence[str], sizes: BrailleSizes) -> tuple[float, float]:
    """Distance in x and y, in mm, between the axes of the outermost dot places, raised or not."""
    cells, pitch = max(map(len, lines)), sizes["dot_pitch_mm"]
    width = pitch + (cells - 1) * (sizes["cell_pitch_mm"] if cells > 1 else 0.0)
    depth = _pitches_per_cell(lines) * pitch + (len(lines) - 1) * (sizes["line_pitch_mm"] if len(lines) > 1 else 0.0)
    return width, depth


def check_spacing(lines: Sequence[str], sizes: BrailleSizes) -> None:
    """Raise InputError where neighbouring dots, cells or lines would run into each other."""
    base, pitch = sizes["base_diameter_mm"], sizes["dot_pitch_mm"]
    _require_room("dot_pitch_mm", pitch, base)
    if max(map(len, lines)) > 1:
        _require_room("cell_pitch_mm", sizes["cell_pitch_mm"], pitch + base)
    if len(lines) > 1:
        _require_room("line_pitch_mm", sizes["line_pitch_mm"], _pitches_per_cell(lines) * pitch + base)


def _require_room(name: str, value: float, least: float) -> None:
    if value <= least:
        raise InputError(f"{name} = {value:g}: neighbouring dots would touch, must be more than {least:g}")


def _pitches_per_cell(lines: Sequence[str]) -> int:
    """Number of dot pitches from the top to the bottom of a cell: three where dot 7 or 8 is used, else two."""
    used = {dot for line in lines for character in line for dot in raised_dots(character, field="text")}
    return 3 if used & {7, 8} else 2


TEXT_MARGIN_MM = 5.0
"""Distance from the base of the outermost dot places to the edge: room for a clamp."""


def text_plate(
    lines: Sequence[str],
    sizes: BrailleSizes,
    thickness_mm: float = SLAB_THICKNESS_MM,
    margin_mm: float = TEXT_MARGIN_MM,
) -> Plate:
    """The plate of lines of Unicode Braille cells (U+2800 to U+28FF). InputError as of lay_out."""
    if not lines or not any(lines):
        raise InputError("text: is empty, nothing to write on the plate")
    width, depth = block_size_mm(lines, sizes)
    around = sizes["base_diameter_mm"] + 2 * margin_mm
    dots = lay_out(lines, sizes, thickness_mm)
    return dotted_slab((width + around, depth + around), thickness_mm, dots, margin_mm / 2)

"""A plate with lines of Braille."""

from collections.abc import Sequence

from geometry.errors import InputError
from geometry.plates.layout import block_mm, lay_out
from geometry.plates.plate import Plate
from geometry.plates.sizes import BrailleSizes
from geometry.plates.slab import dotted_slab

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

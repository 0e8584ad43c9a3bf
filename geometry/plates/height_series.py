"""A plate with one dot, or with a row of dots of rising heights."""

from collections.abc import Sequence

from foundation.errors import InputError
from geometry.plates.plate import SLAB_THICKNESS_MM, PlacedDot, Plate, dotted_slab

DOT_SPACING_MM = 10.0
"""Distance between the dots: a segment of 2.5 mm in its case meets one dot alone."""
DOT_TO_EDGE_MM = 10.0
"""Distance from the axis of a dot to the edge of the plate: room for a clamp on each side."""
SERIES_HEIGHTS_MM = (0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9)
"""From the target of medicine cartons to the highest dot of signs."""


def height_series(
    base_diameter_mm: float,
    heights_mm: Sequence[float],
    thickness_mm: float = SLAB_THICKNESS_MM,
    spacing_mm: float = DOT_SPACING_MM,
    edge_mm: float = DOT_TO_EDGE_MM,
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

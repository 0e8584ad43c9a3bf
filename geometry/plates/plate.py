"""A printable plate with dots, and where each of its dots lies."""

from dataclasses import dataclass

from geometry.part import Part


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

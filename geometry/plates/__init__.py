"""Braille plates, single dots, height series and indenter tips as printable solids, dots upwards."""

from geometry.plates.plate import BrailleSizes, PlacedDot, Plate, braille_sizes, height_series, indenter_tip, text_plate

__all__ = ["BrailleSizes", "PlacedDot", "Plate", "braille_sizes", "height_series", "indenter_tip", "text_plate"]

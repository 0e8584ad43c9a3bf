"""Braille plates, single dots, height series and indenter tips as printable solids, dots upwards."""

from geometry.plates.braille_sizes import BrailleSizes, braille_sizes
from geometry.plates.height_series import height_series
from geometry.plates.indenter import indenter_tip
from geometry.plates.plate import PlacedDot, Plate
from geometry.plates.text_plate import text_plate

__all__ = ["BrailleSizes", "PlacedDot", "Plate", "braille_sizes", "height_series", "indenter_tip", "text_plate"]

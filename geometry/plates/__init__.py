"""Braille plates, single dots, height series and indenter tips as printable solids, dots upwards."""

from geometry.plates.plate import PlacedDot, Plate
from geometry.plates.series import height_series
from geometry.plates.sizes import BrailleSizes, braille_sizes
from geometry.plates.text_plate import text_plate
from geometry.plates.tip import indenter_tip

__all__ = ["BrailleSizes", "PlacedDot", "Plate", "braille_sizes", "height_series", "indenter_tip", "text_plate"]

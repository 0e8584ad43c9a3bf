"""Braille plates, single dots, height series and indenter tips as printable solids, dots upwards."""

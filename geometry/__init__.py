"""Parameters, Braille standards, the exact dot and the solids of a segment. Lengths in millimetres."""

"""softdot plate: a printable Braille plate from a text."""

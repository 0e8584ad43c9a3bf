"""Parameters, Braille standards, the exact dot and the solids of a segment. Lengths in millimetres."""

import foundation  # noqa: F401 - sets the thread pools before NumPy is loaded

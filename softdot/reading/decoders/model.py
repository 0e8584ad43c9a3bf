"""Decoder "model": the dots that make the voltages most likely, without training.

It knows the kernel, the nominal standard, the read-out and the voltages; speed, place, offset, yaw and gain it finds.
"""

from dataclasses import dataclass

import numpy as np

from geometry.arrays import Floats, Ints
from softdot.reading.decoders.corrected import settled
from softdot.reading.decoders.fitted import Track
from softdot.reading.decoders.pressing import PressedCells, most_likely
from softdot.reading.line import cells_from
from softdot.reading.voltages import Reader


@dataclass(frozen=True)
class DecodedCells:
    """cells (c,) and when the array's middle has passed each, passed_s (c,); blanks at both ends are left out."""

    cells: Ints
    passed_s: Floats


def decode(reader: Reader, seen: Track | PressedCells) -> DecodedCells:
    """Cells of a slide that was tracked, or of presses."""
    if isinstance(seen, PressedCells):
        return trimmed(most_likely(reader, seen), seen.passed_s)
    return trimmed(cells_from(settled(reader, seen)), seen.passed_s)


def trimmed(cells: Ints, passed_s: Floats) -> DecodedCells:
    """Without blanks at both ends."""
    there = np.flatnonzero(cells)
    span = slice(there[0], there[-1] + 1) if len(there) else slice(0, 0)
    return DecodedCells(cells[span], passed_s[span])

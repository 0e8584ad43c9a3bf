"""Decoder "model": the cells that make the voltages most likely, by the kernel and without training. Of a slide they
are those of the filter (softdot.reading.line_filter); of presses the most likely ones of all 64.
"""

from dataclasses import dataclass

import numpy as np

from foundation.arrays import Floats, Ints
from softdot.reading.decoders.pressing import PressedCells, most_likely_cells
from softdot.reading.decoders.track import Track
from softdot.reading.line_filter.line_reader import CERTAIN
from softdot.reading.voltages import Reader


@dataclass(frozen=True)
class DecodedCells:
    """Decoded cells (c,), -1 where none is certain, and the times passed_s (c,) at which the array's middle has passed
    each; blanks at both ends are left out.

    likely, probability (c,) : the most likely cells, of uncertain ones too, and their probabilities; None of a decoder
    that knows none.
    """

    cells: Ints
    passed_s: Floats
    likely: Ints | None = None
    probability: Floats | None = None


def decode(reader: Reader, seen: Track | PressedCells) -> DecodedCells:
    """The cells of a tracked slide, or of presses."""
    if isinstance(seen, PressedCells):
        return trim_blanks(most_likely_cells(reader, seen), seen.passed_s)
    certain = np.where((seen.probability >= CERTAIN) & seen.is_braille, seen.cells, -1)
    return DecodedCells(certain, seen.passed_s, seen.cells, seen.probability)


def trim_blanks(cells: Ints, passed_s: Floats) -> DecodedCells:
    """Cells without the blanks at both ends."""
    there = np.flatnonzero(cells)
    span = slice(there[0], there[-1] + 1) if len(there) else slice(0, 0)
    return DecodedCells(cells[span], passed_s[span])

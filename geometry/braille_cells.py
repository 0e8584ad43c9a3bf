"""Unicode Braille cells: which dots of a character are raised, and where they stand in the cell."""

import numpy as np
from numpy.typing import NDArray

from foundation.errors import InputError

FIRST_CELL, LAST_CELL = 0x2800, 0x28FF
COLUMN_AND_ROW = {1: (0, 0), 2: (0, 1), 3: (0, 2), 7: (0, 3), 4: (1, 0), 5: (1, 1), 6: (1, 2), 8: (1, 3)}
"""Dot number -> (column, row); rows count downwards."""
COLUMNS_ALONG_X, ROWS_ALONG_Y = 1.0, 1.0
"""Reading runs along +x and rows along +y: the plate faces down, so its dots read correctly from their own side."""


def raised_dots(character: str, field: str = "dot.cell") -> tuple[int, ...]:
    """Numbers of the raised dots of a Unicode Braille character: bit n - 1 of its code stands for dot n.

    InputError, which names the field, for anything but one character from U+2800 to U+28FF.

    >>> raised_dots("⠙")  # the letter d
    (1, 4, 5)
    """
    if len(character) != 1 or not FIRST_CELL <= ord(character) <= LAST_CELL:
        raise InputError(f"{field} = '{character}': must be one Unicode Braille character, U+2800 to U+28FF")
    bits = ord(character) - FIRST_CELL
    return tuple(dot for dot in range(1, 9) if bits >> (dot - 1) & 1)


def dot_offset_mm(dot: int, pitch_mm: float) -> NDArray[np.float64]:
    """Position (2,) of a dot relative to dot 1 of its cell, x and y in mm."""
    column, row = COLUMN_AND_ROW[dot]
    return np.array([COLUMNS_ALONG_X * column, ROWS_ALONG_Y * row]) * pitch_mm

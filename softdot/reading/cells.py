"""Text to the cells of a line and back. A cell is a number from 0 to 63: its bit k - 1 stands for dot k, as in
Unicode's block from U+2800 on.
"""

from collections.abc import Sequence

import numpy as np

from foundation.arrays import Ints
from foundation.errors import InputError
from geometry.braille_cells import FIRST_CELL
from softdot.braille_text.back_translation import back_translate, english_text
from softdot.braille_text.english import english_cells
from softdot.braille_text.liblouis import INSTALL_ADVICE, liblouis, louis_cells

MOST_CELLS = 20_000
"""Longest line, in cells."""
UNKNOWN = "?"
"""A cell that is not known."""
DOTS, KINDS_OF_CELL = 6, 64
"""Dots of a cell, and number of different cells."""


def cells_of(text: str, table: str | None = None) -> Ints:
    """Cells (c,) of a text in one line, whose line breaks are blanks. table : of liblouis, None for plain English.

    InputError for a text that is empty or too long, for characters that the table lacks, and for cells of eight dots.
    """
    line = " ".join(text.split())
    if not line.strip("⠀"):
        raise InputError("text: is empty, a line needs at least one character")
    characters = (english_cells(line, INSTALL_ADVICE) if table is None else louis_cells(line, table)).strip("⠀ ")
    cells = np.array([ord(one) - FIRST_CELL for one in characters.replace(" ", "⠀")], dtype=np.int64)
    if len(cells) > MOST_CELLS:
        raise InputError(f"text: has {len(cells)} cells, at most {MOST_CELLS} are allowed in a line")
    if (cells >= KINDS_OF_CELL).any():
        place = int(np.argmax(cells >= KINDS_OF_CELL))
        raise InputError(f"text: the cell '{characters[place]}' has eight dots; a line here has six in each cell")
    return cells


def braille(cells: Sequence[int] | Ints) -> str:
    """Cells (c,) as characters of Unicode Braille; below 0 is one that is not known, a question mark."""
    return "".join(chr(FIRST_CELL + int(cell)) if cell >= 0 else UNKNOWN for cell in cells)


def text_of(cells: Sequence[int] | Ints, table: str | None = None) -> str:
    """The text of cells (c,); where liblouis is needed and missing, or fails, the cells themselves.

    A cell below 0 is not known, a question mark; the text goes on behind it as at a new beginning.
    """
    return UNKNOWN.join(_text_of_known(part, table) for part in braille(cells).split(UNKNOWN))


def _text_of_known(cells: str, table: str | None) -> str:
    if not cells:
        return ""
    if table is None:
        return english_text(cells)
    found = liblouis()
    return cells if found is None else back_translate(found.called_by, cells, table)

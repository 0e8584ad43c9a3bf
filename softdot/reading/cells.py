"""Text -> cells of a line and back: uncontracted English by the table of softdot.printed_braille, else liblouis.

A cell is a number from 0 to 63: bit k - 1 stands for dot k, as in Unicode's block from U+2800 on.
"""

import re
import subprocess
from collections.abc import Sequence
from functools import cache

import numpy as np

from geometry.arrays import Ints
from geometry.base import InputError
from geometry.braille_cells import FIRST
from softdot.printed_braille.request import (
    DISPLAY,
    INSTALL,
    TIMEOUT_S,
    english_cells,
    english_table,
    liblouis,
    louis_cells,
)

MOST_CELLS = 20_000
DOTS, KINDS_OF_CELL = 6, 64
DIGIT_SIGNS = (",", ".")
"""Signs that do not end a number (The Rules of Unified English Braille, 2013, 6.3)."""


def cells_of(text: str, table: str | None = None) -> Ints:
    """Cells (c,) of a text in one line, whose line breaks are blanks; table : of liblouis, None for plain English.

    InputError for a text that is empty or too long, for what the table lacks, and for cells of eight dots.
    """
    line = " ".join(text.split())
    if not line.strip("⠀"):
        raise InputError("text: is empty, a line needs at least one character")
    characters = (english_cells(line, INSTALL) if table is None else louis_cells(line, table)).strip("⠀ ")
    cells = np.array([ord(one) - FIRST for one in characters.replace(" ", "⠀")], dtype=np.int64)
    if len(cells) > MOST_CELLS:
        raise InputError(f"text: has {len(cells)} cells, at most {MOST_CELLS} are allowed in a line")
    if (cells >= KINDS_OF_CELL).any():
        place = int(np.argmax(cells >= KINDS_OF_CELL))
        raise InputError(f"text: the cell '{characters[place]}' has eight dots; a line here has six in each cell")
    return cells


def braille(cells: Sequence[int] | Ints) -> str:
    """Unicode Braille of cells (c,)."""
    return "".join(chr(FIRST + int(cell)) for cell in cells)


def text_of(cells: Sequence[int] | Ints, table: str | None = None) -> str:
    """Text of cells (c,); without liblouis, where it is needed, and where it fails, the cells themselves."""
    if table is None:
        return english_text(braille(cells))
    found = liblouis()
    return braille(cells) if found is None else _back_translated(found.called_by, braille(cells), table)


def _back_translated(called_by: str, cells: str, table: str) -> str:
    if called_by == "louis":
        import louis  # type: ignore[import-not-found]

        try:
            return str(louis.backTranslateString([DISPLAY, table], cells))
        except RuntimeError:
            return cells
    done = subprocess.run(
        [called_by, "--backward", f"{DISPLAY},{table}"], input=cells, capture_output=True, timeout=TIMEOUT_S,
        encoding="utf-8", errors="replace", check=False,
    )  # fmt: skip
    said = done.stdout.rstrip("\n")
    return cells if done.returncode or not said else said


def english_text(cells: str) -> str:
    """The text that english_cells turns into these cells; a cell that means nothing stays as it is.

    Where two signs have the same cells, the simpler one is meant: ' of ’, - of –, and ⠦ opens a word or ends it as ?.
    """
    text, place = "", 0
    while place < len(cells):
        found = _number(cells, place) or _capitals(cells, place) or _sign(cells, place, text)
        if found is None:
            found = _letters().get(cells[place], cells[place]), 1
        text += found[0]
        place += found[1]
    return text


@cache
def _letters() -> dict[str, str]:
    return {cell: letter for letter, cell in english_table()["letters"].items()}


@cache
def _signs() -> dict[str, str]:
    """Cells -> sign, longest cells first; of several signs with the same cells the first of the table."""
    signs: dict[str, str] = {}
    for sign, cells in english_table()["signs"].items():
        signs.setdefault(cells, sign)
    return dict(sorted(signs.items(), key=lambda one: -len(one[0])))


def _number(cells: str, place: int) -> tuple[str, int] | None:
    """Digits behind the number sign with the points and commas among them, and the number of cells they take."""
    table = english_table()
    sign, letter = table["indicators"]["number"], table["indicators"]["letter"]
    known = {cell: digit for digit, cell in table["digits"].items()}
    known |= {table["signs"][point]: point for point in DIGIT_SIGNS}
    if not cells.startswith(sign, place):
        return None
    end = place + len(sign)
    digits = ""
    while end < len(cells) and cells[end] in known:
        digits += known[cells[end]]
        end += 1
    if not re.search("[0-9]", digits):
        return None
    return digits, end - place + (len(letter) if cells.startswith(letter, end) else 0)


def _capitals(cells: str, place: int) -> tuple[str, int] | None:
    """One capital, or a word of them up to their end."""
    signs, letters = english_table()["indicators"], _letters()
    word, one, close = signs["capital_word"], signs["capital"], signs["capitals_end"]
    if cells.startswith(word, place):
        begin = end = place + len(word)
        while end < len(cells) and cells[end] in letters:
            end += 1
        if end > begin:
            text = "".join(letters[cell] for cell in cells[begin:end]).upper()
            return text, end - place + (len(close) if cells.startswith(close, end) else 0)
    if cells.startswith(one, place) and cells[place + len(one) : place + len(one) + 1] in letters:
        return letters[cells[place + len(one)]].upper(), len(one) + 1
    return None


def _sign(cells: str, place: int, before: str) -> tuple[str, int] | None:
    for known, sign in _signs().items():
        if cells.startswith(known, place):
            opens = sign == "?" and (not before or before[-1] in " ([“") and cells[place + 1 : place + 2] > "⠀"
            return "“" if opens else sign, len(known)
    return None

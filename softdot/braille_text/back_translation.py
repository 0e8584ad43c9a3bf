"""Unicode Braille cells back to text: uncontracted English by the table of this package, else liblouis."""

import re
import subprocess
from functools import cache

from softdot.braille_text.english import english_table
from softdot.braille_text.liblouis import DISPLAY_TABLE, TIMEOUT_S

SIGNS_WITHIN_NUMBERS = (",", ".")
"""Signs that do not end a number (The Rules of Unified English Braille, 2013, 6.3)."""


def back_translate(called_by: str, cells: str, table: str) -> str:
    """The text of cells by a table of liblouis, called by its binding or its program; the cells where it fails."""
    if called_by == "louis":
        import louis  # type: ignore[import-not-found]

        try:
            return str(louis.backTranslateString([DISPLAY_TABLE, table], cells))
        except RuntimeError:
            return cells
    done = subprocess.run(
        [called_by, "--backward", f"{DISPLAY_TABLE},{table}"], input=cells, capture_output=True, timeout=TIMEOUT_S,
        encoding="utf-8", errors="replace", check=False,
    )  # fmt: skip
    said = done.stdout.rstrip("\n")
    return cells if done.returncode or not said else said


def english_text(cells: str) -> str:
    """The text whose cells english_cells gives; a cell without a meaning stays as it is.

    Where two signs have the same cells, the simpler one is taken: ' of ’, - of –, and ⠦ opens a word or ends it as ?.
    """
    text, place = "", 0
    while place < len(cells):
        found = _number(cells, place) or _capitals(cells, place) or _sign(cells, place, text)
        if found is None:
            found = _letters_by_cell().get(cells[place], cells[place]), 1
        text += found[0]
        place += found[1]
    return text


@cache
def _letters_by_cell() -> dict[str, str]:
    return {cell: letter for letter, cell in english_table()["letters"].items()}


@cache
def _signs_by_cells() -> dict[str, str]:
    """Cells -> sign, longest cells first; of several signs with the same cells the first of the table."""
    signs: dict[str, str] = {}
    for sign, cells in english_table()["signs"].items():
        signs.setdefault(cells, sign)
    return dict(sorted(signs.items(), key=lambda one: -len(one[0])))


def _number(cells: str, place: int) -> tuple[str, int] | None:
    """Digits behind the number sign, with the points and commas among them, and the number of cells that they take."""
    table = english_table()
    sign, letter = table["indicators"]["number"], table["indicators"]["letter"]
    known = {cell: digit for digit, cell in table["digits"].items()}
    known |= {table["signs"][point]: point for point in SIGNS_WITHIN_NUMBERS}
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
    """One capital, or the capitals of a word, and the number of cells that they take."""
    signs, letters = english_table()["indicators"], _letters_by_cell()
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
    for known, sign in _signs_by_cells().items():
        if cells.startswith(known, place):
            opens = sign == "?" and (not before or before[-1] in " ([“") and cells[place + 1 : place + 2] > "⠀"
            return "“" if opens else sign, len(known)
    return None

"""Text as lines of Braille cells, broken at blanks where they are longer than allowed."""

from dataclasses import dataclass

from foundation.errors import InputError
from softdot.braille_text.english import english_cells, english_table
from softdot.braille_text.liblouis import INSTALL_ADVICE, liblouis, louis_cells

LONGEST_LINE_CELLS = 40
"""Cells on a line of a Braille page; a longer line is broken only on request."""
BLANK = "\u2800"


@dataclass(frozen=True)
class Translation:
    """Lines of Unicode Braille cells. table : by which they were translated. liblouis : its version where used."""

    lines: tuple[str, ...]
    table: str
    liblouis: str | None


def translate(text: str, table: str | None = None, width_cells: int | None = None) -> Translation:
    """Translate a text line by line; lines longer than width_cells are broken at blanks. InputError."""
    rows = text.strip("\n").split("\n")
    if table is None:
        lines = [english_cells(row, INSTALL_ADVICE) for row in rows]
        return Translation(_fit_lines(lines, width_cells), english_table()["name"], None)
    lines = [louis_cells(row, table) for row in rows]
    found = liblouis()
    return Translation(_fit_lines(lines, width_cells), table, found.version if found else None)


def _fit_lines(lines: list[str], width_cells: int | None) -> tuple[str, ...]:
    """The lines broken to a width, or refused where they are longer than a page. InputError."""
    stripped = [line.rstrip(BLANK) for line in lines]
    if width_cells is not None:
        return tuple(part for line in stripped for part in _break_line(line, width_cells))
    for number, line in enumerate(stripped, 1):
        if len(line) > LONGEST_LINE_CELLS:
            raise InputError(
                f"text: line {number} has {len(line)} cells, at most {LONGEST_LINE_CELLS} are allowed on a line; "
                f"break it by --width-cells N"
            )
    return tuple(stripped)


def _break_line(line: str, width: int) -> list[str]:
    """One line broken at blanks into lines of at most width cells. InputError for a longer word."""
    parts = [""]
    for word in line.split(BLANK):
        if len(word) > width:
            raise InputError(f"--width-cells = {width}: the word {word} has {len(word)} cells and cannot be broken")
        longer = f"{parts[-1]}{BLANK}{word}" if parts[-1] else word
        if len(longer) <= width:
            parts[-1] = longer
        else:
            parts.append(word)
    return parts

"""A text as lines of Braille cells, broken at blanks where they are longer than asked."""

from dataclasses import dataclass

from foundation.errors import InputError
from softdot.braille_text.english import english_cells, english_table
from softdot.braille_text.liblouis import INSTALL, liblouis, louis_cells

LONGEST_LINE = 40
"""Cells on a line of a Braille page; a longer line is broken only when asked."""
BLANK = "\u2800"


@dataclass(frozen=True)
class Translation:
    """Lines of Unicode Braille cells; table : what they were translated by; liblouis : its version, if used."""

    lines: tuple[str, ...]
    table: str
    liblouis: str | None


def translate(text: str, table: str | None = None, width_cells: int | None = None) -> Translation:
    """Translate line by line; lines longer than width_cells are broken at blanks. InputError."""
    rows = text.strip("\n").split("\n")
    if table is None:
        lines = [english_cells(row, INSTALL) for row in rows]
        return Translation(_fit(lines, width_cells), english_table()["name"], None)
    lines = [louis_cells(row, table) for row in rows]
    found = liblouis()
    return Translation(_fit(lines, width_cells), table, found.version if found else None)


def _fit(lines: list[str], width_cells: int | None) -> tuple[str, ...]:
    stripped = [line.rstrip(BLANK) for line in lines]
    if width_cells is not None:
        return tuple(part for line in stripped for part in _broken(line, width_cells))
    for number, line in enumerate(stripped, 1):
        if len(line) > LONGEST_LINE:
            raise InputError(
                f"text: line {number} has {len(line)} cells, at most {LONGEST_LINE} are allowed on a line; "
                f"break it by --width-cells N"
            )
    return tuple(stripped)


def _broken(line: str, width: int) -> list[str]:
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

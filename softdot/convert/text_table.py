"""A table in a text file: its encoding, the sign between its columns, point or comma in its numbers."""

import csv
import re
from collections.abc import Sequence
from dataclasses import dataclass
from io import StringIO
from math import isfinite
from pathlib import Path

import numpy as np

from foundation.arrays import Floats
from foundation.errors import InputError
from foundation.files import regular_file_size

LARGEST_MB = 500
BYTE_ORDER_MARKS = {b"\xef\xbb\xbf": "utf-8-sig", b"\xff\xfe": "utf-16", b"\xfe\xff": "utf-16"}
"""First bytes of a file -> the encoding that they announce."""
NUMBER = re.compile(r"[+-]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eEdD][+-]?\d+)?", re.ASCII)
"""A number with a point or a comma."""
MISSING_SAMPLE = re.compile(r"[+-]?(?:nan|inf|infinity|\u221e)", re.IGNORECASE)
"""A sample that is missing, or beyond the range of its channel as PicoScope writes it."""
NOT_A_NUMBER, OVERFLOW = 9.91e37, 9.9e37
"""Numbers by which instruments mark missing and overflowing samples (SCPI-1999, volume 1, 7.2.1.4 and 7.2.1.5)."""
GROUPED_THOUSANDS = re.compile(r"[+-]?[1-9]\d{0,2}(?:[.,]\d{3})+", re.ASCII)
"""Numbers that may have thousands set apart: 1,234."""
SEPARATOR_LINES = 200  # rows


@dataclass(frozen=True)
class TextTable:
    """A table of text: rows, the cells of every line without blanks around them; decimal, '.' or ','; and the file."""

    rows: Sequence[Sequence[str]]
    decimal: str
    file: Path

    def place(self, row: int) -> str:
        """The place of a row for a message, rows counted from 1."""
        return f"'{self.file}' row {row + 1}"

    def cell(self, row: int, column: int) -> str:
        """The text of a cell, "" where the row ends before it."""
        cells = self.rows[row]
        return cells[column] if column < len(cells) else ""

    def is_number(self, text: str) -> bool:
        """Whether a text is a number with this file's decimal sign."""
        return bool(NUMBER.fullmatch(text)) and ("," if self.decimal == "." else ".") not in text

    def number(self, row: int, column: int) -> float:
        """The number in a cell; NaN for an empty cell and a missing sample. InputError for a text that is no number."""
        text = self.cell(row, column).replace("\u2212", "-")
        if not text or MISSING_SAMPLE.fullmatch(text):
            return float("nan")
        if not self.is_number(text):
            raise InputError(f"{self.place(row)}, column {column + 1} = '{text[:40]}': must be a number")
        value = float(text.upper().replace("D", "E").replace(",", "."))
        if not isfinite(value):
            raise InputError(f"{self.place(row)}, column {column + 1} = '{text[:40]}': is too large for a number")
        return float("nan") if abs(value) in (NOT_A_NUMBER, OVERFLOW) else value

    def column(self, rows: Sequence[int], column: int) -> Floats:
        """The numbers of one column, (t,)."""
        return np.array([self.number(row, column) for row in rows], dtype=np.float64)


def read_text_table(file: Path) -> TextTable:
    """Read a text file as a table. InputError for one that cannot be read or mixes points and commas in its numbers."""
    text = file_text(file)
    text, told = _split_off_separator(text)
    separator = told or _likely_separator(text)
    try:
        rows = [
            [" ".join(cell.split()) for cell in row]
            for row in csv.reader(StringIO(text, newline=""), delimiter=separator)
        ]
    except csv.Error as error:
        raise InputError(f"'{file}': cannot be read ({error})") from None
    return TextTable(rows, _decimal(rows, file), file)


def file_text(file: Path) -> str:
    """The text of a file in UTF-8, UTF-16 or, where it is neither, Latin-1. InputError."""
    if (size := regular_file_size(file, f"'{file}'")) > 1e6 * LARGEST_MB:
        raise InputError(f"'{file}': has {size / 1e6:.0f} MB, at most {LARGEST_MB} MB are read")
    try:
        content = file.read_bytes()
        return content.decode(_encoding(content)).replace("\0", "")
    except OSError as error:
        raise InputError(f"'{file}': cannot be read ({error.strerror})") from None
    except UnicodeDecodeError as error:
        raise InputError(f"'{file}': no text in UTF-16 (byte {error.start})") from None


def _encoding(content: bytes) -> str:
    """The encoding of the bytes of a text file."""
    for mark, encoding in BYTE_ORDER_MARKS.items():
        if content.startswith(mark):
            return encoding
    head = content[:200]
    if head[1::2].count(0) > len(head) // 4:  # UTF-16 without its mark: every other byte of western text is zero
        return "utf-16-le"
    if head[::2].count(0) > len(head) // 4:
        return "utf-16-be"
    try:
        content.decode("utf-8")
    except UnicodeDecodeError:
        return "latin-1"
    return "utf-8"


def _split_off_separator(text: str) -> tuple[str, str]:
    """The text without a first line sep=; of a spreadsheet, and the sign which that states, "" without one."""
    found = re.match(r'"?sep=(.)"?[ \t]*\r?\n', text)
    return (text[found.end() :], found[1]) if found else (text, "")


def _likely_separator(text: str) -> str:
    """The sign between columns: semicolon or tab where most of the first lines have one, else comma."""
    lines = [line for line in text.splitlines()[:SEPARATOR_LINES] if line.strip()]
    for mark in (";", "\t"):
        if 2 * sum(mark in line for line in lines) > len(lines):
            return mark
    return ","


def _decimal(rows: Sequence[Sequence[str]], file: Path) -> str:
    """The decimal sign of the samples, point or comma. InputError where they have both, or it may be of thousands."""
    marks: dict[str, str] = {}
    decimals: set[str] = set()
    grouped: set[int] = set()  # columns of 1,234
    large: set[int] = set()  # columns of 998
    for number, row in enumerate(rows):
        numbers = [(column, cell) for column, cell in enumerate(row) if NUMBER.fullmatch(cell)]
        if len(numbers) < 2:  # a setting, such as a version
            continue
        for column, cell in numbers:
            mark = "." if "." in cell else "," if "," in cell else ""
            if not mark:
                large |= {column} if len(cell.lstrip("+-")) > 2 else set()
                continue
            marks.setdefault(mark, f"row {number + 1}: '{cell[:40]}'")
            if mark not in decimals:
                is_grouped = GROUPED_THOUSANDS.fullmatch(cell)
                (grouped.add(column) if is_grouped else decimals.add(mark))
    if len(marks) == 2:
        raise InputError(f"'{file}': numbers have points ({marks['.']}) and commas ({marks[',']}); which are decimals?")
    mark = next(iter(marks), ".")
    if grouped and mark not in decimals and (mark == "," or grouped & large):
        raise InputError(
            f"'{file}': numbers may be of thousands, or have decimals ({marks[mark]}); write 1234 or 1.2340"
        )
    return mark

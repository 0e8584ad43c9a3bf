"""Rows of a spreadsheet (.xlsx)."""

from pathlib import Path
from zipfile import BadZipFile

import numpy as np

from geometry.base import InputError
from mesh.types import Floats


def read_sheet(file: Path | str, first_row: int = 0, sheet: int = 0) -> Floats:
    """Cells (r, c) of one sheet from a row on; NaN for what is no number. InputError; needs openpyxl."""
    try:
        from openpyxl import load_workbook  # type: ignore[import-untyped]
    except ImportError:
        raise InputError(f"'{file}': reading .xlsx needs openpyxl, pip install openpyxl") from None
    try:
        book = load_workbook(file, read_only=True, data_only=True)
    except (OSError, BadZipFile, KeyError, ValueError) as error:
        raise InputError(f"'{file}': cannot be read as .xlsx ({error})") from None
    rows = list(book.worksheets[sheet].iter_rows(min_row=first_row + 1, values_only=True))
    book.close()
    width = max((len(row) for row in rows), default=0)
    return np.array([[_number(cell) for cell in row] + [np.nan] * (width - len(row)) for row in rows])


def _number(cell: object) -> float:
    return float(cell) if isinstance(cell, int | float) and not isinstance(cell, bool) else float("nan")

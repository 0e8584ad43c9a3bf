"""Files of instruments by their endings: text, spreadsheets, MATLAB, LabVIEW, and binary waveforms of oscilloscopes."""

from collections.abc import Mapping
from pathlib import Path
from zipfile import BadZipFile

import numpy as np

from foundation.arrays import Floats
from foundation.errors import InputError
from foundation.files import regular_file_size
from softdot.convert.apart import read_in_own_process
from softdot.convert.instruments import InstrumentLog, LogChannel, first_not_rising, log_from_table
from softdot.convert.text_table import TextTable, read_text_table
from softdot.convert.units import assumed_unit, unit_of

TEXT_ENDINGS = (".csv", ".txt", ".tsv", ".dat", ".asc", ".prn")
WAVEFORM_ENDINGS = (".wfm", ".isf", ".trc", ".bin", ".wvf")


def read_log(file: Path | str) -> InstrumentLog:
    """Read the log of an instrument, in the format that its ending names. InputError."""
    file = Path(file)
    kind = file.suffix.lower()
    if kind in TEXT_ENDINGS or kind == ".xlsx":
        return log_from_table(read_table(file))
    if kind in (".tdms", ".lvm"):
        return _binary_log(file, kind)
    if kind in WAVEFORM_ENDINGS:
        return _binary_log(file, "waveform")
    if kind == ".mat":
        raise InputError(
            f"'{file}': a .mat file does not say which variable is what; read it by softdot.convert.read_mat"
        )
    known = ", ".join((*TEXT_ENDINGS, ".xlsx", ".tdms", ".lvm", *WAVEFORM_ENDINGS))
    raise InputError(f"'{file}': must end with one of {known}; text with other endings may be renamed")


def read_table(file: Path) -> TextTable:
    """The table in a text file or in the first sheet of a workbook. InputError."""
    if file.suffix.lower() == ".xlsx":
        return TextTable(_cell_texts(file, 0, 0), ".", file)
    return read_text_table(file)


def _binary_log(file: Path, kind: str) -> InstrumentLog:
    found = read_in_own_process(kind, file)
    channels: dict[str, LogChannel] = {}
    for name, text, values in zip(found["names"].tolist(), found["units"].tolist(), found["values"], strict=True):
        if name in channels:
            raise InputError(f"'{file}': two channels are called '{name}'; give each its own name")
        unit = unit_of(text, name, f"'{file}'") if text else assumed_unit(name, f"'{file}'")
        channels[name] = LogChannel(unit.factor * np.asarray(values, dtype=np.float64), unit.base)
    time = np.asarray(found["time_s"], dtype=np.float64)
    if (row := first_not_rising(time)) is not None:
        raise InputError(f"'{file}': time must rise, and does not at sample {row + 1}")
    return InstrumentLog(time, channels)


def read_mat(
    file: Path | str, variables: Mapping[str, str], factors: Mapping[str, float] | None = None
) -> dict[str, Floats]:
    """Columns (t,) of a recording from the variables of a .mat file, read in a process of its own.

    variables : column -> variable, 'name.field' for a field of a structure. factors : column -> number by which its
    values are multiplied to be in the unit of the column. InputError for a file, variable or shape that does not fit.
    """
    if unknown := (factors or {}).keys() - variables.keys():
        raise InputError(f"factors: '{min(unknown)}' is none of the columns {', '.join(variables)}")
    found = read_in_own_process(".mat", Path(file), variables)
    return {column: (factors or {}).get(column, 1.0) * found[column] for column in variables}


def read_sheet(file: Path | str, first_row: int = 0, sheet: int = 0) -> Floats:
    """Cells (r, c) of one sheet from a row on; NaN for what is no number. InputError; needs openpyxl."""
    return np.array([[_number(cell) for cell in row] for row in _sheet_rows(Path(file), first_row, sheet)])


def _cell_texts(file: Path, first_row: int, sheet: int) -> list[list[str]]:
    """Cells of a sheet as text, numbers with decimal points."""
    rows = _sheet_rows(file, first_row, sheet)
    return [["" if cell is None else " ".join(str(cell).split()) for cell in row] for row in rows]


def _sheet_rows(file: Path, first_row: int, sheet: int) -> list[list[object]]:
    """Rows of a sheet, all of one length. InputError."""
    regular_file_size(file, f"'{file}'")
    try:
        from openpyxl import load_workbook  # type: ignore[import-untyped]
    except ImportError:
        raise InputError(f"'{file}': reading .xlsx needs openpyxl, pip install 'softdot[convert]'") from None
    try:
        book = load_workbook(file, read_only=True, data_only=True)
        rows = list(book.worksheets[sheet].iter_rows(min_row=first_row + 1, values_only=True))
        book.close()
    except IndexError:
        raise InputError(f"'{file}': has no sheet number {sheet + 1}") from None
    except (OSError, BadZipFile, KeyError, ValueError, TypeError, AttributeError, SyntaxError, EOFError) as error:
        raise InputError(f"'{file}': cannot be read as .xlsx ({error})") from None
    width = max((len(row) for row in rows), default=0)
    return [[*row, *[None] * (width - len(row))] for row in rows]


def _number(cell: object) -> float:
    return float(cell) if isinstance(cell, int | float) and not isinstance(cell, bool) else float("nan")

"""Files that instruments write: CSV of oscilloscopes, told apart by their headers; MATLAB .mat; spreadsheets.

Tektronix TDS, TPS, TBS1000     Record Length,2.5e+03,,-0.25,2.0      settings on the left, time and value behind
Rigol DS1000Z, MSO5000          X,CH1,CH2,Start,Increment             then Sequence,Volt,Volt,-6e-03,2e-06
Keysight, Agilent InfiniiVision x-axis,1,2                            then second,Volt,Volt
others (Tektronix MSO, Siglent) Time(s),CH1(V)  or  TIME,CH1          perhaps below some settings
"""

import csv
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from zipfile import BadZipFile

import numpy as np
from scipy.io import loadmat
from scipy.io.matlab import MatReadError, matfile_version

from geometry.arrays import Floats
from geometry.base import InputError, nearest
from geometry.files import regular_file

HEADER_ROWS = 60
FACTORS = {"s": 1.0, "second": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "v": 1.0, "volt": 1.0, "volts": 1.0, "mv": 1e-3}


@dataclass(frozen=True)
class Layout:
    """first : row of the first sample. channels : name -> column and factor. time : column and factor, or None with
    start_s and step_s.
    """

    first: int
    channels: Mapping[str, tuple[int, float]]
    time: tuple[int, float] | None = (0, 1.0)
    start_s: float = 0.0
    step_s: float = 0.0


def read_oscilloscope(file: Path | str) -> dict[str, Floats]:
    """time_s and the channels by the names of the instrument, (t,) each in s and V; NaN where a cell is empty.

    InputError for a file that cannot be read, a header of another kind and a cell that is no number.
    """
    file = Path(file)
    rows = _rows(file)
    layout = _layout(rows, file)
    body = [(n, row) for n, row in enumerate(rows[layout.first :], start=layout.first + 1) if any(map(str.strip, row))]
    values = {
        name: factor * np.array([_cell(row, column, n, file) for n, row in body])
        for name, (column, factor) in layout.channels.items()
    }
    if layout.time is None:
        time = np.asarray(layout.start_s + layout.step_s * np.arange(len(body)), dtype=np.float64)
    else:
        column, factor = layout.time
        time = factor * np.array([_cell(row, column, n, file) for n, row in body])
    return {"time_s": time, **values}


def _rows(file: Path) -> list[list[str]]:
    regular_file(file, f"'{file}'")
    try:
        with file.open(encoding="utf-8-sig", errors="replace", newline="") as stream:
            return list(csv.reader(stream))
    except (OSError, csv.Error) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise InputError(f"'{file}': cannot be read ({reason})") from None


def _layout(rows: Sequence[Sequence[str]], file: Path) -> Layout:
    """Where time and channels stand."""
    first = rows[0][0].strip().lower() if rows and rows[0] else ""
    if first == "record length" and len(rows[0]) > 4:
        return _tektronix(rows)
    if first == "x" and any(cell.strip().lower() == "increment" for cell in rows[0]):
        return _rigol(rows, file)
    if first == "x-axis" and len(rows) > 1:
        return Layout(2, {f"CH{name.strip()}": (n, _factor(rows[1][n])) for n, name in _named(rows[0])})
    for number, row in enumerate(rows[:HEADER_ROWS]):
        if len(row) > 1 and row[0].strip().lower().startswith("time"):
            channels = {_bare(name): (n, _factor(_unit(name))) for n, name in _named(row)}
            return Layout(number + 1, channels, (0, _factor(_unit(row[0]))))
    raise InputError(
        f"'{file}' row 1: no header of an oscilloscope; known are Tektronix, Rigol, Keysight and a row Time(s),CH1(V)"
    )


def _tektronix(rows: Sequence[Sequence[str]]) -> Layout:
    """Settings in the first columns, time and value in the fourth and fifth."""
    settings = {row[0].strip().lower(): row[1].strip() for row in rows[:HEADER_ROWS] if len(row) > 1}
    name, unit = settings.get("source", "CH1"), settings.get("vertical units", "V")
    return Layout(0, {name: (4, _factor(unit))}, (3, 1.0))


def _rigol(rows: Sequence[Sequence[str]], file: Path) -> Layout:
    """Start and increment stand in the second row, in the columns that the first names."""
    names = [cell.strip().lower() for cell in rows[0]]
    start, step = names.index("start") if "start" in names else -1, names.index("increment")
    values = rows[1] if len(rows) > 1 else []
    if start < 0 or len(values) <= step:
        raise InputError(f"'{file}' row 2: start and increment of the time are missing")
    channels = {name: (n, _factor(values[n])) for n, name in _named(rows[0][: min(start, step)])}
    return Layout(2, channels, None, _cell(values, start, 2, file), _cell(values, step, 2, file))


def _named(row: Sequence[str]) -> list[tuple[int, str]]:
    """Columns behind the first that have a name."""
    return [(n, name) for n, name in enumerate(row) if n > 0 and name.strip()]


def _unit(name: str) -> str:
    """CH1(mV) -> mV; CH1 -> nothing."""
    found = re.search(r"[(\[]\s*(\S+?)\s*[)\]]", name)
    return found[1] if found else ""


def _bare(name: str) -> str:
    return re.sub(r"[(\[].*", "", name).strip()


def _factor(unit: str) -> float:
    """To s or V; what has no unit, or one that is neither, is taken as it is."""
    return FACTORS.get(unit.strip().lower(), 1.0)


def _cell(row: Sequence[str], column: int, number: int, file: Path) -> float:
    text = row[column].strip() if column < len(row) else ""
    try:
        return float(text) if text else float("nan")
    except ValueError:
        raise InputError(f"'{file}' row {number}, column {column + 1} = '{text[:40]}': must be a number") from None


HDF5 = 2
"""Major version of files that MATLAB calls 7.3: an HDF5 library more would save their user one save(..., '-v7')."""


def read_mat(
    file: Path | str, variables: Mapping[str, str], factors: Mapping[str, float] | None = None
) -> dict[str, Floats]:
    """Columns (t,) of a recording from the variables of a .mat file.

    variables : column -> variable, 'name.field' for a field of a structure. factors : column -> number by which its
    values are multiplied to be in the unit of the column. InputError for a file, variable or shape that does not fit.
    """
    tables = _loaded(Path(file))
    return {
        column: (factors or {}).get(column, 1.0) * _vector(tables, path, Path(file))
        for column, path in variables.items()
    }


def _loaded(file: Path) -> Mapping[str, object]:
    found: Mapping[str, object] = {}
    try:
        version, _ = matfile_version(file, appendmat=False)
        if version != HDF5:
            found = loadmat(file, squeeze_me=True, simplify_cells=True, appendmat=False)
    except (OSError, ValueError, TypeError, MatReadError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else error
        raise InputError(f"'{file}': cannot be read as a .mat file ({reason})") from None
    if version == HDF5:
        raise InputError(f"'{file}': is a version 7.3 file; save it again in MATLAB with save(..., '-v7')")
    return found


def _vector(tables: Mapping[str, object], path: str, file: Path) -> Floats:
    """One real variable as (t,)."""
    value: object = tables
    for name in path.split("."):
        known = {key for key in value if not key.startswith("__")} if isinstance(value, Mapping) else set()
        if not isinstance(value, Mapping) or name not in known:
            raise InputError(f"'{file}': has no variable '{path}'; {nearest(name, known)}")
        value = value[name]
    array = np.asarray(value)
    if array.dtype.kind not in "fiu" or array.ndim != 1:
        raise InputError(f"'{file}': variable '{path}' has shape {array.shape}, one column of real numbers is needed")
    return array.astype(np.float64)


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

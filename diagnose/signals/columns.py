"""Read the CSV file of one run, or say in one sentence in which row and column it is wrong."""

import csv
import re
from array import array
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TextIO

import numpy as np

from foundation.arrays import Floats
from foundation.errors import InputError
from foundation.files import regular_file_size
from foundation.nearest_name import nearest_name_hint

LARGEST_MB = 500  # of all files together: some 10 million rows, more than any fit could use
LARGEST = 1e12  # squares and ratios of what is larger leave the range of a computer's numbers
NAMES = ("time_s", "displacement_mm", "force_N", "voltage_V", "dot_x_mm", "dot_y_mm", "temperature_C")
NUMBERED = re.compile(r"voltage_[1-9][0-9]*_V")


def refuse_by_size(files: Iterable[Path]) -> None:
    """InputError, before anything is read, for a missing file and for files that are too large together."""
    total = 0.0
    for file in files:
        size = regular_file_size(file, f"recording '{file}'") / 1e6
        total += size
        if total > LARGEST_MB:
            raise InputError(
                f"recording '{file}': {size:.0f} MB make {total:.0f} MB of samples with the files before it, at most "
                f"{LARGEST_MB} MB are read; thin them out or leave out runs"
            )


def read_columns(file: Path) -> dict[str, Floats]:
    """Column name -> samples (t,); NaN where a sample is missing. InputError with file, row and column."""
    with _said(file), file.open(encoding="utf-8-sig", newline="") as stream:
        header = _header(stream, file)
        table = _table(stream, header, file)
    absurd = np.argwhere(np.abs(table) > LARGEST)
    if len(absurd):
        row, column = absurd[0]
        where = place(file, int(row), header[column])
        raise InputError(f"{where} = {table[row, column]:g}: must be at most {LARGEST:g} in size, or nan if missing")
    return {name: np.ascontiguousarray(table[:, number]) for number, name in enumerate(header)}


def place(file: Path, sample: int, column: str) -> str:
    """Where a sample stands, as a spreadsheet counts: the header is row 1."""
    return f"recording '{file}' row {sample + 2}, column {column}"


@contextmanager
def _said(file: Path) -> Iterator[None]:
    """Turn what the file system and the decoder raise into one sentence."""
    try:
        yield
    except UnicodeDecodeError as error:
        raise InputError(f"recording '{file}': not UTF-8 text (byte {error.start}), save it as UTF-8") from None
    except csv.Error as error:
        raise InputError(f"recording '{file}': not a CSV file ({error})") from None
    except OSError as error:
        raise InputError(f"recording '{file}': cannot be read ({error.strerror})") from None


def _header(stream: TextIO, file: Path) -> list[str]:
    names = [name.strip() for name in next(csv.reader([stream.readline()]), [])]
    if not any(names):
        raise InputError(f"recording '{file}': empty, needs a header row such as 'time_s,force_N,voltage_V'")
    if len(names) == 1:
        raise InputError(f"recording '{file}' row 1: is one column, separate columns by commas")
    for number, name in enumerate(names):
        if name not in NAMES and not NUMBERED.fullmatch(name):
            raise InputError(f"recording '{file}' row 1: column '{name[:40]}' is not known; {_meant(name)}")
        if name in names[:number]:
            raise InputError(f"recording '{file}' row 1: column '{name[:40]}' appears twice")
    if "time_s" not in names:
        raise InputError(f"recording '{file}': column time_s is missing")
    return names


def _meant(name: str) -> str:
    """The nearest column, with a word on its unit."""
    text = nearest_name_hint(name, NAMES)
    quantity = name.rpartition("_")[0]
    return f"{text} (mind the unit)" if quantity and f"'{quantity}_" in text else text


def _table(stream: TextIO, header: Sequence[str], file: Path) -> Floats:
    """All samples (t, c): fast where every cell is a number, else row by row."""
    start = stream.tell()
    while not (line := stream.readline()).strip():  # blank lines count for nothing
        if not line:
            raise InputError(f"recording '{file}': there is no sample below the header")
    stream.seek(start)
    try:
        table = np.loadtxt(stream, delimiter=",", comments=None, ndmin=2, quotechar='"')
    except UnicodeDecodeError:
        raise
    except ValueError:
        table = None
    if table is not None and table.shape[1] == len(header):
        return table
    stream.seek(start)
    return _row_by_row(stream, header, file)


def _row_by_row(stream: TextIO, header: Sequence[str], file: Path) -> Floats:
    """The columns with empty cells as NaN, or InputError for the first cell that is no number."""
    cells, reader = array("d"), csv.reader(stream)
    for row in reader:
        if not row:
            continue
        sample = reader.line_num - 1
        if len(row) != len(header):
            raise InputError(
                f"recording '{file}' row {sample + 2}: has {len(row)} values but the header has {len(header)} columns"
            )
        cells.extend(_number(cell, file, sample, name) for cell, name in zip(row, header, strict=True))
    return np.array(cells).reshape(-1, len(header))


def _number(cell: str, file: Path, sample: int, column: str) -> float:
    if not cell.strip():
        return float("nan")
    try:
        return float(cell.replace("_", "?"))  # Python takes 1_0 for ten
    except ValueError:
        where, found = place(file, sample, column), " ".join(cell.split())[:40]
        raise InputError(f"{where} = '{found}': must be a number, or nan if missing") from None

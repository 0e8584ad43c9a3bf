"""Columns of the CSV file of one run; what is wrong in it is named by row and column in one sentence."""

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

LARGEST_FILES_MB = 500  # of all files together: some 10 million rows, more than any fit could use
LARGEST_VALUE = 1e12  # squares and ratios of what is larger leave the range of a computer's numbers
COLUMN_NAMES = ("time_s", "displacement_mm", "force_N", "voltage_V", "dot_x_mm", "dot_y_mm", "temperature_C")
NUMBERED_VOLTAGE = re.compile(r"voltage_[1-9][0-9]*_V")


def refuse_by_size(files: Iterable[Path]) -> None:
    """Refuse missing files, and files that are too large together, before anything is read. InputError."""
    total = 0.0
    for file in files:
        size = regular_file_size(file, f"recording '{file}'") / 1e6
        total += size
        if total > LARGEST_FILES_MB:
            raise InputError(
                f"recording '{file}': {size:.0f} MB make {total:.0f} MB of samples with the files before it, at most "
                f"{LARGEST_FILES_MB} MB are read; thin them out or leave out runs"
            )


def read_columns(file: Path) -> dict[str, Floats]:
    """Columns of a CSV file: name -> samples (t,), NaN where a sample is missing.

    InputError names file, row and column.
    """
    with _explain_read_errors(file), file.open(encoding="utf-8-sig", newline="") as stream:
        header = _read_header(stream, file)
        table = _read_table(stream, header, file)
    absurd = np.argwhere(np.abs(table) > LARGEST_VALUE)
    if len(absurd):
        row, column = absurd[0]
        where = sample_place(file, int(row), header[column])
        raise InputError(
            f"{where} = {table[row, column]:g}: must be at most {LARGEST_VALUE:g} in size, or nan if missing"
        )
    return {name: np.ascontiguousarray(table[:, number]) for number, name in enumerate(header)}


def sample_place(file: Path, sample: int, column: str) -> str:
    """Place of a sample for a message, as a spreadsheet counts: the header is row 1."""
    return f"recording '{file}' row {sample + 2}, column {column}"


@contextmanager
def _explain_read_errors(file: Path) -> Iterator[None]:
    """Turn what the file system and the decoder raise into an InputError of one sentence."""
    try:
        yield
    except UnicodeDecodeError as error:
        raise InputError(f"recording '{file}': not UTF-8 text (byte {error.start}), save it as UTF-8") from None
    except csv.Error as error:
        raise InputError(f"recording '{file}': not a CSV file ({error})") from None
    except OSError as error:
        raise InputError(f"recording '{file}': cannot be read ({error.strerror})") from None


def _read_header(stream: TextIO, file: Path) -> list[str]:
    names = [name.strip() for name in next(csv.reader([stream.readline()]), [])]
    if not any(names):
        raise InputError(f"recording '{file}': empty, needs a header row such as 'time_s,force_N,voltage_V'")
    if len(names) == 1:
        raise InputError(f"recording '{file}' row 1: is one column, separate columns by commas")
    for number, name in enumerate(names):
        if name not in COLUMN_NAMES and not NUMBERED_VOLTAGE.fullmatch(name):
            raise InputError(f"recording '{file}' row 1: column '{name[:40]}' is not known; {_suggest_column(name)}")
        if name in names[:number]:
            raise InputError(f"recording '{file}' row 1: column '{name[:40]}' appears twice")
    if "time_s" not in names:
        raise InputError(f"recording '{file}': column time_s is missing")
    return names


def _suggest_column(name: str) -> str:
    """Words that name the nearest column, with a reminder of its unit."""
    text = nearest_name_hint(name, COLUMN_NAMES)
    quantity = name.rpartition("_")[0]
    return f"{text} (mind the unit)" if quantity and f"'{quantity}_" in text else text


def _read_table(stream: TextIO, header: Sequence[str], file: Path) -> Floats:
    """Table (t, c) of all samples: read fast where every cell is a number, else row by row."""
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
    return _read_rows(stream, header, file)


def _read_rows(stream: TextIO, header: Sequence[str], file: Path) -> Floats:
    """Table (t, c) with empty cells as NaN. InputError for the first cell that is no number."""
    cells, reader = array("d"), csv.reader(stream)
    for row in reader:
        if not row:
            continue
        sample = reader.line_num - 1
        if len(row) != len(header):
            raise InputError(
                f"recording '{file}' row {sample + 2}: has {len(row)} values but the header has {len(header)} columns"
            )
        cells.extend(_parse_cell(cell, file, sample, name) for cell, name in zip(row, header, strict=True))
    return np.array(cells).reshape(-1, len(header))


def _parse_cell(cell: str, file: Path, sample: int, column: str) -> float:
    if not cell.strip():
        return float("nan")
    try:
        return float(cell.replace("_", "?"))  # Python takes 1_0 for ten
    except ValueError:
        where, found = sample_place(file, sample, column), " ".join(cell.split())[:40]
        raise InputError(f"{where} = '{found}': must be a number, or nan if missing") from None

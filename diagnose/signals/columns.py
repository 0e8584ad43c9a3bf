"""Read the CSV file of one run, or say in one sentence in which row and column it is wrong; find samples at a limit.

What a run must be to say anything; and what is suspicious about one that is good enough.
"""

import csv
import re
from array import array
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TextIO

import numpy as np

from diagnose.signals.phases import segmented
from diagnose.signals.recording import Run, gaps, rates_Hz
from foundation.arrays import Bools, Floats, Ints
from foundation.errors import InputError
from foundation.files import regular_file
from foundation.nearest_name import nearest

LARGEST_MB = 500  # of all files together: some 10 million rows, more than any fit could use
LARGEST = 1e12  # squares and ratios of what is larger leave the range of a computer's numbers
NAMES = ("time_s", "displacement_mm", "force_N", "voltage_V", "dot_x_mm", "dot_y_mm", "temperature_C")
NUMBERED = re.compile(r"voltage_[1-9][0-9]*_V")


def refuse_by_size(files: Iterable[Path]) -> None:
    """InputError, before anything is read, for a missing file and for files that are too large together."""
    total = 0.0
    for file in files:
        size = regular_file(file, f"recording '{file}'") / 1e6
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
    text = nearest(name, NAMES)
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


SHORTEST = 4  # equal samples in a row
LONGER = 3  # times the longest such row elsewhere


def saturated(values: Floats, limit: float | None = None) -> Bools:
    """Samples (t,) that stay at the largest or smallest value, or at a limit that is known, as True.

    Noise makes neighbours differ, a limit makes them equal. A converter coarser than the noise makes them equal too,
    but at rest as well: a row of equal samples counts only when it is far longer than those elsewhere.
    """
    at_limit = np.zeros(len(values), dtype=bool)
    if limit is not None:
        at_limit |= np.abs(values) >= 0.999 * limit
    finite = values[np.isfinite(values)]
    if len(finite) == 0:
        return at_limit
    first, length, level = _rows(values)
    extreme = ((level == finite.max()) | (level == finite.min())) & (level != finite[0])
    needed = max(SHORTEST, LONGER * int(length[~extreme].max()))
    for n in np.flatnonzero(extreme & (length >= needed)):
        at_limit[first[n] : first[n] + length[n]] = True
    return at_limit


def _rows(values: Floats) -> tuple[Ints, Ints, Floats]:
    """First sample, length and value of each row of equal samples."""
    edges = np.concatenate([[True], values[1:] != values[:-1]])
    first = np.flatnonzero(edges)
    return first, np.diff(np.append(first, len(values))), values[first]


FEWEST = 8  # samples
LARGEST_STRAIN = 30.0  # no specimen is stretched beyond it
MOST_RATES = 4  # that are listed
UNITS = ("V", "N", "mm")
UNEVEN = 0.05  # share of jumps above which sampling is called uneven
SAMPLES_PER_PERIOD = 4.0  # two are the theorem's; an anti-aliasing filter and a fit need more


def refuse_bad_time(time_s: Floats, file: Path) -> None:
    """InputError for too few samples, a missing time, or one that does not increase."""
    if len(time_s) < FEWEST:
        samples = "1 sample" if len(time_s) == 1 else f"{len(time_s)} samples"
        raise InputError(f"recording '{file}': has {samples}, at least {FEWEST} are needed")
    missing = np.flatnonzero(np.isnan(time_s))
    if len(missing):
        raise InputError(f"{place(file, missing[0], 'time_s')} = nan: every sample needs its time")
    late = np.flatnonzero(np.diff(time_s) <= 0.0) + 1
    if len(late):
        n = int(late[0])
        raise InputError(f"{place(file, n, 'time_s')} = {time_s[n]:g}: follows {time_s[n - 1]:g}, time must increase")


def refuse_bad_columns(columns: Mapping[str, Floats], drive: str, file: Path) -> None:
    """InputError for a missing drive, for nothing to explain, for double or dead channels."""
    if drive not in columns:
        raise InputError(f"recording '{file}': column {drive} is missing, which drive names in rig.toml")
    channels = [name for name in columns if name.rpartition("_")[2] in UNITS and not name.startswith("dot_")]
    if channels == [drive]:
        raise InputError(f"recording '{file}': only {drive} was recorded; a column of voltage or force is needed too")
    if "voltage_V" in columns and len([name for name in channels if name.startswith("voltage")]) > 1:
        raise InputError(f"recording '{file}': has both voltage_V and voltage_1_V; number all of them or none")
    for name in [drive, *(name for name in channels if name != drive)]:
        _refuse_dead(name, columns[name], file, drive)


def refuse_untouched(drive: str, time_s: Floats, values: Floats, file: Path) -> None:
    """InputError for a run whose drive never leaves the clear, or its own noise."""
    if not segmented(time_s, values, drive == "displacement_mm").presses:
        raise InputError(
            f"recording '{file}', column {drive}: never rises out of its noise above {values.max():.3g}, "
            "this run never touches"
        )


def refuse_slow_sampling(run: Run, frequency_Hz: float, mechanism: str) -> None:
    """InputError when a run is sampled too slowly for a mechanism that acts up to a frequency."""
    rate = 1.0 / run.step_s
    needed = SAMPLES_PER_PERIOD * frequency_Hz
    if rate < needed:
        raise InputError(
            f"recording '{run.file}', column time_s: {rate:.3g} samples per second are too slow for {mechanism}, which "
            f"acts up to {frequency_Hz:.3g} Hz and needs {needed:.3g}"
        )


def suspicions(run: Run, path: Path, travel_mm: float = np.inf) -> list[str]:
    """Sentences on gaps, changes of rate, missing and saturated samples.

    travel_mm : beyond which the displacement of a coupon is hardly one in millimetres. For voltages and forces the
    model of the rig says what is plausible: see other_units.
    """
    said = []
    jumps, rates = gaps(run.time_s), rates_Hz(run.time_s)
    if len(jumps) > UNEVEN * len(run.time_s):
        return [f"recording '{path}', column time_s: sampling is uneven", *_of_channels(run, path, travel_mm)]
    if jumps:
        said.append(f"{place(path, jumps[0], 'time_s')}: time jumps (jumps in all: {len(jumps)})")
    if len(rates) > 1:
        shown = ", ".join(f"{rate:.4g}" for rate in rates[:MOST_RATES]) + (", ..." if len(rates) > MOST_RATES else "")
        said.append(f"recording '{path}': the sampling rate changes ({shown} Hz)")
    return said + _of_channels(run, path, travel_mm)


def _of_channels(run: Run, path: Path, travel_mm: float) -> list[str]:
    return [
        sentence
        for name, values in run.channels.items()
        for sentence in _of_channel(run, name, values, path, travel_mm if name == "displacement_mm" else np.inf)
    ]


def _of_channel(run: Run, name: str, values: Floats, path: Path, largest: float) -> list[str]:
    missing, limited = int((~run.valid[name]).sum()), int(run.saturated[name].sum())
    peak = float(np.nanmax(np.abs(values)))
    said = []
    if missing:
        first = int(np.argmin(run.valid[name]))
        said.append(f"{place(path, first, name)}: not measured; {missing} of {len(values)} samples are missing")
    if limited:
        first = int(np.argmax(run.saturated[name]))
        where = f"{place(path, first, name)} = {values[first]:g}"
        said.append(f"{where}: at the limit of the amplifier; {limited} such samples are not used")
    if peak > largest:
        row = int(np.nanargmax(np.abs(values)))
        where = f"{place(path, row, name)} = {values[row]:g}"
        said.append(f"{where}: more than {LARGEST_STRAIN:g} times the length of the specimen; are these micrometres?")
    return said


def _refuse_dead(name: str, values: Floats, file: Path, drive: str) -> None:
    """A channel without a sample, or that never changes, and a drive that is missing too often."""
    there = np.isfinite(values)
    if not there.any():
        raise InputError(f"recording '{file}', column {name}: every sample is missing")
    if np.ptp(values[there]) == 0.0:
        why = "nothing was pressed" if name == drive else "nothing was connected"
        raise InputError(f"recording '{file}', column {name}: is {values[there][0]:g} in every row, {why}")
    if name == drive and there.mean() < 0.5:
        raise InputError(
            f"{place(file, int(np.argmin(there)), name)} = nan: the drive is missing in {(~there).sum()} of "
            f"{len(values)} rows, at most half can be bridged"
        )

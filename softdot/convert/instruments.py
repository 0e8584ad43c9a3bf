"""Text files of oscilloscopes, force gauges, stages and testers: a header with names and units, and samples below it.

Tektronix TDS, TPS, TBS1000     Record Length,2.5e+03,,-0.25,2.0      settings on the left, time and value behind
Rigol DS1000Z, MSO5000          X,CH1,CH2,Start,Increment             then Sequence,Volt,Volt,-6e-03,2e-06
Keysight, Agilent InfiniiVision x-axis,1,2                            then second,Volt,Volt
Siglent                         Second,Value                          below settings with units and source
PicoScope                       Time,Channel A                        then (ms),(mV) and an empty line
LeCroy                          Time,Ampl                             below settings with segments
others                          Time(s),CH1(V), TIME,CH1, Zeit;Kraft  perhaps below settings, a row of units below
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from foundation.arrays import Floats
from foundation.errors import InputError
from softdot.convert.table_layout import Layout, find_layout
from softdot.convert.text_table import TextTable, read_text_table

LATEST_TIME_S = 1e10
"""Three centuries: a later time is not in seconds."""
DAYS, DAY_STEP = (2e4, 8e4), 1e-4
"""Days of a spreadsheet from 1954 to 2119, whose samples are less than nine seconds apart."""
STEP_TOLERANCE = 0.1  # relative, of the times and of what the settings say


@dataclass(frozen=True)
class LogChannel:
    """Samples of one channel: values (t,) in the unit V, N, mm or C; NaN where none was measured."""

    values: Floats
    unit: str


@dataclass(frozen=True)
class InstrumentLog:
    """The log of one instrument: rising times time_s (t,), and channels by the names that the instrument gives them."""

    time_s: Floats
    channels: Mapping[str, LogChannel]


def read_oscilloscope(file: Path | str) -> dict[str, Floats]:
    """Columns (t,) of an oscilloscope's file: time_s and the channels by the instrument's names, in s, V, N, mm or
    degrees C.

    NaN where a cell is empty. InputError for a file that cannot be read, a header or a unit that is not known, two
    columns of one name and a cell that is no number.
    """
    log = read_text_log(file)
    return {"time_s": log.time_s, **{name: channel.values for name, channel in log.channels.items()}}


def read_text_log(file: Path | str) -> InstrumentLog:
    """Read a text file of an instrument, with the unit of each channel. InputError."""
    return log_from_table(read_text_table(Path(file)))


def log_from_table(table: TextTable) -> InstrumentLog:
    """The log that a table of text holds. InputError."""
    layout = find_layout(table)
    rows = [row for row in range(layout.first, len(table.rows)) if any(table.rows[row])]
    _refuse_wide(table, rows, layout)
    _refuse_nameless(table, rows, layout)
    column = layout.time.column
    time = layout.time.offset + layout.time.factor * table.column(rows, column)
    if (late := first_not_rising(time)) is not None:
        where = f"{table.place(rows[late])}, column {column + 1}"
        raise InputError(f"{where} = '{table.cell(rows[late], column)[:40]}': every sample needs its time, which rises")
    if not layout.time.has_unit:
        _refuse_no_seconds(time, layout, table)
    channels = {
        name: LogChannel(unit.factor * table.column(rows, place), unit.base)
        for name, (place, unit) in layout.channels.items()
    }
    return InstrumentLog(time, channels)


def first_not_rising(time_s: Floats) -> int | None:
    """The first sample of times (t,) that is not later than the one before, or is missing; None where all rise."""
    late = np.flatnonzero(~(np.diff(time_s, prepend=-np.inf) > 0.0) | ~np.isfinite(time_s))
    return int(late[0]) if len(late) else None


def _refuse_wide(table: TextTable, rows: Sequence[int], layout: Layout) -> None:
    """InputError for a row with more cells than the header has columns, which comes of decimal commas."""
    most = max(len(table.rows[layout.first - 1 - n]) for n in range(min(3, layout.first))) if layout.first else 0
    for row in rows:
        if layout.first and any(table.rows[row][most:]):
            raise InputError(
                f"{table.place(row)}: has {len(table.rows[row])} cells, the header has {most} columns; where commas "
                "are decimals, columns need another sign between them"
            )


def _refuse_no_seconds(time_s: Floats, layout: Layout, table: TextTable) -> None:
    """InputError where times without a unit cannot be seconds: too late, or against a stated interval."""
    where = f"{table.place(layout.header or 0)}: the time has no unit"
    if np.abs(time_s).max() > LATEST_TIME_S:
        raise InputError(
            f"{where}, and {time_s[np.abs(time_s).argmax()]:g} can be no seconds; write it behind the name"
        )
    stated = layout.settings.interval_s
    step = float(np.median(np.diff(time_s))) if len(time_s) > 1 else 0.0
    if DAYS[0] < time_s[0] < DAYS[1] and 0.0 < step < DAY_STEP:
        raise InputError(f"{where}, and {time_s[0]:.12g} may count days, as in a spreadsheet; write it behind the name")
    if _is_clock(time_s, step):
        raise InputError(f"{where}, and reads as a clock, 59 being followed by 100; write seconds")
    if stated is not None and step > 0.0 and abs(step / stated[1] - 1.0) > STEP_TOLERANCE:
        raise InputError(
            f"{where}: its samples are {step:g} apart, and '{stated[0]}' above is {stated[1]:g} s; write the unit "
            "behind the name"
        )


def _is_clock(time_s: Floats, step: float) -> bool:
    """Whether times are HHMMSS: none has more than 59 seconds or minutes, and one jumps from 59 to 100."""
    seconds, minutes = time_s % 100.0, time_s // 100.0 % 100.0
    jumps = (seconds[:-1] >= 60.0 - 2.0 * step) & (seconds[1:] < 2.0 * step) & (np.diff(time_s) >= 40.0)
    return bool((seconds < 60.0).all() and (minutes < 60.0).all() and jumps.any())


def _refuse_nameless(table: TextTable, rows: Sequence[int], layout: Layout) -> None:
    """InputError for samples in a column behind the times that the header leaves empty."""
    header = table.rows[layout.header] if layout.header is not None else ()
    empty = [column for column, cell in enumerate(header) if not cell and column > layout.time.column]
    for row in rows:
        for column in empty:
            if table.cell(row, column):
                raise InputError(
                    f"{table.place(row)}, column {column + 1} = '{table.cell(row, column)[:40]}': the header has no "
                    "name for it"
                )

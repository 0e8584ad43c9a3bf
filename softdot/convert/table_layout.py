"""Where a text file of an instrument has its times, its channels and their units."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from foundation.errors import InputError
from softdot.convert.settings import Settings, settings_above, without_brackets
from softdot.convert.text_table import MISSING_SAMPLE, TextTable
from softdot.convert.units import Unit, assumed_unit, known_unit, split_name, unit_of

HEADER_ROWS = 200
"""Rows in which a header is looked for."""
TIME_NAME = re.compile(
    r"#?(?:(?:elapsed|test|running|total|run|rel(?:ative)?|abs(?:olute)?)[ _]*)?"
    r"(?:\w*time|\w*zeit|temps|tiempo|elapsed|t|s|x|x[- ]?axis|seconds?|secs?|millis|micros|in|time[ _]?stamp)"
    r"(?:[ _]*(?:elapsed|axis|base))?",
    re.IGNORECASE,
)
"""Names of columns of times."""
COUNTER_NAME = re.compile(r"#|nr|no\.?|n|index|idx|sample|samples|point|points|row|scan|segment", re.IGNORECASE)
"""Names of columns that count samples."""
CLOCK = re.compile(r"\d+[:./-]\d+[:./-]\d+")
"""2026-11-29T10:00:00, 29.11.2026, 10:00:00."""
DIGITAL_NAME = re.compile(r"D\d+(?:-D\d+)?", re.IGNORECASE)
"""Names of logic channels, whose cells are words of bits."""
START_STEP = re.compile(r"(?:t0|tInc)\s*=", re.IGNORECASE)
"""What Rigol writes behind the names of columns, t0 = -0.03."""
GENERIC_NAMES = {"value", "volt", "volts", "ampl", "amplitude"}
"""Names of a column whose channel is named in the settings, as source."""


@dataclass(frozen=True)
class TimeColumn:
    """The column of the times, with factor and offset to seconds; has_unit : whether the file states the unit."""

    column: int
    factor: float
    offset: float
    has_unit: bool


@dataclass(frozen=True)
class Layout:
    """Rows and columns of a text file.

    header : row of the names, None where settings give them. first : row of the first sample. channels : name -> column
    and unit.
    """

    header: int | None
    first: int
    time: TimeColumn
    channels: Mapping[str, tuple[int, Unit]]
    settings: Settings


def find_layout(table: TextTable) -> Layout:
    """The layout of a table: rows and columns of times and channels. InputError."""
    if _is_beside_settings(table):
        return _layout_beside_settings(table)
    for row in range(min(HEADER_ROWS, len(table.rows))):
        column = _time_column(table, row)
        if column is not None:
            return _layout_below_header(table, row, column)
    _refuse_clock(table)
    raise InputError(
        f"'{table.file}' row 1: no header of an oscilloscope or another instrument; known are those of Tektronix, "
        "Rigol, Keysight, Siglent, PicoScope and LeCroy, and a row with names and units such as Time(s),CH1(V)"
    )


def _refuse_clock(table: TextTable) -> None:
    """InputError for a time, in the row below its name or its unit, that is a date or a clock."""
    for row in range(min(HEADER_ROWS, len(table.rows) - 1)):
        for column, cell in enumerate(table.rows[row]):
            below = next((text for n in (row + 1, row + 2) if CLOCK.match(text := _cell(table, n, column))), None)
            if below is not None and _is_time(cell):
                where = f"{table.place(row)}: column '{cell[:40]}'"
                raise InputError(f"{where} is a date or a clock, such as '{below[:40]}'; write seconds")


def _cell(table: TextTable, row: int, column: int) -> str:
    return table.cell(row, column) if row < len(table.rows) else ""


def _time_column(table: TextTable, row: int) -> int | None:
    """The column of times in a row that is a header, one of names with numbers below; None for any other row."""
    cells = table.rows[row]
    if sum(bool(cell) for cell in cells) < 2 or table.is_number(cells[0]) or "unit" in cells[0].lower():
        return None
    for column, cell in enumerate(cells):
        first = _first_sample(table, row, column) if _is_time(cell) else None
        if first is not None and not any(
            _is_header(table.rows[below], column, table) for below in range(row + 1, first)
        ):
            return column
    return None


def _is_header(cells: Sequence[str], column: int, table: TextTable) -> bool:
    """Whether a row below a time is a header too: it has a time among names, not only units, or start and increment."""
    under = known_unit(without_brackets(cells[column])) if column < len(cells) else None
    told = (
        known_unit(without_brackets(cell), "load") or table.is_number(cell) for cell in cells if cell
    )  # g and kg too
    return any(_is_time(cell) for cell in cells) and not all(told) and (under is None or under.base != "s")


def _is_time(cell: str) -> bool:
    """Whether a name, without its unit, is that of a time; a single letter only where its unit is no other."""
    bare = re.sub(r"\s*[(\[{].*", "", cell.strip())
    parts = [bare, bare.rpartition("_")[0], bare.rpartition(",")[0], bare.rpartition("/")[0], bare.rpartition(" ")[0]]
    found = {part.strip() for part in parts if part.strip() and TIME_NAME.fullmatch(part.strip())}
    if not found or max(map(len, found)) > 2:
        return bool(found)
    try:
        unit = split_name(cell, "")[1]
    except InputError:
        return False
    return unit is None or unit.base == "s"


def _first_sample(table: TextTable, row: int, column: int) -> int | None:
    """The row of the first number below a header, with a row of units and empty ones between them at most.

    A row that begins with a word before that number is a setting.
    """
    between = 0
    for below in range(row + 1, min(row + 6, len(table.rows))):
        is_setting = column > 0 and table.cell(below, 0)[:1].isalpha()
        text = table.cell(below, column).replace("\u2212", "-")
        if not is_setting and (table.is_number(text) or MISSING_SAMPLE.fullmatch(text)):
            return below
        between += any(table.rows[below])
        if between > 1:
            return None
    return None


def _layout_below_header(table: TextTable, row: int, column: int) -> Layout:
    """The layout where names are in a row, and units there, in the row below or in settings above. InputError."""
    first = _first_sample(table, row, column)
    assert first is not None
    settings = settings_above(table, row)
    units = next((table.rows[n] for n in range(row + 1, first) if any(table.rows[n])), [])
    header = table.rows[row]
    steps = {cell.lower(): n for n, cell in enumerate(header) if cell.lower() in ("start", "increment")}
    _refuse_segments(settings, table)
    channels = _channels_with_units(
        table, row, _channel_cells(table, row, column, set(steps.values())), units, settings
    )
    return Layout(row, first, _time_column_units(table, row, column, units, steps, settings), channels, settings)


def _channels_with_units(
    table: TextTable, row: int, places: Sequence[tuple[int, str]], units: Sequence[str], settings: Settings
) -> dict[str, tuple[int, Unit]]:
    """Name -> column and unit of channels (column, cell of the header). InputError for two of one name, or none."""
    where, sources = table.place(row), settings.values.get("source", [])
    found = [(place, cell, *split_name(cell, where)) for place, cell in places]
    names = [name or cell for _, cell, name, _ in found]
    if len(sources) == len(names):
        names = [source if name.lower() in GENERIC_NAMES else name for name, source in zip(names, sources, strict=True)]
    names = [f"CH{name}" if name.isdecimal() else name for name in names]
    channels: dict[str, tuple[int, Unit]] = {}
    assumed = []
    for n, ((place, cell, _, unit), name) in enumerate(zip(found, names, strict=True)):
        if name in channels:
            raise InputError(f"{where}: two columns are called '{name[:40]}'; give each its own name")
        beside = [row[place] if place < len(row) else "" for row in (units, settings.units)]
        beside.append(settings.unit_of_channel(n, names, where))
        channels[name] = (place, _agreed_unit(unit or known_unit(cell), beside, name, where))
        assumed += [] if unit or known_unit(cell) or any(map(without_brackets, beside)) else [name]
        if channels[name][1].base == "s":
            raise InputError(f"{where}: column '{name[:40]}' is a second time; leave it out")
    if not channels:
        raise InputError(f"{where}: has no column beside the time")
    if assumed and any(unit.base == "V" and unit.factor != 1.0 for _, unit in channels.values()):
        raise InputError(f"{where}: column '{assumed[0][:40]}' has no unit, and another voltage is not in V; write it")
    return channels


def _channel_cells(table: TextTable, row: int, column: int, without: set[int]) -> list[tuple[int, str]]:
    """Column and cell of the header of each measured channel. InputError for a second column of times."""
    found = []
    for n, cell in enumerate(table.rows[row]):
        if n == column or n in without or not cell or DIGITAL_NAME.fullmatch(cell):
            continue
        if (n < column and COUNTER_NAME.fullmatch(cell)) or START_STEP.match(cell):
            continue
        if _is_time(cell):
            raise InputError(
                f"{table.place(row)}: two columns are times, '{table.rows[row][column]}' and '{cell[:40]}'"
            )
        found.append((n, cell))
    return found


def _agreed_unit(unit: Unit | None, beside: Sequence[str], name: str, where: str) -> Unit:
    """The unit of a channel by its header, the rows beside it or the settings above. InputError where they differ."""
    told = [unit] if unit is not None else []
    told += [unit_of(without_brackets(text), name, where) for text in beside if without_brackets(text)]
    if any(one != told[0] for one in told):
        raise InputError(f"{where}: column '{name[:40]}' has two units, in its header and beside it")
    return told[0] if told else assumed_unit(name, where)


def _time_column_units(
    table: TextTable, row: int, column: int, units: Sequence[str], steps: Mapping[str, int], settings: Settings
) -> TimeColumn:
    """The column of times and its factor to seconds: of sequence numbers, of a stated unit, or 1. InputError."""
    where = table.place(row)
    beside = [without_brackets(cells[column]) if column < len(cells) else "" for cells in (units, settings.units)]
    name, unit = split_name(table.rows[row][column], where)
    if beside[0].lower() in ("sequence", "sample", "samples") and steps:
        return TimeColumn(column, *_start_and_step(table, row, steps), has_unit=True)
    named = known_unit(name) if unit is None else None  # second as a name
    if named is not None and named.base == "s":
        unit = named
    beside += settings.time_units
    told = unit is not None or any(beside) or bool(steps)
    if not told and not TIME_NAME.fullmatch(name):
        raise InputError(f"{where}: column '{name[:40]}' is a time, and what is behind its name is not a known unit")
    if not told and any(units):
        raise InputError(f"{where}: column '{name[:40]}' has no unit, and others have one in the row below")
    agreed = _agreed_unit(unit if told else Unit("s", 1.0), beside, name, where)
    if agreed.base != "s":
        raise InputError(f"{where}: column '{name[:40]}' is a time and must be in a unit of time")
    return TimeColumn(column, agreed.factor, 0.0, told)


def _start_and_step(table: TextTable, row: int, steps: Mapping[str, int]) -> tuple[float, float]:
    """Increment and start of sequence numbers, which stand in the row of units. InputError where they are missing."""
    below = row + 1
    values = {}
    for name in ("increment", "start"):
        text = table.cell(below, steps[name]) if name in steps and below < len(table.rows) else ""
        if not table.is_number(text):
            raise InputError(f"{table.place(below)}: start and increment of the time are missing")
        values[name] = table.number(below, steps[name])
    return values["increment"], values["start"]


def _refuse_segments(settings: Settings, table: TextTable) -> None:
    """InputError for several recordings in one file, as LeCroy writes a sequence."""
    for key in ("segments", "fastframe count"):
        value = settings.number(key)
        if table.is_number(value) and float(value.replace(",", ".")) > 1.0:
            raise InputError(
                f"'{table.file}': holds {value} segments one after the other; save each in a file of its own"
            )


def _is_beside_settings(table: TextTable) -> bool:
    """Whether the first samples stand in the same rows as the settings, in the fourth and fifth column."""
    cells = table.rows[0] if table.rows else []
    return (
        len(cells) > 4
        and cells[0].lower() == "record length"
        and table.is_number(cells[3])
        and table.is_number(cells[4])
    )


def _layout_beside_settings(table: TextTable) -> Layout:
    """The layout where settings are in the first columns, time and value in the fourth and fifth. InputError."""
    rows = (table.rows[n] for n in range(min(HEADER_ROWS, len(table.rows))))
    first = {cells[0].lower(): cells[1] for cells in rows if len(cells) > 1}
    where = table.place(0)
    wide = next((n for n, cells in enumerate(table.rows) if any(cells[5:])), None)
    if wide is not None:
        raise InputError(
            f"{table.place(wide)}, column 6 and beyond: several channels side by side; save each in a file"
        )
    name = first.get("source", "") or "CH1"
    time = unit_of(first.get("horizontal units", "") or "s", "time", where)
    if time.base != "s":
        raise InputError(f"{where}: the horizontal unit must be one of time")
    unit = unit_of(first.get("vertical units", "") or "V", name, where)
    return Layout(None, 0, TimeColumn(3, time.factor, 0.0, True), {name: (4, unit)}, Settings({}, []))

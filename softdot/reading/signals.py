"""The arrays of a reading: those of signals.npz, and those that its page plays."""

from typing import Any

import numpy as np

from foundation.arrays import Floats, Ints
from softdot.reading.cells import braille
from softdot.reading.decoders.fitted import Track
from softdot.reading.decoders.hand import HandTrack
from softdot.reading.line import cell_pitch_mm, nominal_line
from softdot.reading.line_reading import LineReading
from softdot.reading.score import align


def signal_arrays(reading: LineReading) -> dict[str, Floats]:
    """The arrays of signals.npz.

    cell_true is -1 where it is not known, cell_read -1 where a cell was missed; added cells have no row.
    """
    pitch, first, true = cell_pitch_mm(reading.reader.standard), reading.first, reading.cells_true
    heard = reading.voltages
    if true is None:
        read, at, known = first.cells, first.passed_s, np.full(len(first.cells), -1)
    else:
        number = _read_numbers(true, first.cells)
        read, passed = (np.append(row, missed)[number] for row, missed in ((first.cells, -1), (first.passed_s, np.nan)))
        at, known = passed if reading.path is None else reading.path.reached_s, true
    return {
        "time_s": heard.time_s,
        "voltage_V": heard.voltage_V,
        "position_mm": _place_mm(reading, pitch),
        "x_mm": pitch * np.arange(len(read), dtype=np.float64),
        "cell_true": np.asarray(known, dtype=np.int64),
        "cell_read": np.asarray(read, dtype=np.int64),
        "read_time_s": np.asarray(at, dtype=np.float64),
    }


def _read_numbers(true: Ints, read: Ints) -> Ints:
    """Number of the read cell of each true one (c,); -1 where it was missed."""
    pairs = align([int(one) for one in true], [int(one) for one in read])
    partner = {i: j for i, j in pairs if i is not None and j is not None}
    return np.array([partner.get(i, -1) for i in range(len(true))], dtype=np.int64)


def _place_mm(reading: LineReading, pitch: float) -> Floats:
    """Place (t,) of the array's middle from the first cell that was read: as simulated, else as tracked."""
    if reading.path is not None:
        return np.interp(reading.voltages.time_s, reading.path.time_s, reading.path.x_mm)
    if isinstance(reading.seen, HandTrack):
        return reading.seen.place_mm(reading.voltages.time_s)
    if isinstance(reading.seen, Track):
        place = reading.seen.place_mm(reading.voltages.time_s)
        begin = reading.first.passed_s[0] if len(reading.first.passed_s) else reading.seen.passed_s[0]
        return np.asarray(place - np.interp(begin, reading.voltages.time_s, place))
    assert reading.reader.presses is not None
    return np.asarray(pitch * np.floor(reading.voltages.time_s / reading.reader.presses.period_s))


def page_signals(reading: LineReading) -> dict[str, Any]:
    """The arrays that the page of a reading plays (export.array.reading_page).

    The dots are those of the line, with their heights; of a recording those that the standard has for its cells, the
    most likely ones where the true ones are not known.
    """
    kept, first = signal_arrays(reading), reading.first
    stated = first.cells if reading.cells_true is None else reading.cells_true
    partner = np.arange(len(stated)) if reading.cells_true is None else _read_numbers(stated, first.cells)
    unknown = np.full(len(first.cells), -1)
    likely = np.append(unknown if first.likely is None else first.likely, -1)[partner]
    probability = np.append(unknown if first.probability is None else first.probability, -1)[partner]
    true = np.where(stated >= 0, stated, np.maximum(likely, 0))
    line = nominal_line(true, reading.reader.standard) if reading.line is None else reading.line
    height = reading.reader.standard.nominal_mm("height_mm")
    read = [braille([cell]) for cell in kept["cell_read"]]
    number = np.arange(len(true))
    passed = np.isfinite(kept["read_time_s"])
    at = (
        np.interp(number, number[passed], kept["read_time_s"][passed])
        if passed.any()
        else number * reading.voltages.step_s
    )
    return {
        **{name: kept[name] for name in ("time_s", "voltage_V", "position_mm")},
        "cell_x_mm": kept["x_mm"],
        "cell_true": np.array([braille([cell]) for cell in true]),
        "cell_read": np.array(read),
        "cell_likely": np.array([braille([int(cell)]) if cell >= 0 else "" for cell in likely]),
        "cell_probability": probability.astype(np.float64),
        "read_time_s": np.maximum.accumulate(at),
        "dot_x_mm": line.x_mm,
        "dot_y_mm": line.y_mm,
        "dot_height_mm": np.maximum(height + line.extra_mm, 0.0),
    }

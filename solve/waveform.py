"""How far the press has come at a time: the fraction of its final depth or force."""

import csv
from functools import lru_cache
from pathlib import Path

import numpy as np

from geometry.errors import InputError
from geometry.text_file import read_text, regular_file
from mesh.types import Floats
from solve.parameters import Waveform

LARGEST_S = 1e12


def duration_s(waveform: Waveform) -> float:
    """Time at which the waveform has ended."""
    if waveform.shape == "file":
        return float(_table(waveform)[-1, 0])
    if waveform.shape == "half-sine":
        return 2.0 * waveform.rise_s
    fall = waveform.fall_s if waveform.shape == "trapezoid" else 0.0
    return waveform.rise_s + (waveform.hold_s if waveform.shape in ("ramp", "trapezoid") else 0.0) + fall


def corners_s(waveform: Waveform) -> Floats:
    """Times (n,) from 0 to the end at which the rate may jump; of a file its samples, thinned to 200."""
    if waveform.shape == "file":
        table = _table(waveform)
        return np.asarray(table[np.unique(np.linspace(0, len(table) - 1, min(len(table), 200)).astype(int)), 0])
    corners = [0.0, waveform.rise_s]
    if waveform.shape in ("ramp", "trapezoid") and waveform.hold_s > 0.0:
        corners.append(waveform.rise_s + waveform.hold_s)
    if duration_s(waveform) > corners[-1]:
        corners.append(duration_s(waveform))
    return np.array(corners)


def fraction(waveform: Waveform, time_s: Floats) -> Floats:
    """Fraction of the final depth or force, 0 to 1, same shape as time_s. InputError for a bad file."""
    relative = np.clip(time_s / waveform.rise_s, 0.0, None)
    if waveform.shape == "ramp":
        return np.minimum(relative, 1.0)
    if waveform.shape == "half-sine":
        return np.sin(np.pi / 2.0 * np.minimum(relative, 2.0))
    if waveform.shape == "raised-cosine":
        return 0.5 * (1.0 - np.cos(np.pi * np.minimum(relative, 1.0)))
    if waveform.shape == "trapezoid":
        end = waveform.rise_s + waveform.hold_s + waveform.fall_s
        return np.clip(np.minimum(relative, (end - time_s) / waveform.fall_s), 0.0, 1.0)
    table = _table(waveform)
    return np.interp(time_s, table[:, 0], table[:, 1])


def _table(waveform: Waveform) -> Floats:
    """The columns time_s, fraction of a file, (n, 2)."""
    if waveform.file is None:
        raise InputError("press.waveform.file is missing: shape = 'file' needs a CSV file")
    file = Path(waveform.file)
    regular_file(file, _told(file))
    stat = file.stat()
    return _read(file, stat.st_mtime_ns, stat.st_size)


def _told(file: Path) -> str:
    return f"press.waveform.file = '{file}'"


@lru_cache(maxsize=8)
def _read(file: Path, _modified_ns: int, _size: int) -> Floats:
    """Read and checked once for each state of the file, as a press asks for it at every step."""
    where = _told(file)
    text = read_text(file, where)
    try:
        rows = list(csv.DictReader(text.splitlines()))
        table = np.array([(float(row["time_s"]), float(row["fraction"])) for row in rows]).reshape(-1, 2)
    except (KeyError, TypeError, ValueError, csv.Error):
        raise InputError(f"{where}: needs the columns time_s and fraction with a number in each row") from None
    bad = np.flatnonzero(~(np.abs(table) <= LARGEST_S).all(axis=1))  # NaN passes no comparison
    if len(bad):
        time, share = table[bad[0]]
        raise InputError(
            f"{where} sample {bad[0] + 1} = ({time:g}, {share:g}): time_s and fraction must be finite numbers "
            f"of at most {LARGEST_S:g}"
        )
    if len(table) < 2 or not (np.diff(table[:, 0]) > 0).all() or table[:, 1].min() < 0 or table[:, 1].max() > 1:
        raise InputError(f"{where}: time_s must increase and fraction stay between 0 and 1, in at least two rows")
    table.flags.writeable = False
    return table

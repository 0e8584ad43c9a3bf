"""Binary files are read in a process of their own, since a damaged one may crash the interpreter.

Started as a module with four arguments: the reader, the file, a folder and the process number of its parent. The folder
holds asked.json, what the reader is asked; it leaves read.npz there, or refused.txt with one sentence.
"""

import json
import os
import re
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from foundation.arrays import Floats
from foundation.child_processes import child_python_path, end_with_parent, python_command
from foundation.errors import InputError
from foundation.files import regular_file_size
from foundation.nearest_name import nearest_name_hint
from foundation.scratch_folders import scratch_folder
from softdot.convert.text_table import file_text
from softdot.convert.units import known_unit

LONGEST_READ_S = 600.0
"""Time after which the process of a reader is ended."""
HDF5_MAJOR_VERSION = 2
"""Major version of the .mat files that MATLAB calls 7.3. They are refused: save(..., '-v7') spares an HDF5 library."""
Arrays = dict[str, Any]


def read_in_own_process(reader: str, file: Path, asked: Mapping[str, str] | None = None) -> Arrays:
    """The arrays that a reader of READERS makes of a file. InputError, also where its process dies or is too slow."""
    regular_file_size(file, f"'{file}'")
    with scratch_folder() as folder:
        (folder / "asked.json").write_text(json.dumps(dict(asked or {})), "utf-8")
        command = python_command("-m", "softdot.convert.apart", reader, str(file), str(folder), str(os.getpid()))
        try:
            done = subprocess.run(
                command,
                env={**os.environ, **child_python_path()},
                stdin=subprocess.DEVNULL,
                capture_output=True,
                timeout=LONGEST_READ_S,
                start_new_session=True,
                check=False,
            )
        except subprocess.TimeoutExpired:
            raise InputError(f"'{file}': is not read within {LONGEST_READ_S:g} s") from None
        if (folder / "refused.txt").exists():
            raise InputError((folder / "refused.txt").read_text("utf-8"))
        if done.returncode != 0 or not (folder / "read.npz").exists():
            raise InputError(f"'{file}': cannot be read as a {reader} file (its reader broke down; is it damaged?)")
        with np.load(folder / "read.npz", allow_pickle=False) as kept:
            return {name: kept[name] for name in kept.files}


def main(reader: str, file: Path, folder: Path) -> None:
    """Read a file and leave in the folder what was read, or a sentence on why it could not be."""
    asked = json.loads((folder / "asked.json").read_text("utf-8"))
    try:
        found = READERS[reader](file, asked)
    except InputError as error:
        said = str(error)
    except ImportError as error:
        said = f"'{file}': reading it needs {error.name or 'a library'}, pip install 'softdot[convert]'"
    except Exception as error:  # libraries raise what a wrong file happens to lead to
        why = " ".join(str(error).split())[:200] or type(error).__name__
        said = f"'{file}': cannot be read as a {reader} file ({why})"
    else:
        np.savez(folder / "read.npz", **found)
        return
    (folder / "refused.txt").write_text(said, "utf-8", errors="replace")


def matlab_columns(file: Path, asked: Mapping[str, str]) -> Arrays:
    """Columns (t,) of a .mat file. asked : column -> variable, 'name.field' for a field of a structure. InputError."""
    from scipy.io import loadmat
    from scipy.io.matlab import matfile_version

    version, _ = matfile_version(file, appendmat=False)
    if version == HDF5_MAJOR_VERSION:
        raise InputError(f"'{file}': is a version 7.3 file; save it again in MATLAB with save(..., '-v7')")
    tables = loadmat(file, squeeze_me=True, simplify_cells=True, appendmat=False)
    return {column: _vector(tables, path, file) for column, path in asked.items()}


def _vector(tables: Mapping[str, object], path: str, file: Path) -> Floats:
    """One real variable of a .mat file as (t,). InputError."""
    value: object = tables
    for name in path.split("."):
        known = {key for key in value if not key.startswith("__")} if isinstance(value, Mapping) else set()
        if not isinstance(value, Mapping) or name not in known:
            raise InputError(f"'{file}': has no variable '{path}'; {nearest_name_hint(name, known)}")
        value = value[name]
    array = np.asarray(value)
    if array.dtype.kind not in "fiu" or array.ndim != 1:
        raise InputError(f"'{file}': variable '{path}' has shape {array.shape}, one column of real numbers is needed")
    return array.astype(np.float64)


def tdms_log(file: Path, _asked: Mapping[str, str]) -> Arrays:
    """The log in a .tdms file of LabVIEW, by npTDMS. InputError for channels that are not sampled at the same times."""
    from nptdms import TdmsFile  # type: ignore[import-not-found, unused-ignore]

    with TdmsFile.open(file) as opened:
        found = [channel for group in opened.groups() for channel in group.channels() if len(channel)]
        timed = [channel for channel in found if "wf_increment" in channel.properties]
        if not timed or len(timed) < len(found):
            raise InputError(f"'{file}': a channel has no increment of time (wf_increment); save waveforms")
        starts = [channel.properties.get("wf_start_time") for channel in timed]
        late = [0.0 if None in (start, starts[0]) else _seconds_between(starts[0], start) for start in starts]
        scales = [_seconds_of_unit(channel.properties.get("wf_xunit_string", ""), file) for channel in timed]
        times = [by + scale * channel.time_track() for by, scale, channel in zip(late, scales, timed, strict=True)]
        units = [str(channel.properties.get("unit_string", channel.properties.get("NI_UnitDescription", "")))
                 for channel in timed]  # fmt: skip
        values = [np.asarray(channel[:], dtype=np.float64) for channel in timed]
        return _log_arrays(file, times, [channel.name for channel in timed], units, values)


def _seconds_between(first: Any, other: Any) -> float:
    return float(np.timedelta64(other - first) / np.timedelta64(1, "s"))


def _seconds_of_day(text: str) -> float:
    """Seconds since midnight of a time of day such as 10:15:30,5."""
    hours, minutes, seconds = (float(part) for part in text.replace(",", ".").split(":"))
    return 3600.0 * hours + 60.0 * minutes + seconds


def _seconds_of_unit(unit: str, file: Path) -> float:
    """Seconds in one unit of time. InputError for a unit of anything else."""
    known = known_unit(unit or "s")
    if known is None or known.base != "s":
        raise InputError(f"'{file}': its samples are along '{unit}', which is no unit of time")
    return known.factor


def lvm_log(file: Path, _asked: Mapping[str, str]) -> Arrays:
    """The log in an .lvm file of LabVIEW, by lvm_read; a pickle beside the file is not read. InputError."""
    import lvm_read  # type: ignore[import-not-found, unused-ignore]

    found = lvm_read.read_str(file_text(file))
    if found["Segments"] != 1:
        raise InputError(f"'{file}': holds {found['Segments']} segments one after the other; save each in its own file")
    if found.get("X_Columns", "One") == "Multi":
        raise InputError(f"'{file}': has a column of times for each channel (X_Columns Multi); save it with one")
    if found.get("Time_Pref", "Relative") not in ("Relative", "Absolute"):
        raise InputError(f"'{file}': Time_Pref = '{found['Time_Pref']}' must be Relative or Absolute")
    segment = found[0]
    along = {text for text in segment.get("X_Dimension", []) if text} - {"Time"}
    if along:
        raise InputError(f"'{file}': its samples are along {along.pop()}, not along time")
    count = int(segment["Channels"])
    table = np.asarray(segment["data"], dtype=np.float64)
    if found.get("X_Columns", "One") == "No":
        late = [_seconds_of_day(text) for text in segment.get("Time", []) if text] or [0.0] * count
        steps = zip(segment["X0"], segment["Delta_X"], late, strict=False)
        times = [x0 + by - late[0] + step * np.arange(len(table)) for x0, step, by in steps]
        values, names = table, list(segment["Channel names"])
    else:
        times, values, names = [table[:, 0]] * count, table[:, 1:], list(segment["Channel names"])[1:]
    scales = {_seconds_of_unit(text.strip(), file) for text in segment.get("X_Unit_Label", []) if text.strip()} or {1.0}
    if len(scales) > 1:
        raise InputError(f"'{file}': its times are in several units; save its channels apart")
    times = [scales.copy().pop() * time for time in times]
    units = [text.strip() for text in segment.get("Y_Unit_Label", [""] * count)]
    return _log_arrays(file, times[:count], names[:count], units[:count], list(values.T[:count]))


def waveform_log(file: Path, _asked: Mapping[str, str]) -> Arrays:
    """The log in a binary file of Rigol, Tektronix, LeCroy, Keysight, Siglent, Rohde & Schwarz or Yokogawa."""
    from RigolWFM.wfm import Wfm  # type: ignore[import-not-found, unused-ignore]

    shown = [channel for channel in Wfm.from_file(str(file)).channels if channel.volts is not None]
    units = [{"v": "V", "a": "A", "w": "W"}.get(channel.unit.name, "of its own") for channel in shown]
    names = [re.sub(r"\s+", "", channel.name) for channel in shown]
    return _log_arrays(file, [channel.times for channel in shown], names, units, [channel.volts for channel in shown])


def _log_arrays(
    file: Path, times: Sequence[Floats], names: Sequence[str], units: Sequence[str], values: Sequence[Floats]
) -> Arrays:
    """The arrays of a log: time_s (t,), names, units (n,), values (n, t). InputError for channels with other times."""
    if not times or len({len(names), len(units), len(values), len(times)}) != 1:
        raise InputError(f"'{file}': holds no channel, or channels without name or unit")
    for name, time, column in zip(names, times, values, strict=True):
        if len(time) != len(times[0]) or len(column) != len(time) or not _alike(time, times[0]):
            raise InputError(f"'{file}': '{name}' was sampled at other times than '{names[0]}'; save them apart")
    return {
        "time_s": np.asarray(times[0]),
        "names": np.array(names),
        "units": np.array(units),
        "values": np.array(values),
    }


def _alike(time_s: Floats, other_s: Floats) -> bool:
    """Whether steps are equal within a tenth of one, or within the digits that are left at late times."""
    step = float(np.median(np.diff(time_s))) if len(time_s) > 1 else 1.0
    return bool((np.abs(time_s - other_s) <= 0.1 * step + 4.0 * np.spacing(np.abs(time_s).max())).all())


READERS: dict[str, Callable[[Path, Mapping[str, str]], Arrays]] = {
    ".mat": matlab_columns,
    ".tdms": tdms_log,
    ".lvm": lvm_log,
    "waveform": waveform_log,
}
"""Ending of a file, or kind of it -> its reader."""


if __name__ == "__main__":
    end_with_parent(int(sys.argv[4]))
    main(sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3]))

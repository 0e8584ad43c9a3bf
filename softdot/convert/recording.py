"""Write a recording: rig.toml with the lines of each run, and its CSV files, whole or not at all."""

import json
from collections.abc import Mapping
from pathlib import Path, PurePosixPath, PureWindowsPath
from tempfile import TemporaryDirectory

import numpy as np

from foundation.arrays import Floats
from foundation.errors import InputError
from softdot.config.rig import RIG_FILE, load_rig


def write_recording(out: Path | str, rig: str, files: Mapping[str, Mapping[str, Floats]]) -> None:
    """Write a new folder with rig.toml and CSV files. files : name -> column -> samples (t,).

    It is read back by the rules of softdot diagnose before it takes its place. InputError when out exists and holds
    anything, for a file that would not lie in it, and when what was written is no recording.
    """
    out = Path(out)
    for name, columns in files.items():
        _refuse_outside(name)
        _refuse_uneven(name, columns)
    if out.exists() and (not out.is_dir() or any(out.iterdir())):
        raise InputError(f"output '{out}': exists already; name a new or empty folder")
    try:
        out.parent.mkdir(parents=True, exist_ok=True)
        with TemporaryDirectory(prefix=f".{out.name}.", dir=out.parent) as beside:  # of this process alone
            staging = Path(beside) / out.name
            staging.mkdir()
            (staging / RIG_FILE).write_text(rig, "utf-8")
            for name, columns in files.items():
                _write_columns(staging / name, columns)
            _refuse_unreadable(staging, out)
            staging.replace(out)
    except OSError as error:
        raise InputError(f"output '{out}': cannot be written ({error.strerror})") from None


def _refuse_unreadable(staging: Path, out: Path) -> None:
    """InputError, naming the folder that was asked for, where what was written is no recording."""
    try:
        load_rig(staging)
    except InputError as error:
        raise InputError(str(error).replace(str(staging), str(out))) from None


def _refuse_outside(name: str) -> None:
    """InputError unless this is the name of a file of samples in the folder itself."""
    if PurePosixPath(name).name != name or PureWindowsPath(name).name != name or name in (RIG_FILE, "", "..", "."):
        raise InputError(f"files: '{name[:60]}' must be the name of a file in the folder of the recording, not a path")


def _refuse_uneven(name: str, columns: Mapping[str, Floats]) -> None:
    """InputError unless the columns are of one length."""
    sizes = {column: np.shape(values) for column, values in columns.items()}
    if not sizes or len(set(sizes.values())) > 1 or len(next(iter(sizes.values()))) != 1:
        raise InputError(f"files: the columns of '{name}' must have as many samples each; they have {sizes}")


def _write_columns(file: Path, columns: Mapping[str, Floats]) -> None:
    """A header and one row per sample, with nine digits: more than any converter has; of a time since 1970 more."""
    digits = ["%.15g" if name == "time_s" else "%.9g" for name in columns]
    np.savetxt(file, np.column_stack(list(columns.values())), digits, ",", header=",".join(columns), comments="")


def run_text(
    file: str,
    label: str,
    drive: str,
    *,
    temperature_C: float | None = None,
    nuisance: Mapping[str, float] | None = None,
    noise: Mapping[str, float] | None = None,
) -> str:
    """The TOML text of a table [[runs]] with its sub-tables."""
    lines = [
        "[[runs]]",
        f"file = {_toml_string(file)}",
        f"label = {_toml_string(label)}",
        f"drive = {_toml_string(drive)}",
    ]
    if temperature_C is not None:
        lines.append(f"temperature_C = {temperature_C}")
    for name, table in (("nuisance", nuisance), ("noise", noise)):
        if table:
            lines += [f"[runs.{name}]", *(f"{_toml_key(key)} = {value:.3g}" for key, value in table.items())]
    return "\n".join(lines) + "\n"


def _toml_string(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)


def _toml_key(name: str) -> str:
    return f'"{name}"' if "." in name else name


def white_noise(values: Floats) -> float:
    """Standard deviation of white noise, by third differences of (t,), which a smooth curve hardly has.

    von Neumann, Annals of Mathematical Statistics 12 (1941) 367, for the first difference; the third has the weights
    (1, -3, 3, -1) and 20 times the variance. Slow noise is not counted.
    """
    return float(np.sqrt(np.mean(np.diff(values, 3) ** 2) / 20.0))

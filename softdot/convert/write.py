"""Write a recording: rig.toml and its CSV files, whole or not at all."""

from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from geometry.base import InputError
from mesh.types import Floats
from softdot.rig_file import RIG_FILE, load_rig


def write_recording(out: Path | str, rig: str, files: Mapping[str, Mapping[str, Floats]]) -> None:
    """A new folder with rig.toml and one CSV per item, file name -> column -> samples (t,).

    It is read back by the rules of softdot diagnose before it takes its place. InputError when out exists and holds
    anything, or when what was written is no recording.
    """
    out = Path(out)
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
            load_rig(staging)
            staging.replace(out)
    except OSError as error:
        raise InputError(f"output '{out}': cannot be written ({error.strerror})") from None


def _write_columns(file: Path, columns: Mapping[str, Floats]) -> None:
    """A header and one row per sample, with nine digits: more than any converter has."""
    np.savetxt(file, np.column_stack(list(columns.values())), "%.9g", ",", header=",".join(columns), comments="")

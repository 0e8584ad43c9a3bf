"""From rig.toml's runs and their files to a recording that is fit to be explained."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from diagnose.checks import LARGEST_STRAIN, refuse_bad_columns, refuse_bad_time, refuse_untouched, suspicions
from diagnose.columns import read_columns, refuse_by_size
from diagnose.recording import Recording, Run
from diagnose.saturation import saturated
from diagnose.tables import RunTable, Specimen
from geometry.base import InputError
from mesh.types import Bools, Floats
from solve.parameters import Readout

COVARIATES = ("dot_x_mm", "dot_y_mm", "temperature_C")


def read_recording(
    folder: Path, runs: Sequence[RunTable], readouts: Sequence[Readout | None], specimen: Specimen | None
) -> Recording:
    """All runs of a folder. InputError naming file, row and column; every size is checked before any file is read."""
    names = [run.name for run in runs]
    for number, name in enumerate(names):
        if name in names[:number]:
            raise InputError(f"recording '{folder / 'rig.toml'}': runs[{number}].label = '{name}' appears twice")
    refuse_by_size(folder / run.file for run in runs)
    pairs = [
        (read_run(folder, table, readout, touches=specimen is None), folder / table.file)
        for table, readout in zip(runs, readouts, strict=True)
    ]
    travel_mm = np.inf if specimen is None else LARGEST_STRAIN * specimen.gauge_mm
    warnings = [sentence for run, path in pairs for sentence in suspicions(run, path, travel_mm)]
    return Recording(tuple(run for run, _ in pairs), specimen, tuple(warnings))


def read_run(folder: Path, table: RunTable, readout: Readout | None, touches: bool = True) -> Run:
    """One run. touches : whether the dot has to touch; a coupon is held from the start. InputError."""
    path = folder / table.file
    columns = read_columns(path)
    refuse_bad_time(columns["time_s"], path)
    refuse_bad_columns(columns, table.drive, path)
    _refuse_unknown_noise(table, columns, folder)
    channels = {name: values for name, values in columns.items() if name not in (*COVARIATES, "time_s")}
    driven = np.isfinite(channels[table.drive])
    valid = {name: np.isfinite(values) & driven for name, values in channels.items()}
    channels[table.drive] = _bridged(columns["time_s"], channels[table.drive])
    if touches:
        refuse_untouched(table.drive, columns["time_s"], channels[table.drive], path)
    return Run(
        label=table.name,
        file=table.file,
        time_s=columns["time_s"],
        drive=table.drive,
        channels=channels,
        valid=valid,
        saturated={name: _limited(name, values, readout) for name, values in channels.items()},
        covariates={name: columns[name] for name in COVARIATES if name in columns},
        dot_offset_mm=table.dot_offset_mm,
        temperature_C=table.temperature_C,
        readout=readout,
        nuisance=table.nuisance,
        noise=table.noise,
    )


def _limited(name: str, values: Floats, readout: Readout | None) -> Bools:
    """Saturated samples of an amplifier; a motion or a force may well stand still at its largest."""
    if not name.startswith("voltage"):
        return np.zeros(len(values), dtype=bool)
    return saturated(values, readout.limit_V if readout is not None else None)


def _bridged(time_s: Floats, drive: Floats) -> Floats:
    """The drive (t,) with straight lines across missing samples."""
    there = np.isfinite(drive)
    return np.interp(time_s, time_s[there], drive[there])


def _refuse_unknown_noise(table: RunTable, columns: Mapping[str, Floats], folder: Path) -> None:
    for name in table.noise:
        if name not in columns:
            raise InputError(
                f"recording '{folder / 'rig.toml'}': noise.{name} of the run '{table.name}' names no column of "
                f"'{table.file}'"
            )

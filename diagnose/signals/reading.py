"""The runs of a recording, read from their files and averaged where there are more samples than a diagnosis needs.

To average is a linear filter, and it commutes with what is linear and constant in time: the answer to an averaged drive
is the averaged answer, as far as force and charge are straight over a block of 4 ms.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import ceil
from pathlib import Path

import numpy as np

from diagnose.noise.quantisation import quantisation_step
from diagnose.signals.columns import read_columns, refuse_by_size
from diagnose.signals.drive_checks import drive_suspicions, refuse_unlike_drive
from diagnose.signals.phases import Segmentation
from diagnose.signals.recording import Recording, Run, RunTable, Specimen, with_earlier_drives
from diagnose.signals.run_checks import (
    LARGEST_COUPON_STRAIN,
    refuse_bad_columns,
    refuse_bad_time,
    refuse_untouched,
    run_suspicions,
)
from diagnose.signals.saturation import saturation_mask
from foundation.arrays import Bools, Floats, Ints
from foundation.errors import InputError
from solve.model import Readout

COVARIATES = ("dot_x_mm", "dot_y_mm", "temperature_C")


def read_recording(
    folder: Path,
    runs: Sequence[RunTable],
    readouts: Sequence[Readout | None],
    specimen: Specimen | None,
    height_mm: float = np.inf,
) -> Recording:
    """Recording of all runs in a folder. Every size is checked before any file is read.

    height_mm : of the segment, beyond which no dot goes in. InputError names file, row and column.
    """
    refuse_by_size(folder / run.file for run in runs)
    pairs = []
    for table, label, readout in zip(runs, distinct_labels([run.name for run in runs]), readouts, strict=True):
        run, path = replace(read_run(folder, table, readout), label=label), folder / table.file
        refuse_unlike_drive(run, path, specimen, height_mm)
        if specimen is None:  # a coupon is held from the start
            refuse_untouched(run.drive, run.time_s, run.drive_values, path)
        pairs.append((run, path))
    travel_mm = np.inf if specimen is None else LARGEST_COUPON_STRAIN * specimen.gauge_mm
    warnings = [sentence for run, path in pairs for sentence in run_suspicions(run, path, travel_mm)]
    warnings += _copies(pairs)
    if specimen is None:
        warnings += [sentence for run, path in pairs for sentence in drive_suspicions(run, path)]
    new = [specimen is not None or number == 0 for number in range(len(runs))]
    told = [table.virgin if table.virgin is not None else usual for table, usual in zip(runs, new, strict=True)]
    ordered = with_earlier_drives(replace(run, virgin=virgin) for (run, _), virgin in zip(pairs, told, strict=True))
    return Recording(tuple(ordered), specimen, tuple(warnings))


def _copies(pairs: Sequence[tuple[Run, Path]]) -> list[str]:
    """A sentence for each run whose samples are those of one before it."""
    found: dict[bytes, Path] = {}
    said = []
    for run, path in pairs:
        samples = b"".join(run.channels[name].tobytes() for name in sorted(run.channels))
        if samples in found:
            said.append(f"recording '{path}': has the samples of '{found[samples]}'; a copy is no repeat")
        found.setdefault(samples, path)
    return said


def distinct_labels(labels: Sequence[str]) -> list[str]:
    """Labels that differ from each other: repeats of a press may have the same one, and are numbered.

    >>> distinct_labels(["slow", "fast", "slow"])
    ['slow', 'fast', 'slow (2)']
    """
    found: list[str] = []
    for label in labels:
        name, number = label, 1
        while name in found or (number > 1 and name in labels):
            number += 1
            name = f"{label} ({number})"
        found.append(name)
    return found


def read_run(folder: Path, table: RunTable, readout: Readout | None) -> Run:
    """One run of a folder, by its table in rig.toml. InputError names file, row and column."""
    path = folder / table.file
    columns = read_columns(path)
    refuse_bad_time(columns["time_s"], path)
    refuse_bad_columns(columns, table.drive, path)
    _refuse_unknown_noise(table, columns, folder)
    channels = {name: values for name, values in columns.items() if name not in (*COVARIATES, "time_s")}
    driven = np.isfinite(channels[table.drive])
    valid = {name: np.isfinite(values) & driven for name, values in channels.items()}
    channels[table.drive] = _bridge_gaps(columns["time_s"], channels[table.drive])
    return Run(
        label=table.name,
        file=table.file,
        time_s=columns["time_s"],
        drive=table.drive,
        channels=channels,
        valid=valid,
        saturated={name: _amplifier_limit_mask(name, values, readout) for name, values in channels.items()},
        covariates={name: columns[name] for name in COVARIATES if name in columns},
        dot_offset_mm=table.dot_offset_mm,
        temperature_C=table.temperature_C,
        readout=readout,
        nuisance=table.nuisance,
        noise=table.noise,
    )


def _amplifier_limit_mask(name: str, values: Floats, readout: Readout | None) -> Bools:
    """Flags (t,) of saturated samples of an amplifier; a motion or a force may well stand still at its largest."""
    if not name.startswith("voltage"):
        return np.zeros(len(values), dtype=bool)
    return saturation_mask(values, readout.largest_V if readout is not None else None)


def _bridge_gaps(time_s: Floats, drive: Floats) -> Floats:
    """Drive (t,) with straight lines across missing samples."""
    there = np.isfinite(drive)
    return np.interp(time_s, time_s[there], drive[there])


def _refuse_unknown_noise(table: RunTable, columns: Mapping[str, Floats], folder: Path) -> None:
    for name in table.noise:
        if name not in columns:
            raise InputError(
                f"recording '{folder / 'rig.toml'}': noise.{name} of the run '{table.name}' names no column of "
                f"'{table.file}'"
            )
        if (whole := float(np.ptp(columns[name][np.isfinite(columns[name])]))) < table.noise[name]:
            raise InputError(
                f"recording '{folder / 'rig.toml'}': noise.{name} = {table.noise[name]:g} of the run '{table.name}' is "
                f"more than its whole range, {whole:.3g}; is it in another unit?"
            )


ENOUGH_SAMPLES = 15_000
"""Number of samples of a channel over all runs that a diagnosis handles in a minute."""
LEAST_RATE_HZ = 250.0
"""Least rate after averaging: mains and their second harmonic stay visible, and so does every press by hand."""
ENOUGH_COUPON_SAMPLES, LEAST_LOADING_SAMPLES = 5_000, 50
"""Samples of a coupon, each of which is an equilibrium to solve, and the least number of them in its loadings."""


def thin_recording(recording: Recording) -> Recording:
    """Recording averaged to about ENOUGH_SAMPLES, as far as its rate allows; a warning says so.

    Of a coupon to ENOUGH_COUPON_SAMPLES.
    """
    count, enough = sum(len(run.time_s) for run in recording.runs), ENOUGH_SAMPLES
    most = [int(1.0 / (run.step_s * LEAST_RATE_HZ) + 1e-6) for run in recording.runs]
    if recording.specimen is not None:
        enough = ENOUGH_COUPON_SAMPLES
        most = [_shortest_loading_samples(found) // LEAST_LOADING_SAMPLES for found in recording.phases]
    asked = ceil(count / enough)
    factors = [max(1, min(asked, largest)) for largest in most]
    if max(factors) == 1:
        return recording
    runs = tuple(average_blocks(run, factor) for run, factor in zip(recording.runs, factors, strict=True))
    said = (
        f"{count:,} samples of a channel are more than needed: up to {max(factors)} in a row were averaged, and "
        f"nothing faster than {0.5 / max(run.step_s for run in runs):.3g} Hz was analysed."
    )
    return replace(recording, runs=runs, warnings=(*recording.warnings, said))


def _shortest_loading_samples(phases: Segmentation) -> int:
    """Number of samples of the shortest loading; 0 without a press."""
    return min((press.held - press.touch for press in phases.presses), default=0)


def average_blocks(run: Run, factor: int) -> Run:
    """Run of means over `factor` successive samples within even sampling, gaps left out; shorter ends are dropped.

    A block counts as missing where one of its samples is, and as saturated likewise.
    """
    if factor == 1:
        return run
    first = np.concatenate([np.arange(p.start, p.stop - factor + 1, factor) for p in run.pieces])
    blocks = first[:, None] + np.arange(factor)
    return replace(
        run,
        time_s=run.time_s[blocks].mean(axis=1),
        channels={name: _block_means(values, blocks) for name, values in run.channels.items()},
        valid={name: _all_in_block(there, blocks) for name, there in run.valid.items()},
        saturated={name: ~_all_in_block(~at, blocks) for name, at in run.saturated.items()},
        covariates={name: values[blocks].mean(axis=1) for name, values in run.covariates.items()},
        noise={name: sigma / np.sqrt(factor) for name, sigma in run.noise.items()},
    )


def _block_means(values: Floats, blocks: Ints) -> Floats:
    """Means over blocks (b, factor) of samples, on the steps of the converter where it has any: they are noise too."""
    means, step = values[blocks].mean(axis=1), quantisation_step(values)
    if step is None:
        return np.asarray(means)
    zero = values[np.isfinite(values)][0]
    return np.asarray(zero + step * np.round((means - zero) / step))


def _all_in_block(flags: Bools, blocks: Ints) -> Bools:
    return np.asarray(flags[blocks].all(axis=1))

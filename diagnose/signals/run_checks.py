"""Checks of a run: what it must be to say anything, and what is suspicious about one that is good enough."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from diagnose.signals.columns import sample_place
from diagnose.signals.phases import find_phases
from diagnose.signals.recording import Run, samples_after_gaps, sampling_rates_Hz
from foundation.arrays import Floats
from foundation.errors import InputError

FEWEST_SAMPLES = 8
LARGEST_COUPON_STRAIN = 30.0  # no specimen is stretched beyond it
MOST_LISTED_RATES = 4
CHANNEL_UNITS = ("V", "N", "mm")
UNEVEN_JUMP_SHARE = 0.05  # share of jumps above which sampling is called uneven
LEAST_SAMPLES_PER_PERIOD = 4.0  # two are the theorem's; an anti-aliasing filter and a fit need more


def refuse_bad_time(time_s: Floats, file: Path) -> None:
    """Refuse too few samples, a missing time, or one that does not increase. InputError."""
    if len(time_s) < FEWEST_SAMPLES:
        samples = "1 sample" if len(time_s) == 1 else f"{len(time_s)} samples"
        raise InputError(f"recording '{file}': has {samples}, at least {FEWEST_SAMPLES} are needed")
    missing = np.flatnonzero(np.isnan(time_s))
    if len(missing):
        raise InputError(f"{sample_place(file, missing[0], 'time_s')} = nan: every sample needs its time")
    late = np.flatnonzero(np.diff(time_s) <= 0.0) + 1
    if len(late):
        n = int(late[0])
        raise InputError(
            f"{sample_place(file, n, 'time_s')} = {time_s[n]:g}: follows {time_s[n - 1]:g}, time must increase"
        )


def refuse_bad_columns(columns: Mapping[str, Floats], drive: str, file: Path) -> None:
    """Refuse a missing drive, nothing to explain, double or dead channels. InputError."""
    if drive not in columns:
        raise InputError(f"recording '{file}': column {drive} is missing, which drive names in rig.toml")
    channels = [name for name in columns if name.rpartition("_")[2] in CHANNEL_UNITS and not name.startswith("dot_")]
    if channels == [drive]:
        raise InputError(f"recording '{file}': only {drive} was recorded; a column of voltage or force is needed too")
    if "voltage_V" in columns and len([name for name in channels if name.startswith("voltage")]) > 1:
        raise InputError(f"recording '{file}': has both voltage_V and voltage_1_V; number all of them or none")
    for name in [drive, *(name for name in channels if name != drive)]:
        _refuse_dead(name, columns[name], file, drive)


def refuse_untouched(drive: str, time_s: Floats, values: Floats, file: Path) -> None:
    """Refuse a run whose drive never touches, or never leaves its own noise. InputError."""
    if not find_phases(time_s, values, drive == "displacement_mm").presses:
        raise InputError(
            f"recording '{file}', column {drive}: never rises out of its noise above {values.max():.3g}, "
            "this run never touches"
        )


def refuse_slow_sampling(run: Run, frequency_Hz: float, mechanism: str) -> None:
    """Refuse a run that is sampled too slowly for a mechanism that acts up to a frequency. InputError."""
    rate = 1.0 / run.step_s
    needed = LEAST_SAMPLES_PER_PERIOD * frequency_Hz
    if rate < needed:
        raise InputError(
            f"recording '{run.file}', column time_s: {rate:.3g} samples per second are too slow for {mechanism}, which "
            f"acts up to {frequency_Hz:.3g} Hz and needs {needed:.3g}"
        )


def run_suspicions(run: Run, path: Path, travel_mm: float = np.inf) -> list[str]:
    """Sentences on gaps, changes of rate, missing and saturated samples of a run.

    travel_mm : beyond which the displacement of a coupon is hardly one in millimetres. For voltages and forces the
    model of the rig says what is plausible: see other_units.
    """
    said = []
    jumps, rates = samples_after_gaps(run.time_s), sampling_rates_Hz(run.time_s)
    if len(jumps) > UNEVEN_JUMP_SHARE * len(run.time_s):
        return [
            f"recording '{path}', column time_s: sampling is uneven",
            *_suspicions_of_channels(run, path, travel_mm),
        ]
    if jumps:
        said.append(f"{sample_place(path, jumps[0], 'time_s')}: time jumps (jumps in all: {len(jumps)})")
    if len(rates) > 1:
        shown = ", ".join(f"{rate:.4g}" for rate in rates[:MOST_LISTED_RATES]) + (
            ", ..." if len(rates) > MOST_LISTED_RATES else ""
        )
        said.append(f"recording '{path}': the sampling rate changes ({shown} Hz)")
    return said + _suspicions_of_channels(run, path, travel_mm)


def _suspicions_of_channels(run: Run, path: Path, travel_mm: float) -> list[str]:
    return [
        sentence
        for name, values in run.channels.items()
        for sentence in _suspicions_of_channel(
            run, name, values, path, travel_mm if name == "displacement_mm" else np.inf
        )
    ]


def _suspicions_of_channel(run: Run, name: str, values: Floats, path: Path, largest: float) -> list[str]:
    """Sentences on missing and saturated samples of a channel, and on values beyond the largest that is plausible."""
    missing, limited = int((~run.valid[name]).sum()), int(run.saturated[name].sum())
    peak = float(np.nanmax(np.abs(values)))
    said = []
    if missing:
        first = int(np.argmin(run.valid[name]))
        said.append(f"{sample_place(path, first, name)}: not measured; {missing} of {len(values)} samples are missing")
    if limited:
        first = int(np.argmax(run.saturated[name]))
        where = f"{sample_place(path, first, name)} = {values[first]:g}"
        said.append(f"{where}: at the limit of the amplifier; {limited} such samples are not used")
    if peak > largest:
        row = int(np.nanargmax(np.abs(values)))
        where = f"{sample_place(path, row, name)} = {values[row]:g}"
        said.append(
            f"{where}: more than {LARGEST_COUPON_STRAIN:g} times the length of the specimen; are these micrometres?"
        )
    return said


def _refuse_dead(name: str, values: Floats, file: Path, drive: str) -> None:
    """Refuse a channel without a sample, one that never changes, and a drive that is missing too often. InputError."""
    there = np.isfinite(values)
    if not there.any():
        raise InputError(f"recording '{file}', column {name}: every sample is missing")
    if np.ptp(values[there]) == 0.0:
        why = "nothing was pressed" if name == drive else "nothing was connected"
        raise InputError(f"recording '{file}', column {name}: is {values[there][0]:g} in every row, {why}")
    if name == drive and there.mean() < 0.5:
        raise InputError(
            f"{sample_place(file, int(np.argmin(there)), name)} = nan: the drive is missing in {(~there).sum()} of "
            f"{len(values)} rows, at most half can be bridged"
        )

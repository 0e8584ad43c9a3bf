"""A recording of an array's voltages: a CSV file with the columns time_s, voltage_1_V, voltage_2_V and so on."""

from io import StringIO
from pathlib import Path

import numpy as np

from foundation.errors import InputError
from foundation.files import read_text
from softdot.reading.voltages import Voltages

LEAST_SAMPLES, MOST_UNEVEN_SHARE = 50, 0.2
"""Least number of samples, and how far one may be off its even place as a share of the step."""


def read_voltages(path: Path, segments: int) -> Voltages:
    """Read the voltages of a file; time begins as in the file. InputError for missing channels and damaged numbers."""
    import pandas as pd

    where = f"recording '{path}'"
    try:
        table = pd.read_csv(StringIO(read_text(path, "recording")), comment="#", skipinitialspace=True)
        columns = [str(name).strip() for name in table.columns]
        table.columns = columns
        channels = [name for name in columns if name.startswith("voltage_")]  # voltage_1_V.1 is one that is there twice
        wanted = [f"voltage_{number}_V" for number in range(1, segments + 1)]
        if "time_s" not in columns:
            raise InputError(f"{where}: the column time_s is missing")
        lacking = [name for name in wanted if name not in columns]
        if lacking:
            raise InputError(
                f"{where}: has {len(channels)} channels, the kernel has {segments} segments; {lacking[0]} is missing"
            )
        if len(channels) > segments:
            raise InputError(f"{where}: has {len(channels)} channels, the kernel has {segments} segments")
        numbers = table[["time_s", *wanted]].to_numpy(dtype=np.float64)
    except (ValueError, pd.errors.ParserError) as error:
        raise InputError(f"{where}: cannot be read ({error})") from None
    if len(numbers) < LEAST_SAMPLES:
        raise InputError(f"{where}: has {len(numbers)} samples, at least {LEAST_SAMPLES} are needed")
    if not np.isfinite(numbers).all():
        row, column = np.argwhere(~np.isfinite(numbers))[0]
        raise InputError(f"{where}: {['time_s', *wanted][column]} is not finite in line {row + 2}")
    return _evenly_sampled(numbers[:, 0], numbers[:, 1:], where)


def _evenly_sampled(time: np.ndarray, voltage: np.ndarray, where: str) -> Voltages:
    """The voltages with evenly spaced times. InputError where the samples are far from them."""
    step = (time[-1] - time[0]) / (len(time) - 1)
    even = time[0] + step * np.arange(len(time))
    if step <= 0.0 or (np.diff(time) <= 0.0).any():
        raise InputError(f"{where}: time_s must rise from line to line")
    worst = int(np.argmax(np.abs(time - even)))
    if abs(time[worst] - even[worst]) > MOST_UNEVEN_SHARE * step:
        raise InputError(
            f"{where}: time_s = {time[worst]:g} in line {worst + 2}: samples must be evenly spaced, {step:.4g} s apart"
        )
    return Voltages(even, voltage)

"""Logs of several instruments, each with its own clock and rate, joined into the columns of one run.

Times are those of the log that holds the voltages, else of the finest; the others are interpolated by monotone cubics
(Fritsch and Carlson, SIAM J. Numer. Anal. 17 (1980) 238), which do not overshoot. What that costs the drive is asked of
the drive itself: every second sample is left out, and found again from the rest.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy.interpolate import PchipInterpolator

from diagnose.signals.align import Lag, lag_between
from foundation.arrays import Bools, Floats
from foundation.errors import InputError
from foundation.nearest_name import nearest_name_hint
from softdot.convert.instruments import InstrumentLog, LogChannel

COLUMN_OF_UNIT = {"V": "voltage_V", "N": "force_N", "mm": "displacement_mm", "C": "temperature_C"}
"""Unit of a channel -> the column that it becomes where there is no other of the unit."""
COARSE_STEP_RATIO = 1.5
"""Steps of the drive, in steps of the recording, above which its interpolation is judged."""
FEWEST_SAMPLES = 8
"""Least number of samples of a log, and of the time that all logs share."""
GAP = 4.0
"""Steps without a sample above which what is between is missing."""
LEAST_CORRELATION = 0.8
"""Least correlation of two channels that record the same quantity, once they are aligned."""


@dataclass(frozen=True)
class NamedLog:
    """A log and the file that it is from."""

    file: Path
    log: InstrumentLog

    @property
    def step_s(self) -> float:
        """Median step of the times, s."""
        return float(np.median(np.diff(self.log.time_s)))

    def shift(self, by_s: float) -> "NamedLog":
        """The log with by_s seconds added to its times."""
        return replace(self, log=replace(self.log, time_s=self.log.time_s + by_s))


@dataclass(frozen=True)
class JoinedRun:
    """The logs of one run on one clock: columns by name, samples (t,), time_s first; remarks, warnings in sentences."""

    columns: Mapping[str, Floats]
    remarks: Sequence[str]
    warnings: Sequence[str]


def join_logs(logs: Sequence[NamedLog], named: Mapping[str, str], offsets_s: Sequence[float], align: bool) -> JoinedRun:
    """Join logs into the columns of one run. InputError.

    named : channel -> column, empty where units tell. offsets_s : added to the times of each log behind the first,
    empty where one trigger started all. align : find the offsets by a channel of force or displacement that each log
    shares with the first.
    """
    for one in logs:
        if len(one.log.time_s) < FEWEST_SAMPLES:
            raise InputError(f"'{one.file}': has {len(one.log.time_s)} samples, at least {FEWEST_SAMPLES} are needed")
    places, shared = _columns(logs, named, align)
    logs, remarks, warnings = _on_one_clock(logs, offsets_s, align, shared)
    main = min(range(len(logs)), key=lambda n: (not _has_voltage(n, places), logs[n].step_s))
    start = max(float(one.log.time_s[0]) for one in logs)
    end = min(float(one.log.time_s[-1]) for one in logs)
    time = logs[main].log.time_s
    time = time[(time >= start) & (time <= end)]
    if len(time) < FEWEST_SAMPLES:
        names = ", ".join(f"'{one.file}'" for one in logs)
        raise InputError(
            f"{names}: share {max(end - start, 0.0):.3g} s, less than {FEWEST_SAMPLES} "
            "samples; state by --offset how much later each clock began"
        )
    columns = {"time_s": time}
    for column, (number, name) in places.items():
        one = logs[number]
        values = one.log.channels[name].values
        if np.isfinite(values).sum() < FEWEST_SAMPLES:
            raise InputError(f"'{one.file}': '{name}' was measured in less than {FEWEST_SAMPLES} samples")
        columns[column] = (
            _interpolate(time, one.log.time_s, values) if number != main else values[np.isin(one.log.time_s, time)]
        )
        if number != main and (far := _is_far(time, one.log.time_s[np.isfinite(values)], GAP * one.step_s)).any():
            columns[column][far] = np.nan
            warnings.append(
                f"{column}: '{name}' of '{one.file.name}' has gaps, so {100.0 * far.mean():.2g} % of its samples are "
                "missing"
            )
        remarks.append(f"{column} is '{name}' of '{one.file.name}', a sample every {one.step_s:.3g} s")
        if column != "temperature_C" and one.step_s > COARSE_STEP_RATIO * logs[main].step_s:
            warnings.append(_coarse_drive_warning(column, one, values, logs[main].step_s, time))
    return JoinedRun(columns, remarks, warnings)


def _columns(
    logs: Sequence[NamedLog], named: Mapping[str, str], align: bool
) -> tuple[dict[str, tuple[int, str]], dict[int, str]]:
    """Column -> log and channel; and, to align, log -> its channel of the first log's quantity. InputError."""
    every = [(n, name, channel) for n, one in enumerate(logs) for name, channel in one.log.channels.items()]
    shared = {n: _shared_channel(logs[0], one) for n, one in enumerate(logs) if n > 0} if align else {}
    if named:
        return {column: _channel_place(every, channel, column) for channel, column in named.items()}, shared
    twice = set(shared.items())
    left = [(n, name, channel) for n, name, channel in every if (n, name) not in twice]
    found: dict[str, tuple[int, str]] = {}
    for unit, column in COLUMN_OF_UNIT.items():
        mine = [(n, name) for n, name, channel in left if channel.unit == unit]
        if unit == "V" and len(mine) > 1:
            found |= {f"voltage_{number}_V": one for number, one in enumerate(mine, 1)}
        elif len(mine) > 1:
            names = ", ".join(f"'{name}' of '{logs[n].file.name}'" for n, name in mine)
            raise InputError(
                f"--column: {names} could all be {column}; say which, such as --column '{mine[0][1]}={column}'"
            )
        elif mine:
            found[column] = mine[0]
    return found, shared


def _channel_place(every: Sequence[tuple[int, str, LogChannel]], channel: str, column: str) -> tuple[int, str]:
    """Log and name of a channel. InputError for none or several of the name, or another unit than the column's."""
    mine = [(n, name, one) for n, name, one in every if name == channel]
    if len(mine) != 1:
        known = nearest_name_hint(channel, [name for _, name, _ in every])
        told = f"{len(mine)} logs have one" if mine else f"there is none; {known}"
        raise InputError(f"--column '{channel}={column}': {told}")
    number, name, one = mine[0]
    unit = column.rpartition("_")[2]
    if one.unit != unit:
        raise InputError(f"--column '{channel}={column}': is in {one.unit}, which is no {unit}")
    return number, name


def _shared_channel(first: NamedLog, other: NamedLog) -> str:
    """The channel of another log that measures the same as one of the first: force, else displacement. InputError."""
    for unit in ("N", "mm"):
        if _of_unit(first, unit) is not None and (name := _of_unit(other, unit)) is not None:
            return name
    raise InputError(
        f"--align: '{first.file}' and '{other.file}' do not both hold one channel of force or displacement; state how "
        "much later the clock began by --offset"
    )


def _of_unit(one: NamedLog, unit: str) -> str | None:
    """The name of the only channel of a unit, None where there is none or several."""
    names = [name for name, channel in one.log.channels.items() if channel.unit == unit]
    return names[0] if len(names) == 1 else None


def _has_voltage(number: int, places: Mapping[str, tuple[int, str]]) -> bool:
    return any(column.startswith("voltage") and place[0] == number for column, place in places.items())


def _on_one_clock(
    logs: Sequence[NamedLog], offsets_s: Sequence[float], align: bool, shared: Mapping[int, str]
) -> tuple[list[NamedLog], list[str], list[str]]:
    """The logs with the times of the first one's clock, and a sentence for each on how that is known. InputError."""
    first, *others = logs
    if align and offsets_s:
        raise InputError("--offset: is found by --align; give one of them")
    if offsets_s and len(offsets_s) != len(others):
        raise InputError(
            f"--offset: {len(offsets_s)} are given; needs one for each log behind the first, {len(others)}"
        )
    if offsets_s:
        moved = [one.shift(by) for one, by in zip(others, offsets_s, strict=True)]
        told = [f"'{one.file.name}' begins at {one.log.time_s[0]:.6g} s, as stated" for one in moved]
        return [first, *moved], told, []
    if not align:
        return list(logs), ["all clocks are taken as started by one trigger"] if others else [], []
    moved, said, warnings = [], [], []
    for number, one in enumerate(others, 1):
        by, found, drift = _clock_shift(first, one, shared[number])
        moved.append(one.shift(by))
        said.append(found)
        warnings += drift
    return [first, *moved], said, warnings


def _clock_shift(first: NamedLog, other: NamedLog, channel: str) -> tuple[float, str, list[str]]:
    """Seconds to add to the times of another log, by the channel that both share, and a sentence. InputError."""
    unit = other.log.channels[channel].unit
    own = _of_unit(first, unit)
    assert own is not None
    step = max(first.step_s, other.step_s)
    even = []
    for one, name in ((first, own), (other, channel)):
        count = int((one.log.time_s[-1] - one.log.time_s[0]) / step) + 1
        at = one.log.time_s[0] + step * np.arange(count)
        even.append(_interpolate(at, one.log.time_s, one.log.channels[name].values))
    try:
        found = lag_between(even[0], even[1], step)
    except (ValueError, np.linalg.LinAlgError):
        raise InputError(f"--align: '{own}' or '{channel}' never changes; state --offset") from None
    if not found.correlation > LEAST_CORRELATION:
        raise InputError(
            f"--align: '{own}' and '{channel}' do not run alike (correlation {found.correlation:.2f}); state --offset"
        )
    by = float(first.log.time_s[0] - other.log.time_s[0]) - found.lag_s
    told = (
        f"'{other.file.name}' is moved by {by:.6g} s, standard error {found.sigma_s:.2g} s, by '{channel}' and '{own}'"
    )
    return by, told, _drift(even, found, step, f"'{other.file.name}': ")


def _drift(even: Sequence[Floats], found: Lag, step_s: float, where: str) -> list[str]:
    """A warning where the second half of two signals (t,), once aligned, asks for another lag than the first."""
    late = round(found.lag_s / step_s)
    first, other = even[0][max(-late, 0) :], even[1][max(late, 0) :]
    count = min(len(first), len(other))
    try:
        halves = [lag_between(first[at], other[at], step_s) for at in (slice(0, count // 2), slice(count // 2, count))]
    except (ValueError, np.linalg.LinAlgError):
        return []
    apart = halves[1].lag_s - halves[0].lag_s
    sure = max(5.0 * np.hypot(halves[0].sigma_s, halves[1].sigma_s), step_s)
    if abs(apart) < sure or not all(half.correlation > LEAST_CORRELATION for half in halves):
        return []
    return [
        f"{where}its lag changes by {apart:.3g} s from the first half to the second, so one clock runs faster by about "
        f"{abs(apart) / (0.5 * count * step_s):.2g}; log both by one clock, or state clock_ratio under [runs.nuisance]"
    ]


def _interpolate(time_s: Floats, given_s: Floats, values: Floats) -> Floats:
    """Values at other times by monotone cubics; missing samples are bridged. InputError for fewer than two samples."""
    there = np.isfinite(values)
    if there.sum() < FEWEST_SAMPLES:
        raise InputError(f"a channel was measured in less than {FEWEST_SAMPLES} samples")
    curve = PchipInterpolator(given_s[there], values[there], extrapolate=False)
    return np.asarray(curve(np.clip(time_s, given_s[there][0], given_s[there][-1])))


def _is_far(time_s: Floats, measured_s: Floats, widest_s: float) -> Bools:
    """Which times (t,) lie before or behind the samples (m,) by more than a gap, or between two so far apart."""
    after = np.searchsorted(measured_s, time_s)
    known = np.concatenate(([-np.inf], measured_s, [np.inf]))
    wide = known[after + 1] - known[after] > widest_s
    inside = (time_s > measured_s[0]) & (time_s < measured_s[-1])
    beside = np.minimum(np.abs(time_s - measured_s[0]), np.abs(time_s - measured_s[-1]))
    return np.asarray(np.where(inside, wide & (known[after + 1] != time_s), beside > widest_s))


def _coarse_drive_warning(column: str, one: NamedLog, values: Floats, step_s: float, time_s: Floats) -> str:
    """A warning of the error of a drive with few samples, estimated from the same drive with half of them.

    The error of such a curve falls at least with the square of the step, that of its rate with the step; so the error
    at twice the step is four times, and twice, that of the whole drive. Its noise is counted in.
    """
    there = np.isfinite(values)
    given, known = one.log.time_s[there], values[there]
    coarse, whole = PchipInterpolator(given[::2], known[::2]), PchipInterpolator(given, known)
    inside = time_s[(time_s >= given[0]) & (time_s <= given[::2][-1])]
    depth = _rms(coarse(inside) - whole(inside)) / max(float(np.ptp(known)), 1e-300) / 4.0
    rate = _rms(coarse(inside, 1) - whole(inside, 1)) / max(_rms(whole(inside, 1)), 1e-300) / 2.0
    return (
        f"{column} has a sample every {one.step_s:.3g} s, {one.step_s / step_s:.3g} times as far apart as those of the "
        f"recording: between them it is off by about {100.0 * depth:.2g} % of its range and {100.0 * rate:.2g} % of "
        f"its rate{'' if column.startswith('voltage') else ', which the voltage follows'}; a diagnosis may take that "
        "for missing physics. Log it faster, or press more slowly"
    )


def _rms(values: Floats) -> float:
    return float(np.sqrt(np.mean(values**2))) if len(values) else 0.0

"""When what is pressed how far: the waveform as a fraction of depth or force, and load steps as targets in time."""

import csv
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from pathlib import Path

import numpy as np

from geometry.arrays import Bools, Floats
from geometry.base import InputError
from geometry.files import read_text, regular_file
from solve.model import Press, Waveform
from solve.system import Load

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
    """The columns time_s, fraction of a file, or what was given in its place, (n, 2)."""
    if waveform.samples is not None:
        return waveform.samples
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


@dataclass(frozen=True)
class Target:
    """A load to reach at a time (s). kink : whether the rate of loading may jump there.

    drive_at : the drive at the times before, since the target before; None where it is linear.
    """

    time: float
    load: Load
    kink: bool
    drive_at: Callable[[float], float] | None = None


def schedule(press: Press, full: float, unit_length: float, follows_time: bool) -> list[Target]:
    """Targets in solver units, the first one at rest; full : depth or force at the end of the press.

    follows_time : along the waveform to its end, else once up to full in equal steps, in the time of its rise; then
    along the legs of the slide at that load, each in the time of the rise. In a trapezoid the slide takes its hold.
    """
    waveform = press.waveform or Waveform()
    if press.slides_in_hold:
        return _press_slide_lift(press, waveform, full, unit_length)
    if follows_time:
        times, kinks = _sampled(waveform, 1 if waveform.shape == "file" else press.load_steps)
        share = fraction(waveform, times)
        share[share < 1e-12] = 0.0  # released, not all but

        def drive_at(time: float) -> float:
            return full * float(fraction(waveform, np.array([time]))[0])

        targets = [
            Target(float(t), Load((0.0, 0.0), full * float(f)), bool(k), drive_at)
            for t, f, k in zip(times, share, kinks, strict=True)
        ]
        if targets[0].load.drive > 0.0:  # a file that starts pressed: get there from rest in the time of the rise
            targets.insert(0, Target(targets[0].time - waveform.rise_s, Load((0.0, 0.0), 0.0), True))
    else:
        share = np.linspace(0.0, 1.0, press.load_steps + 1)
        targets = [Target(waveform.rise_s * f, Load((0.0, 0.0), full * f), f in (0.0, 1.0)) for f in share]
    return targets + _slide(press, targets[-1], waveform.rise_s, unit_length)


def _press_slide_lift(press: Press, waveform: Waveform, full: float, unit_length: float) -> list[Target]:
    """Down in the rise, along the path in the hold, up in the fall."""
    share = np.linspace(0.0, 1.0, press.load_steps + 1)
    down = [Target(waveform.rise_s * f, Load((0.0, 0.0), full * f), f in (0.0, 1.0)) for f in share]
    along = _slide(press, down[-1], waveform.hold_s / len(press.path_xy_mm), unit_length)
    end = along[-1]
    up = [Target(end.time + waveform.fall_s * f, Load(end.load.lateral, full * (1.0 - f)), f == 1.0) for f in share[1:]]
    return down + along + up


def _sampled(waveform: Waveform, steps: int) -> tuple[Floats, Bools]:
    """Times between the corners of a waveform, steps to each piece, and which are corners."""
    corners = corners_s(waveform)
    pieces = [np.linspace(a, b, steps + 1)[1:] for a, b in pairwise(corners)]
    times = np.concatenate([corners[:1], *pieces])
    return times, np.isin(times, corners)


def _slide(press: Press, start: Target, leg_s: float, unit_length: float) -> list[Target]:
    targets, here, time = [], np.zeros(2), start.time
    share = np.linspace(0.0, 1.0, press.load_steps + 1)[1:]
    for point in press.path_xy_mm:
        there = np.array(point) * (1e-3 / unit_length)
        for f in share:
            x, y = here + f * (there - here)
            targets.append(Target(time + f * leg_s, Load((float(x), float(y)), start.load.drive), f == 1.0))
        here, time = there, time + leg_s
    return targets


def load_between(start: Target, target: Target, share: float) -> tuple[Load, float]:
    """Load and time a share of the way from start to target."""
    time = start.time + share * (target.time - start.time)
    if share == 1.0:
        return target.load, target.time
    a, b = start.load, target.load
    x, y = (1.0 - share) * np.array(a.lateral) + share * np.array(b.lateral)
    drive = a.drive + share * (b.drive - a.drive) if target.drive_at is None else target.drive_at(time)
    return Load((float(x), float(y)), drive), time

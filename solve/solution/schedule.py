"""When what is pressed how far: the waveform as a fraction of depth or force, and load steps as targets in time."""

import csv
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from pathlib import Path

import numpy as np

from foundation.arrays import Bools, Floats
from foundation.errors import InputError
from foundation.files import read_text, regular_file_size
from solve.model import Press
from solve.solution.thinning import samples_to_keep
from solve.system import Load
from solve.waveform import Waveform

LARGEST_CELL = 1e12
BISECTIONS = 60
SMALLEST_DIVISOR = 1e-300
PROGRESS_ROUND_OFF = 1e-9


def duration_s(waveform: Waveform) -> float:
    """Time at which the waveform has ended."""
    if waveform.shape == "file":
        return float(_waveform_table(waveform)[-1, 0])
    if waveform.shape == "half-sine":
        return 2.0 * waveform.rise_s
    fall = waveform.fall_s if waveform.shape == "trapezoid" else 0.0
    return waveform.rise_s + (waveform.hold_s if waveform.shape in ("ramp", "trapezoid") else 0.0) + fall


def corners_s(waveform: Waveform) -> Floats:
    """Times (n,) from the first to the last at which the rate may jump; of a file all its rows."""
    if waveform.shape == "file":
        return np.asarray(_waveform_table(waveform)[:, 0])
    corners = [0.0, waveform.rise_s]
    if waveform.shape in ("ramp", "trapezoid") and waveform.hold_s > 0.0:
        corners.append(waveform.rise_s + waveform.hold_s)
    if duration_s(waveform) > corners[-1]:
        corners.append(duration_s(waveform))
    return np.array(corners)


MOST_ROWS, STRAIGHT_SHARE = 200, 1e-4
"""Of a file, rows between which states are solved, and the share of the drive within which rows lie on a line."""


def stretches_s(waveform: Waveform) -> Floats:
    """Times (n,) between which the drive is smooth: all corners, of a file those that its straight lines need."""
    corners = corners_s(waveform)
    if waveform.shape != "file" or waveform.each_solved:
        return corners
    return corners[samples_to_keep(corners, fraction(waveform, corners), STRAIGHT_SHARE, MOST_ROWS)]


def largest_fraction(waveform: Waveform) -> float:
    """Largest fraction that the waveform reaches: 1, of a file perhaps less."""
    return float(fraction(waveform, corners_s(waveform)).max())


def first_time_s(waveform: Waveform, share: Floats) -> Floats:
    """Time in s at which each fraction (n,) is first reached; that of the largest fraction for what never is."""
    corners = corners_s(waveform)
    reached = np.maximum.accumulate(fraction(waveform, corners))
    share = np.minimum(share, reached[-1])
    after = np.searchsorted(reached, share)
    low, high = corners[np.maximum(after - 1, 0)], corners[after]
    for _ in range(BISECTIONS):  # between two corners every waveform rises or falls all the way
        middle = 0.5 * (low + high)
        below = fraction(waveform, middle) < share
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return np.asarray(np.where(share == reached[after], corners[after], high))


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
    table = _waveform_table(waveform)
    return np.interp(time_s, table[:, 0], table[:, 1])


def _waveform_table(waveform: Waveform) -> Floats:
    """Rows time_s, fraction (n, 2); what starts pressed is reached from rest in the time of a rise before."""
    rows = _waveform_rows(waveform)
    if rows[0, 1] == 0.0:
        if waveform.rise_s != Waveform.model_fields["rise_s"].default:
            raise InputError(
                f"press.waveform.rise_s = {waveform.rise_s:g}: acts only where the first row of the file is pressed "
                "already; here its fraction is 0"
            )
        return rows
    return np.vstack([[rows[0, 0] - waveform.rise_s, 0.0], rows])


def _waveform_rows(waveform: Waveform) -> Floats:
    """The columns time_s, fraction of a file, or what was given in its place, (n, 2)."""
    if waveform.samples is not None:
        return waveform.samples
    if waveform.file is None:
        raise InputError("press.waveform.file is missing: shape = 'file' needs a CSV file")
    file = Path(waveform.file)
    regular_file_size(file, _file_words(file))
    stat = file.stat()
    return _read_table(file, stat.st_mtime_ns, stat.st_size)


def _file_words(file: Path) -> str:
    """The file as a message names it."""
    return f"press.waveform.file = '{file}'"


@lru_cache(maxsize=8)
def _read_table(file: Path, _modified_ns: int, _size: int) -> Floats:
    """Columns time_s and fraction (n, 2) of a file; read once for each of its states, as every step asks for it."""
    where = _file_words(file)
    text = read_text(file, where)
    try:
        header, *rows = (row for row in csv.reader(text.splitlines()) if row)
        place = {name.strip(): number for number, name in enumerate(header)}
        if place.keys() != {"time_s", "fraction"} or any(len(row) != len(header) or len(row) != 2 for row in rows):
            raise KeyError("time_s")
        order = place["time_s"], place["fraction"]
        cells = [row[column].replace("_", "?") for row in rows for column in order]  # Python takes 1_0 for ten
        table = np.array([float(cell) for cell in cells]).reshape(-1, 2)
    except (KeyError, TypeError, ValueError, csv.Error):
        raise InputError(f"{where}: needs the columns time_s and fraction alone, with a number in each row") from None
    bad = np.flatnonzero(~(np.abs(table) <= LARGEST_CELL).all(axis=1))  # NaN passes no comparison
    if len(bad):
        time, share = table[bad[0]]
        raise InputError(
            f"{where} sample {bad[0] + 1} = ({time:g}, {share:g}): time_s and fraction must be finite numbers "
            f"of at most {LARGEST_CELL:g}"
        )
    if len(table) < 2 or not (np.diff(table[:, 0]) > 0).all() or table[:, 1].min() < 0 or table[:, 1].max() > 1:
        raise InputError(f"{where}: time_s must increase and fraction stay between 0 and 1, in at least two rows")
    if table[:, 1].max() == 0.0:
        raise InputError(f"{where}: fraction is 0 in every row, so nothing is pressed")
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

    follows_time : along the waveform to its end, else once up to what it reaches in equal steps, in the time of its
    rise; then along the legs of the slide at that load, each in the time of the rise. In a trapezoid the slide takes
    its hold.
    """
    waveform = press.waveform or Waveform()
    if press.slides_in_hold:
        return _press_slide_lift(press, waveform, full, unit_length)
    if follows_time:
        times, kinks = _solution_times(waveform, press.load_steps)
        share = fraction(waveform, times)
        share[share < 1e-12] = 0.0  # released, not all but

        def drive_at(time: float) -> float:
            return full * float(fraction(waveform, np.array([time]))[0])

        targets = [
            Target(float(t), Load((0.0, 0.0), full * float(f)), bool(k), drive_at)
            for t, f, k in zip(times, share, kinks, strict=True)
        ]
    else:
        share = largest_fraction(waveform) * np.linspace(0.0, 1.0, press.load_steps + 1)
        last = press.load_steps
        targets = [Target(waveform.rise_s * f, Load((0.0, 0.0), full * f), n in (0, last)) for n, f in enumerate(share)]
    return targets + _slide_targets(press, targets[-1], waveform.rise_s, unit_length)


def _press_slide_lift(press: Press, waveform: Waveform, full: float, unit_length: float) -> list[Target]:
    """Targets down in the rise, along the path in the hold, up in the fall."""
    share = np.linspace(0.0, 1.0, press.load_steps + 1)
    down = [Target(waveform.rise_s * f, Load((0.0, 0.0), full * f), f in (0.0, 1.0)) for f in share]
    along = _slide_targets(press, down[-1], waveform.hold_s / len(press.path_xy_mm), unit_length)
    end = along[-1]
    up = [Target(end.time + waveform.fall_s * f, Load(end.load.lateral, full * (1.0 - f)), f == 1.0) for f in share[1:]]
    return down + along + up


def _solution_times(waveform: Waveform, steps: int) -> tuple[Floats, Bools]:
    """Times to solve at, and which are corners: a number of steps to each piece of a waveform.

    Of a file, whose pieces are many, as many as its share of the drive or of the time asks for, at least one.
    """
    corners = stretches_s(waveform)
    counts = np.full(len(corners) - 1, steps)
    if waveform.shape == "file":
        drive = fraction(waveform, corners)
        change = np.abs(np.diff(drive)) / max(float(drive.max()), SMALLEST_DIVISOR)
        lasts = np.diff(corners) / (corners[-1] - corners[0])
        counts = np.maximum(1, np.ceil(steps * np.maximum(change, lasts) - 1e-9)).astype(int)
    pieces = [np.linspace(a, b, n + 1)[1:] for (a, b), n in zip(pairwise(corners), counts, strict=True)]
    times = np.concatenate([corners[:1], *pieces])
    return times, np.isin(times, corners)


def slide_s(press: Press) -> Floats:
    """Times (w + 1,) of the start of a slide and of its waypoints; one time only without a slide."""
    waveform = press.waveform or Waveform()
    legs = np.arange(len(press.path_xy_mm) + 1.0)
    if press.slides_in_hold:
        return waveform.rise_s + waveform.hold_s / len(press.path_xy_mm) * legs
    return duration_s(waveform) + waveform.rise_s * legs


def first_reached_s(progress: Floats, press: Press) -> Floats:
    """Times (t,) at which the waveform first reaches states (t,), whose progress is as in PressResult."""
    slides = slide_s(press)
    along = np.interp(progress, 1.0 + np.arange(len(slides)), slides)
    pressed = first_time_s(press.waveform or Waveform(), np.minimum(progress, 1.0))
    return np.where(progress <= 1.0 + PROGRESS_ROUND_OFF, pressed, along)


def _slide_targets(press: Press, start: Target, leg_s: float, unit_length: float) -> list[Target]:
    """Targets of a slide at the load of its start, leg_s for each leg."""
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

"""When what is pressed how far: the reported load steps as targets in time."""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from mesh.types import Bools, Floats
from solve.parameters import Press, Waveform
from solve.system import Load
from solve.waveform import corners_s, fraction


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

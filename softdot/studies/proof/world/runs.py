"""What is done at the bench: presses with rounded ramps, alone or twice, at several speeds, depths and resistors."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.ndimage import gaussian_filter1d

from softdot.studies.proof.world.arrays import Floats

CLEAR_MM = 0.04
ROUNDED = 2.0  # samples: one sigma


@dataclass(frozen=True)
class Run:
    """One run: count presses to depth_mm: rise_s up, hold_s, rise_s down, pause_s clear of the segment; lead_s of rest
    first.

    resistance_MOhm : input of the amplifier, None for that of the rig. added_pF : across the input. place_mm : of the
    dot along x, from where it stands by the rig. load_cell : whether one is there where the bench has none.
    """

    label: str
    depth_mm: float
    rise_s: float
    hold_s: float
    resistance_MOhm: float | None = None
    added_pF: float = 0.0
    count: int = 2
    lead_s: float = 1.0
    pause_s: float = 0.8
    place_mm: float = 0.0
    load_cell: bool = False

    @property
    def length_s(self) -> float:
        """Time from the first to the last sample."""
        return self.lead_s + self.count * (2.0 * self.rise_s + self.hold_s + self.pause_s)

    def times(self, rate_Hz: float) -> Floats:
        """Samples."""
        return np.asarray(np.arange(round(self.length_s * rate_Hz) + 1) / rate_Hz)

    def depth(self, time_s: Floats) -> Floats:
        """Path of the stage, mm below the first touch, at any times."""
        depth = np.full_like(time_s, -CLEAR_MM)
        start = self.lead_s
        for _ in range(self.count):
            up = smooth_step((time_s - start) / self.rise_s)
            down = smooth_step((time_s - start - self.rise_s - self.hold_s) / self.rise_s)
            depth += (self.depth_mm + CLEAR_MM) * (up - down)
            start += 2.0 * self.rise_s + self.hold_s + self.pause_s
        return depth

    def presses_before(self, time_s: Floats) -> Floats:
        """Number of presses made before a time."""
        each = 2.0 * self.rise_s + self.hold_s + self.pause_s
        return np.asarray(np.clip(np.floor((time_s - self.lead_s) / each), 0, self.count - 1))

    def acceleration_mm_per_s2(self, time_s: Floats) -> Floats:
        """Second derivative of the path by central differences of a tenth of a millisecond."""
        h = 1e-4
        return np.asarray((self.depth(time_s + h) - 2.0 * self.depth(time_s) + self.depth(time_s - h)) / h**2)

    def speed_mm_per_s(self, time_s: Floats) -> Floats:
        """First derivative of the path."""
        h = 1e-4
        return np.asarray((self.depth(time_s + h) - self.depth(time_s - h)) / (2.0 * h))


@dataclass(frozen=True, eq=False, kw_only=True)
class Traced(Run):
    """A path that somebody else asks for, in mm at even times (n,); the stage rounds its corners."""

    asked_s: Floats
    asked_mm: Floats

    @property
    def length_s(self) -> float:
        """Duration of the path that is asked for."""
        return float(self.asked_s[-1])

    def depth(self, time_s: Floats) -> Floats:
        """Depth (n,) at times (n,) as asked for, corners rounded; smooth between the samples, as a mass feels its
        acceleration.
        """
        return np.asarray(self._path(np.clip(time_s, self.asked_s[0], self.asked_s[-1])))

    @cached_property
    def _path(self) -> CubicSpline:
        return CubicSpline(self.asked_s, gaussian_filter1d(self.asked_mm, ROUNDED, mode="nearest"))

    def presses_before(self, time_s: Floats) -> Floats:
        """Touches before the last one."""
        touches = self.asked_s[1:][(self.asked_mm[1:] > 0.0) & (self.asked_mm[:-1] <= 0.0)]
        return np.asarray(np.maximum(np.searchsorted(touches, time_s, "right") - 1, 0), dtype=np.float64)


def traced_run(
    label: str, asked_s: Floats, asked_mm: Floats, resistance_MOhm: float | None, added_pF: float, place_mm: float,
    load_cell: bool = False,
) -> Traced:  # fmt: skip
    """Run along a path (n,) that touches at least once."""
    touch_s = float(asked_s[np.argmax(asked_mm > 0.0)])
    return Traced(
        label, float(asked_mm.max()), 0.0, 0.0, resistance_MOhm, added_pF, lead_s=touch_s, asked_s=asked_s,
        asked_mm=asked_mm, place_mm=place_mm, load_cell=load_cell,
    )  # fmt: skip


def smooth_step(share: Floats) -> Floats:
    """Rise from 0 to 1 with continuous acceleration (a quintic step)."""
    x = np.clip(share, 0.0, 1.0)
    return np.asarray(x**3 * (10.0 - 15.0 * x + 6.0 * x**2))

"""The shape of a press as a rig is told it: rest, in, hold, out, for a number of cycles; taken from a recording."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from diagnose.signals.phases import PressPhases, rest_level
from diagnose.signals.recording import Recording, Run
from foundation.arrays import Floats

REST_S = 1.0  # noise and drift show at rest


@dataclass(frozen=True)
class Shape:
    """Trapezoids between two levels of the drive, in its unit (mm or N).

    level : at rest, at most 0 for a displacement. deep : during the hold. rise_s, hold_s, fall_s : from the touch in,
    at depth, and out to the touch; the way from rest to the touch is travelled at the same speed.
    """

    level: float
    deep: float
    rise_s: float
    hold_s: float
    fall_s: float
    cycles: int = 1

    def corners(self) -> tuple[Floats, Floats]:
        """Times (c,) and drive (c,) between which the rig moves evenly; a rest of REST_S before and behind."""
        reach = -self.level / self.deep
        one = (self.rise_s * (1.0 + reach), self.hold_s, self.fall_s * (1.0 + reach))
        steps = [REST_S, *(step for _ in range(self.cycles) for step in (*one, REST_S))]
        drive = [self.level, self.level, *(d for _ in range(self.cycles) for d in self._cycle())]
        return np.cumsum([0.0, *steps]), np.array(drive)

    def _cycle(self) -> tuple[float, float, float, float]:
        return (self.deep, self.deep, self.level, self.level)

    @property
    def duration_s(self) -> float:
        """Duration in s from the first sample to the last."""
        return float(self.corners()[0][-1])

    def sample(self, step_s: float) -> tuple[Floats, Floats]:
        """Times and drive (t,) at even steps."""
        times, drive = self.corners()
        at = np.arange(0.0, times[-1] + 0.5 * step_s, step_s)
        kept = np.flatnonzero([True, *(b > a for a, b in pairwise(times))])  # without a hold two corners coincide
        return at, np.interp(at, times[kept], drive[kept])


def recorded_shape(recording: Recording, number: int) -> Shape | None:
    """Shape of the deepest press of a run; None where no press has a rise and a release."""
    run = recording.runs[number]
    pressed = [_shape(run, press) for press in recording.phases[number].presses if _complete(press, run)]
    return max(pressed, key=lambda shape: shape.deep, default=None)


def _complete(press: PressPhases, run: Run) -> bool:
    return press.touch < press.held and press.released < press.clear < len(run.time_s)


def _shape(run: Run, press: PressPhases) -> Shape:
    time, drive = run.time_s, run.drive_values
    at_depth = drive[press.held : press.released] if press.released > press.held else drive[press.held - 1 : press.held]
    level = min(rest_level(drive)[0], 0.0) if run.drive == "displacement_mm" else 0.0
    return Shape(
        level=float(level),
        deep=float(np.median(at_depth)),
        rise_s=float(time[press.held] - time[press.touch]),
        hold_s=float(time[press.released] - time[press.held]),
        fall_s=float(time[press.clear] - time[press.released]),
    )

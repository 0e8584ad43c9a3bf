"""The drive of a run as the model takes it, and where its first touch is."""

from dataclasses import dataclass

import numpy as np

from diagnose.signals.phases import Segmentation
from diagnose.signals.recording import Run
from foundation.arrays import Bools, Floats
from solve.reduced.time_stepping import BY_DEPTH, BY_FORCE


@dataclass(frozen=True)
class Drive:
    """Drive of a model. time_s (t,) : from the first touch. values (t,) : mm from the touch, or N.

    touching (t,) : flags.
    """

    time_s: Floats
    values: Floats
    kind: int
    touching: Bools

    @property
    def by_depth(self) -> bool:
        """Whether a displacement drives, and not a force."""
        return self.kind == BY_DEPTH


def model_drive(run: Run, phases: Segmentation) -> Drive:
    """Drive of a run as the model takes it; a force is at least 0, since it cannot pull."""
    first = phases.presses[0].touch if phases.presses else 0
    by_depth = run.drive == "displacement_mm"
    values = run.smoothed_drive.values if by_depth else np.maximum(run.smoothed_drive.values, 0.0)
    touching = np.zeros(len(values), dtype=np.bool_)
    for press in phases.presses:
        touching[press.touch : press.clear] = True
    time = run.time_s - run.time_s[first]
    return Drive(np.ascontiguousarray(time), np.ascontiguousarray(values), BY_DEPTH if by_depth else BY_FORCE, touching)


def ramp_drive(largest: float, drive: str) -> Drive:
    """Drive from nothing to a largest value, in mm or N by the name of the drive."""
    kind = BY_DEPTH if drive == "displacement_mm" else BY_FORCE
    return Drive(np.array([0.0, 1.0]), np.array([0.0, largest]), kind, np.array([False, True]))

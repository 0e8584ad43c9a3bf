"""The drive of a run as the model takes it, and where its first touch is."""

from dataclasses import dataclass

import numpy as np

from diagnose.phases import Segmentation
from diagnose.recording import Run
from mesh.types import Bools, Floats
from solve.reduced.kernels import BY_DEPTH, BY_FORCE


@dataclass(frozen=True)
class Drive:
    """time_s (t,) from the first touch; values (t,) mm from the touch or N, of a kind; touching (t,)."""

    time_s: Floats
    values: Floats
    kind: int
    touching: Bools

    @property
    def by_depth(self) -> bool:
        """Whether a displacement drives."""
        return self.kind == BY_DEPTH


def drive_of(run: Run, phases: Segmentation) -> Drive:
    """A force cannot pull."""
    first = phases.presses[0].touch if phases.presses else 0
    by_depth = run.drive == "displacement_mm"
    values = run.drive_values if by_depth else np.maximum(run.drive_values, 0.0)
    touching = np.zeros(len(values), dtype=np.bool_)
    for press in phases.presses:
        touching[press.touch : press.clear] = True
    time = run.time_s - run.time_s[first]
    return Drive(np.ascontiguousarray(time), np.ascontiguousarray(values), BY_DEPTH if by_depth else BY_FORCE, touching)

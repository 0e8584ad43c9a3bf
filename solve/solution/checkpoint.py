"""Where a press stands, on disk, so that a run that was killed goes on where it was."""

import time
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from solve.recorder import Recorder
from solve.result import Fields, Record, Step
from solve.solution.archive import read_archive, write_archive
from solve.system import Load, State

WRITE_EVERY_S = 15.0  # between two writings; a short press writes none
TYPES = {kind.__name__: kind for kind in (State, Load, Step, Fields, Record)}


@dataclass
class Checkpoint:
    """One file. key : a hash of all that the press depends on; a file of another key counts as none."""

    path: Path
    key: str
    written: float = 0.0

    def load(self, recorder: Recorder, unknowns: int) -> list[State]:
        """The last converged states, and the recorder filled with what was recorded; nothing when there is none."""
        self.written = time.monotonic()
        found = read_archive(self.path, TYPES)
        if not isinstance(found, list) or found[0] != self.key:
            return []
        past: list[State] = found[1]
        if any(state.x.shape != (unknowns,) for state in past):
            return []
        recorder.restore(found[2])
        return past

    def save(self, past: list[State], recorder: Recorder) -> bool:
        """Write, unless the last writing was a moment ago; returns whether it was written now.

        A disk that cannot be written is no fault of the press.
        """
        if time.monotonic() - self.written < WRITE_EVERY_S:
            return False
        try:
            write_archive(self.path, [self.key, past, recorder.memory()])
        except OSError:
            return False
        self.written = time.monotonic()
        return True

    def discard(self) -> None:
        """Remove the file, as the press has ended."""
        with suppress(OSError):  # a file that stays is found to be of no use by its key
            self.path.unlink(missing_ok=True)

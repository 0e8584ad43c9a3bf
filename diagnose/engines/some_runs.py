"""Some of the runs of a recording, and the engine of a recording for these alone."""

from collections.abc import Sequence
from dataclasses import replace

from diagnose.engines.passing_on import PassingOn
from diagnose.forward import Engine, Setting, Signals
from diagnose.signals.recording import Recording
from foundation.progress import Report
from solve.mechanisms import Mechanism


def some_runs(recording: Recording, numbers: Sequence[int]) -> Recording:
    """The recording of these runs alone."""
    return replace(recording, runs=tuple(recording.runs[number] for number in numbers))


def all_but(recording: Recording, numbers: Sequence[int]) -> list[int]:
    """Numbers of all other runs."""
    return [number for number in range(len(recording.runs)) if number not in numbers]


class SomeRuns(PassingOn):
    """The engine of a recording for some_runs of it: a run has the number that it has among them."""

    def __init__(self, engine: Engine, numbers: Sequence[int]) -> None:
        super().__init__(engine)
        self._numbers = tuple(numbers)

    def predict(self, run: int, settings: Sequence[Setting]) -> Signals:
        """As the engine."""
        return super().predict(self._numbers[run], settings)

    def solve(self, run: int, mechanisms: Sequence[Mechanism], report: Report) -> Signals:
        """As the engine."""
        return super().solve(self._numbers[run], mechanisms, report)

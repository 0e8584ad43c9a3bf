"""An engine for some of the runs of a recording."""

from collections.abc import Sequence
from dataclasses import replace

from diagnose.engines.passing_on import DelegatingEngine
from diagnose.forward import Engine, Setting, Signals
from diagnose.signals.recording import Recording
from foundation.progress import Report
from solve.mechanisms import Mechanism


def select_runs(recording: Recording, numbers: Sequence[int]) -> Recording:
    """Recording of these runs alone."""
    return replace(recording, runs=tuple(recording.runs[number] for number in numbers))


def other_runs(recording: Recording, numbers: Sequence[int]) -> list[int]:
    """Numbers of all runs of a recording but these."""
    return [number for number in range(len(recording.runs)) if number not in numbers]


class SomeRuns(DelegatingEngine):
    """Engine of a recording for some of its runs: a run has the number that it has among the selected ones."""

    def __init__(self, engine: Engine, numbers: Sequence[int]) -> None:
        super().__init__(engine)
        self._numbers = tuple(numbers)

    def predict(self, run: int, settings: Sequence[Setting]) -> Signals:
        """Every answer of a selected run, see diagnose.forward.Engine."""
        return super().predict(self._numbers[run], settings)

    def solve(self, run: int, mechanisms: Sequence[Mechanism], report: Report) -> Signals:
        """Every answer of a selected run by the full model, see diagnose.forward.Engine."""
        return super().solve(self._numbers[run], mechanisms, report)

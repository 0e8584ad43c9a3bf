"""Some runs of a recording, and the forward model of the whole recording seen through them."""

from collections.abc import Sequence
from dataclasses import replace

from diagnose.forward import Candidate, Engine, Report, Setting, Signals
from diagnose.recording import Recording, Run
from solve.mechanisms import Mechanism


def some_runs(recording: Recording, numbers: Sequence[int]) -> Recording:
    """The recording of these runs alone."""
    return replace(recording, runs=tuple(recording.runs[number] for number in numbers))


class SomeRuns:
    """Implements diagnose.forward.Engine for some_runs of the recording that an engine was made for."""

    def __init__(self, engine: Engine, numbers: Sequence[int]) -> None:
        self._engine, self._numbers = engine, tuple(numbers)
        self.name, self.accuracy = engine.name, engine.accuracy
        self.candidates, self.free_nuisances = engine.candidates, engine.free_nuisances

    @property
    def shortfalls(self) -> tuple[str, ...]:
        """Of the engine."""
        return self._engine.shortfalls

    def nuisance(self, name: str) -> Candidate | None:
        """As the engine."""
        return self._engine.nuisance(name)

    def prepare(self, candidates: Sequence[Candidate], report: Report) -> None:
        """As the engine."""
        self._engine.prepare(candidates, report)

    def predict(self, run: int, settings: Sequence[Setting]) -> Signals:
        """As the engine, by the number among these runs."""
        return self._engine.predict(self._numbers[run], settings)

    def imagine(self, run: Run, settings: Sequence[Setting]) -> Signals:
        """As the engine."""
        return self._engine.imagine(run, settings)

    def solve(self, run: int, mechanisms: Sequence[Mechanism], report: Report) -> Signals:
        """As the engine, by the number among these runs."""
        return self._engine.solve(self._numbers[run], mechanisms, report)

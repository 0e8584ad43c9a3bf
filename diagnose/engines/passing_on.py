"""An engine that passes on what another one answers."""

from collections.abc import Sequence
from copy import copy
from typing import Self

from diagnose.forward import Candidate, Engine, Setting, Signals
from diagnose.signals.recording import Run
from foundation.progress import Report
from solve.mechanisms import Mechanism


class PassingOn:
    """Implements diagnose.forward.Engine by another engine."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self.name, self.accuracy = engine.name, engine.accuracy
        self.candidates, self.free_nuisances = engine.candidates, engine.free_nuisances

    @property
    def shortfalls(self) -> tuple[str, ...]:
        """Of the engine."""
        return self._engine.shortfalls

    def nuisance(self, name: str) -> Candidate | None:
        """As the engine."""
        return self._engine.nuisance(name)

    def with_candidates(self, candidates: tuple[Candidate, ...]) -> Self:
        """As the engine, with fewer candidates."""
        fewer = copy(self)
        fewer.candidates = candidates
        return fewer

    def prepare(self, candidates: Sequence[Candidate], report: Report) -> None:
        """As the engine."""
        self._engine.prepare(candidates, report)

    def refine(self, settings: Sequence[Setting], report: Report) -> Sequence[Setting]:
        """As the engine."""
        return self._engine.refine(settings, report)

    def predict(self, run: int, settings: Sequence[Setting]) -> Signals:
        """As the engine."""
        return self._engine.predict(run, settings)

    def imagine(self, run: Run, settings: Sequence[Setting]) -> Signals:
        """As the engine."""
        return self._engine.imagine(run, settings)

    def solve(self, run: int, mechanisms: Sequence[Mechanism], report: Report) -> Signals:
        """As the engine."""
        return self._engine.solve(run, mechanisms, report)

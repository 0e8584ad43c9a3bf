"""An engine that passes all questions on to another engine."""

from collections.abc import Sequence
from copy import copy
from typing import Self

from diagnose.forward import Candidate, Engine, Setting, Signals
from diagnose.signals.recording import Run
from foundation.progress import Report
from solve.mechanisms import Mechanism


class DelegatingEngine:
    """Base of engines that change one answer of another engine; see diagnose.forward.Engine."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self.name, self.accuracy = engine.name, engine.accuracy
        self.candidates, self.free_nuisances = engine.candidates, engine.free_nuisances

    @property
    def shortfalls(self) -> tuple[str, ...]:
        """Shortfalls of the other engine."""
        return self._engine.shortfalls

    @property
    def solves_outright(self) -> bool:
        """Whether nothing that the other engine prepares or refines changes what it says."""
        return bool(getattr(self._engine, "solves_outright", False))

    def nuisance(self, name: str) -> Candidate | None:
        """Candidate of a nuisance, from the other engine."""
        return self._engine.nuisance(name)

    def with_candidates(self, candidates: tuple[Candidate, ...]) -> Self:
        """This engine with fewer candidates."""
        fewer = copy(self)
        fewer.candidates = candidates
        return fewer

    def prepare(self, candidates: Sequence[Candidate], report: Report) -> None:
        """Prepare the other engine for these candidates."""
        self._engine.prepare(candidates, report)

    def prepare_roughly(self, candidates: Sequence[Candidate], report: Report) -> None:
        """Prepare the other engine roughly for these candidates."""
        self._engine.prepare_roughly(candidates, report)

    def refine(self, settings: Sequence[Setting], report: Report) -> Sequence[Setting]:
        """Refine the other engine at these settings."""
        return self._engine.refine(settings, report)

    def predict(self, run: int, settings: Sequence[Setting]) -> Signals:
        """Every answer of a run, from the other engine."""
        return self._engine.predict(run, settings)

    def imagine(self, run: Run, settings: Sequence[Setting]) -> Signals:
        """Every answer of a run that was not made, from the other engine."""
        return self._engine.imagine(run, settings)

    def solve(self, run: int, mechanisms: Sequence[Mechanism], report: Report) -> Signals:
        """Every answer of a run by the full model of the other engine."""
        return self._engine.solve(run, mechanisms, report)

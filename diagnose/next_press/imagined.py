"""A recording that nobody has made yet, of one proposed press, and the engine that answers it."""

from collections.abc import Sequence

from diagnose.forward import Candidate, Engine, Setting, Signals
from diagnose.next_press.proposals import Proposal

FREE_PHASE = "mains-hum"


def without_phase(settings: Sequence[Setting]) -> tuple[Setting, ...]:
    """Settings without hum: its phase is that of one run, and means nothing to another model or another press."""
    return tuple(setting for setting in settings if setting.candidate.mechanism != FREE_PHASE)


class ImaginedEngine:
    """The part of an engine that fits ask for, with the proposed press as its only run."""

    def __init__(self, engine: Engine, proposal: Proposal) -> None:
        self._engine, self._proposal = engine, proposal
        self.name, self.accuracy, self.candidates = engine.name, engine.accuracy, engine.candidates
        self.free_nuisances = engine.free_nuisances

    def nuisance(self, name: str) -> Candidate | None:
        """As the engine."""
        return self._engine.nuisance(name)

    def predict(self, run: int, settings: Sequence[Setting]) -> Signals:
        """All channels of the press. ValueError where the engine cannot tell."""
        kept = [setting for setting in settings if setting.candidate.mechanism != self._proposal.removes]
        if self._proposal.number is not None:
            return self._engine.predict(self._proposal.number, kept)
        if not hasattr(self._engine, "imagine"):
            raise ValueError(f"the model '{self.name}' can predict only the presses of the recording")
        return self._engine.imagine(self._proposal.run, kept)

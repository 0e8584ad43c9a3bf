"""Positions of the dot in the runs of a recording, and the presses that are prepared for each.

A film with one electrode is pressed where rig.toml puts the dot; another place is a change of that press, as of any
candidate. Of several electrodes one collects next to nothing until the dot stands over it, and no factor makes the one
charge of the other: there each place has tables of its own, as have all candidates at it.
"""

from collections.abc import Mapping, Sequence

from diagnose.engines.segment.prepared import Prepared
from diagnose.engines.segment.presses import Place, with_dot_moved
from diagnose.forward import Candidate, Setting
from diagnose.signals.recording import Recording
from foundation.executor import HERE, Executor
from foundation.progress import Report
from solve.model import Model
from solve.tables.rig_mesh import MeshSettings

HOME_PLACE: Place = (0.0, 0.0)


class DotPositions:
    """Prepared presses for all positions of the dot in a recording.

    accuracy : see diagnose.forward.Engine, the worst of all positions.
    """

    def __init__(
        self, model: Model, options: MeshSettings, recording: Recording, report: Report, executor: Executor = HERE
    ) -> None:
        places = list(dict.fromkeys(run.dot_offset_mm for run in recording.runs))
        self._apart = len(model.segment.film.electrodes) > 1
        homes = places if self._apart else [HOME_PLACE]
        self._at: Mapping[Place, Prepared] = {
            home: Prepared(with_dot_moved(model, home), options, recording, report, executor) for home in homes
        }
        if not self._apart:
            self._at[HOME_PLACE].add((), places, report)
        each = [prepared.accuracy for prepared in self._at.values()]
        self.accuracy = {name: max(one[name] for one in each) for name in each[0]}

    def presses_at(self, place: Place) -> tuple[Prepared, Place]:
        """Prepared presses for a dot at a place, and its offset from where they press.

        ValueError where nothing was pressed.
        """
        if not self._apart:
            return self._at[HOME_PLACE], place
        if place not in self._at:
            raise ValueError(f"a dot at {place} mm was not prepared")
        return self._at[place], HOME_PLACE

    def add(self, candidates: Sequence[Candidate], report: Report) -> None:
        """Press what these candidates need, at all positions of the dot. NoEquilibriumError."""
        for prepared in self._at.values():
            prepared.add(candidates, (), report)

    def add_roughly(self, candidates: Sequence[Candidate], report: Report) -> None:
        """Press these candidates a little, at all positions of the dot. NoEquilibriumError."""
        for prepared in self._at.values():
            prepared.add_roughly(candidates, report)

    def refine(self, settings: Sequence[Setting], report: Report) -> list[Setting]:
        """Press these settings at all positions of the dot; returns those for which that changed what matters."""
        changed = [one for prepared in self._at.values() for one in prepared.refine(settings, report)]
        return [setting for setting in settings if setting in changed]

    @property
    def shortfalls(self) -> tuple[str, ...]:
        """Sentences on what could not be pressed as it should, each once."""
        return tuple(dict.fromkeys(said for one in self._at.values() for said in one.shortfalls.values()))

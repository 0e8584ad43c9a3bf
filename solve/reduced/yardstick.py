"""What a field of remembered stress does to the pressed segment: its load, and the answer to it."""

from collections.abc import Mapping

import numpy as np

from mesh.types import Floats
from solve.bond import Bond
from solve.linear import LinearSolver
from solve.reduced.modes import Basis
from solve.system import State, System
from solve.term import History, Term

ACCURATE = 1e-8


def held(term: Term, elastic: Floats, memory: Floats) -> History:
    """The history of a term with a Frozen law."""
    return (elastic, memory) if isinstance(term, Bond) else ((elastic, memory),)


class Yardstick:
    """Measures fields at one state, by the compliance of the segment in it (see solve.reduced.modes)."""

    def __init__(self, system: System, state: State, terms: Mapping[str, Term]) -> None:
        self.system, self.terms = system, terms
        self.trial = system.trial(state.x, state.load, state.time, state)
        self.linear = LinearSolver(system.factorisation_shift)
        self.tangent = system.evaluate(self.trial, state.histories).tangent
        self.bases = {name: Basis(self._answer) for name in terms}
        self._factorised = False

    def close(self) -> None:
        """Give the solver's memory back."""
        self.linear.close()

    def coordinates(self, layer: str, field: Floats) -> Floats:
        """Coordinates (b,) of a field in the layer's basis."""
        return self.bases[layer].coordinates(self._load(self.terms[layer], field))

    def _load(self, term: Term, field: Floats) -> Floats:
        """f (count,) = residual without the memory less residual with it."""
        load = np.zeros(self.system.count + 1)  # the last entry takes what belongs to prescribed unknowns
        for memory, sign in ((np.zeros_like(field), 1.0), (field, -1.0)):
            for block in term.elements(self.trial, held(term, field, memory)):
                dofs = term.groups[block.group][block.part]
                np.add.at(load, dofs, sign * block.residuals)
        return load[:-1]

    def _answer(self, load: Floats) -> Floats:
        if not load.any():
            return load
        answer = self.linear.solve(self.tangent, load, ACCURATE, similar=self._factorised)
        self._factorised = True
        return answer

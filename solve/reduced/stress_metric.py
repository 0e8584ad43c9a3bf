"""What a field of remembered stress does to the pressed segment: its load, and the answer to it."""

from collections.abc import Mapping

import numpy as np

from foundation.arrays import Floats
from solve.reduced.modes import Basis
from solve.solution.linear import LinearSolver
from solve.system import State, System
from solve.terms.base import Term

LINEAR_TOLERANCE = 1e-8


class StressMetric:
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
        """Load f (count,) of a memory: the residual without it less the residual with it."""
        load = np.zeros(self.system.count + 1)  # the last entry takes what belongs to prescribed unknowns
        for memory, sign in ((np.zeros_like(field), 1.0), (field, -1.0)):
            for block in term.elements(self.trial, ((field, memory),)):
                dofs = term.groups[block.group][block.part]
                np.add.at(load, dofs, sign * block.residuals)
        return load[:-1]

    def _answer(self, load: Floats) -> Floats:
        """Answer K^-1 f (count,) of the segment to a load."""
        if not load.any():
            return load
        answer = self.linear.solve(self.tangent, load, LINEAR_TOLERANCE, similar=self._factorised)
        self._factorised = True
        return answer

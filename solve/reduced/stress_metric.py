"""What a field of remembered stress does to the pressed segment: its load, and the answer to it."""

from collections.abc import Mapping

import numpy as np
from scipy.sparse import csr_array

from foundation.arrays import Floats
from solve.reduced.modes import Basis
from solve.solution.linear import LinearSolver
from solve.system import State, System
from solve.terms.base import Term

LINEAR_TOLERANCE = 1e-8


class StressMetric:
    """Measures fields at one state, by the compliance of the segment in it (see solve.reduced.modes)."""

    def __init__(self, system: System, state: State, terms: Mapping[str, Term]) -> None:
        self.system = system
        self.trial = system.trial(state.x, state.load, state.time, state)
        self.linear = LinearSolver(system.factorisation_shift)
        self.tangent = system.evaluate(self.trial, state.histories).tangent
        self.bases = {name: Basis(self._answer) for name in terms}
        self._load_of_stress = {name: self._probe_load(term) for name, term in terms.items()}
        self._factorised = False

    def close(self) -> None:
        """Give the solver's memory back."""
        self.linear.close()

    def coordinates(self, layer: str, field: Floats) -> Floats:
        """Coordinates (b,) of a field in the layer's basis."""
        return self.bases[layer].coordinates(self._load_of_stress[layer] @ field.ravel())

    def _probe_load(self, term: Term) -> csr_array:
        """Load f (count,) of a memory (n, c), which is linear in it: the residual without it less that with it.

        Every point of an element takes a unit of each component in turn, in all elements at once.
        """
        dofs = term.groups[0]
        ((rest, _),) = term.start()
        points, components = len(rest) // len(dofs), rest.shape[1]
        without = self._residuals(term, rest)
        numbers = np.arange(rest.size).reshape(len(dofs), points, components)
        parts = []
        for point, component in np.ndindex(points, components):
            unit = np.zeros((len(dofs), points, components))
            unit[:, point, component] = 1.0
            parts.append(without - self._residuals(term, unit.reshape(rest.shape)))
        rows = np.broadcast_to(dofs % (self.system.count + 1), (len(parts), *dofs.shape))
        columns = np.broadcast_to(numbers.reshape(len(dofs), -1).T[:, :, None], rows.shape)
        values, size = np.array(parts), (self.system.count + 1, rest.size)  # the last row: prescribed unknowns
        return csr_array((values.ravel(), (rows.ravel(), columns.ravel())), shape=size)[:-1]

    def _residuals(self, term: Term, memory: Floats) -> Floats:
        """Residuals (m, k) of a term's elements with a memory (n, c)."""
        blocks = term.elements(self.trial, ((memory, memory),))
        return np.concatenate([block.residuals for block in blocks])

    def _answer(self, load: Floats) -> Floats:
        """Answer K^-1 f (count,) of the segment to a load."""
        if not load.any():
            return load
        answer = self.linear.solve(self.tangent, load, LINEAR_TOLERANCE, similar=self._factorised)
        self._factorised = True
        return answer

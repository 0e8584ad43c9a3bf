"""Direct solution of the symmetric indefinite tangent, with a residual check after every solve.

PARDISO with mtype -2 (real symmetric indefinite) where MKL exists, else or when its answer is wrong SciPy's
SuperLU. PARDISO can return a wrong answer without an error on a weak diagonal, hence the check.
"""

from typing import Any, Protocol

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from mesh.types import Floats

RESIDUAL_LIMIT = 1e-9


class LinearSolveError(RuntimeError):
    """No solver gave a solution with a small residual: the tangent is singular."""


class Factorisation(Protocol):
    """A direct solver that keeps its analysis of one sparsity pattern."""

    name: str

    def factorise(self, upper: sp.csr_matrix) -> None:
        """Factorise the symmetric matrix whose upper triangle is given."""

    def back_substitute(self, rhs: Floats) -> Floats:
        """Solve with the last factorisation."""


class Pardiso:
    """MKL PARDISO for symmetric indefinite matrices."""

    name = "pardiso"

    def __init__(self) -> None:
        from pypardiso import PyPardisoSolver

        self._solver: Any = PyPardisoSolver(mtype=-2)
        for parameter, value in ((1, 1), (2, 3), (8, 2), (10, 8), (11, 1), (13, 1), (21, 1), (24, 1)):
            self._solver.set_iparm(parameter, value)
        self._upper: sp.csr_matrix | None = None

    def factorise(self, upper: sp.csr_matrix) -> None:
        """Analyse (scaling and matching need the values) and factorise."""
        self._upper = upper
        self._solver.set_phase(12)
        self._solver._call_pardiso(upper, np.zeros(upper.shape[0]))

    def back_substitute(self, rhs: Floats) -> Floats:
        """Solve with the last factorisation, two steps of iterative refinement inside."""
        self._solver.set_phase(33)
        solution: Floats = self._solver._call_pardiso(self._upper, rhs)
        return solution

    def __del__(self) -> None:
        solver = getattr(self, "_solver", None)
        if solver is not None:
            solver.free_memory(everything=True)


class SuperLU:
    """SciPy's SuperLU in symmetric mode."""

    name = "superlu"

    def __init__(self) -> None:
        self._factor: Any = None

    def factorise(self, upper: sp.csr_matrix) -> None:
        """Factorise the full matrix."""
        full = (upper + sp.triu(upper, 1).T).tocsc()
        options = {"SymmetricMode": True}
        self._factor = splu(full, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.01, options=options)

    def back_substitute(self, rhs: Floats) -> Floats:
        """Solve with the last factorisation."""
        solution: Floats = self._factor.solve(rhs)
        return solution


def symmetric_product(upper: sp.csr_matrix, vector: Floats) -> Floats:
    """A x of the symmetric matrix whose upper triangle is given."""
    product: Floats = upper @ vector + upper.T @ vector - upper.diagonal() * vector
    return product


class LinearSolver:
    """Solves with the first factorisation of the registry that passes the residual check."""

    def __init__(self) -> None:
        self.max_relative_residual = 0.0
        self._registry: list[type[Pardiso] | type[SuperLU]] = [Pardiso, SuperLU]
        self._current: Factorisation | None = None

    @property
    def name(self) -> str:
        """Name of the factorisation in use."""
        return self._registry[0].name

    def solve(self, upper: sp.csr_matrix, rhs: Floats) -> Floats:
        """Solve A x = rhs. LinearSolveError when every factorisation fails its residual check."""
        reasons = []
        while self._registry:
            try:
                self._current = self._current or self._registry[0]()
                self._current.factorise(upper)
                solution, residual = self._refined(upper, rhs)
            except Exception as error:  # MKL absent, zero pivot, out of memory: the next one may do
                reasons.append(f"{self.name}: {error}")
            else:
                if residual <= RESIDUAL_LIMIT:
                    self.max_relative_residual = max(self.max_relative_residual, residual)
                    return solution
                reasons.append(f"{self.name}: relative residual {residual:.1e}")
            if len(self._registry) == 1:
                break
            self._registry, self._current = self._registry[1:], None
        raise LinearSolveError("; ".join(reasons))

    def _refined(self, upper: sp.csr_matrix, rhs: Floats) -> tuple[Floats, float]:
        """Back substitution with up to three more steps of refinement, and the relative residual."""
        assert self._current is not None
        scale = float(np.linalg.norm(rhs)) or 1.0
        solution = self._current.back_substitute(rhs)
        for _ in range(3):
            defect = rhs - symmetric_product(upper, solution)
            residual = float(np.linalg.norm(defect)) / scale
            if not residual > RESIDUAL_LIMIT:
                break
            solution = solution + self._current.back_substitute(defect)
        return solution, residual if np.isfinite(residual) else np.inf

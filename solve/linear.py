"""Solution of the indefinite tangent, with a residual check after every solve.

PARDISO where MKL exists, as real symmetric indefinite (mtype -2) or, with friction, unsymmetric (mtype 11), else or
when its answer is wrong SciPy's SuperLU. PARDISO can return a wrong answer without an error on a weak diagonal, hence
the check.
The contact rows have a zero diagonal, which costs pivots; the matrix that is factorised carries a small negative one
instead, and GMRES preconditioned by it solves the true system in a few back substitutions (Saad, Iterative Methods
for Sparse Linear Systems, 2003, ch. 9). A factorisation costs tens of them, so one of an earlier Newton step is used
again where the tangent has changed little.
"""

import os
from importlib.metadata import files
from typing import Any, Protocol

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import LinearOperator, gmres, splu

from mesh.types import Floats
from solve.unsymmetric import Tangent

KRYLOV_ITERATIONS = 18  # with a factorisation of the same matrix
EVENS_OUT = 15_000, 20.0, 2.0 / 3.0  # unknowns, back substitutions that cost as much as a factorisation, exponent


class LinearSolveError(RuntimeError):
    """No solver gave a solution with a small residual: the tangent is singular."""


class Factorisation(Protocol):
    """A direct solver that keeps its analysis of one sparsity pattern."""

    name: str

    def factorise(self, tangent: Tangent) -> None:
        """Factorise."""

    def back_substitute(self, rhs: Floats) -> Floats:
        """Solve with the last factorisation."""

    def free(self) -> None:
        """Give its memory back."""


class Pardiso:
    """MKL PARDISO; the analysis of the pattern is kept."""

    name = "pardiso"

    def __init__(self) -> None:
        self._solver: Any = None
        self._matrix: sp.csr_matrix | None = None

    def factorise(self, tangent: Tangent) -> None:
        """Factorise; analyse the pattern the first time, an unsymmetric one each time: its pivots follow values."""
        symmetric = tangent.excess is None
        matrix = tangent.upper if symmetric else tangent.full()
        if self._solver is None:
            self._solver = _pardiso(-2 if symmetric else 11)
        self._solver.set_phase(22 if symmetric and self._matrix is not None else 12)
        self._matrix = matrix
        self._call(np.zeros(matrix.shape[0]))

    def back_substitute(self, rhs: Floats) -> Floats:
        """Solve with the last factorisation."""
        self._solver.set_phase(33)
        return self._call(rhs)

    def _call(self, rhs: Floats) -> Floats:
        """One phase."""
        solution: Floats = self._solver._call_pardiso(self._matrix, rhs)
        return solution

    def free(self) -> None:
        """Give MKL's memory back."""
        if self._solver is not None:
            self._solver.free_memory(everything=True)


def _pardiso(kind: int) -> Any:
    """PyPardiso for a matrix type, with the parameters of MKL's iparm that differ from its defaults.

    iparm(10), the size of perturbed pivots: with 1e-13, the default of unsymmetric matrices, one perturbed pivot of
    a sticking contact left residuals of 1e-3 that GMRES could not remove; with 1e-8, that of symmetric ones, 1e-7.
    """
    _tell_where_mkl_is()  # before the import, which looks for it
    from pypardiso import PyPardisoSolver

    solver = PyPardisoSolver(mtype=kind)
    symmetric = ((1, 1), (2, 3), (10, 13), (11, 0), (13, 0), (21, 1))
    unsymmetric = ((1, 1), (2, 3), (10, 8), (11, 1), (13, 1))
    for parameter, value in symmetric if kind == -2 else unsymmetric:
        solver.set_iparm(parameter, value)
    return solver


def _tell_where_mkl_is() -> None:
    """PyPardiso would search the whole environment for MKL's library; its wheel knows."""
    if "PYPARDISO_MKL_RT" in os.environ:
        return
    for file in files("mkl") or ():
        if "mkl_rt" in file.name:
            os.environ["PYPARDISO_MKL_RT"] = str(file.locate())
            return


class SuperLU:
    """SciPy's SuperLU in symmetric mode."""

    name = "superlu"

    def __init__(self) -> None:
        self._factor: Any = None

    def factorise(self, tangent: Tangent) -> None:
        """Factorise the full matrix."""
        options = {"SymmetricMode": tangent.excess is None}
        ordering = "MMD_AT_PLUS_A" if tangent.excess is None else "COLAMD"
        pivoting = 0.01 if tangent.excess is None else 1.0
        self._factor = splu(tangent.full().tocsc(), permc_spec=ordering, diag_pivot_thresh=pivoting, options=options)

    def back_substitute(self, rhs: Floats) -> Floats:
        """Solve with the last factorisation."""
        solution: Floats = self._factor.solve(rhs)
        return solution

    def free(self) -> None:
        """Give its memory back."""
        self._factor = None


class LinearSolver:
    """Solves with the first factorisation of the registry that passes the residual check.

    shift : (count,) added to the diagonal of what is factorised, not of what is solved.
    """

    def __init__(self, shift: Floats) -> None:
        self._shift = shift
        self._registry: list[type[Pardiso] | type[SuperLU]] = [Pardiso, SuperLU]
        self._current: Factorisation | None = None

    @property
    def name(self) -> str:
        """Name of the factorisation in use."""
        return self._registry[0].name

    def solve(self, tangent: Tangent, rhs: Floats, tolerance: float, similar: bool = False) -> Floats:
        """Solve A x = rhs to a relative residual.

        similar : the tangent has changed little since the last factorisation.
        LinearSolveError when every factorisation fails.
        """
        if similar and self._current is not None:
            solution, residual = self._krylov(tangent, rhs, tolerance, self._patience)
            if residual <= tolerance:
                return solution
        reasons = []
        while self._registry:
            try:
                self._factorise(tangent)
                solution, residual = self._krylov(tangent, rhs, tolerance, KRYLOV_ITERATIONS)
            except Exception as error:  # MKL absent, zero pivot, out of memory: the next one may do
                reasons.append(f"{self.name}: {error}")
            else:
                if residual <= tolerance:
                    return solution
                reasons.append(f"{self.name}: relative residual {residual:.1e}")
            if len(self._registry) == 1:
                break
            self.close()
            self._registry = self._registry[1:]
        raise LinearSolveError("; ".join(reasons))

    def may_reuse(self, changed: int) -> bool:
        """Whether the last factorisation is worth trying after so many constraints have changed their state.

        Each costs GMRES up to two more back substitutions.
        """
        return 2 * changed <= self._patience // 2

    @property
    def _patience(self) -> int:
        """Back substitutions that cost half a factorisation: more would be wasted if they fail (ski rental)."""
        unknowns, worth, exponent = EVENS_OUT
        return int(0.5 * worth * max(1.0, len(self._shift) / unknowns) ** exponent)

    def close(self) -> None:
        """Give the memory of the factorisation back."""
        if self._current is not None:
            self._current.free()
        self._current = None

    def _factorise(self, tangent: Tangent) -> None:
        self._current = self._current or self._registry[0]()
        if tangent.excess is None:
            tangent = tangent.shifted(self._shift)
        self._current.factorise(tangent)

    def _krylov(self, tangent: Tangent, rhs: Floats, tolerance: float, iterations: int) -> tuple[Floats, float]:
        """GMRES preconditioned from the right by the last factorisation, and the true relative residual."""
        direct = self._current
        assert direct is not None
        operator = LinearOperator(tangent.upper.shape, lambda v: tangent @ direct.back_substitute(v), dtype=float)
        transformed, _ = gmres(operator, rhs, rtol=0.9 * tolerance, restart=iterations, maxiter=1)
        solution = direct.back_substitute(transformed)
        scale = float(np.linalg.norm(rhs)) or 1.0
        residual = float(np.linalg.norm(rhs - tangent @ solution)) / scale
        return solution, residual if np.isfinite(residual) else np.inf

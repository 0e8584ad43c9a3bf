"""Direct factorisations of a sparse tangent: MKL's PARDISO, and SciPy's SuperLU where MKL is missing or fails.

PARDISO takes the tangent as real symmetric indefinite (mtype -2) or, with friction, unsymmetric (mtype 11). It can
return a wrong answer without an error on a weak diagonal, so that whoever asks must check.
"""

import os
from importlib.metadata import files
from typing import Any, Protocol

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from geometry.arrays import Floats
from solve.fem.sparsity import Tangent


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
    symmetric = True

    def __init__(self) -> None:
        self._solver: Any = None
        self._matrix: sp.csr_matrix | None = None

    def factorise(self, tangent: Tangent) -> None:
        """Factorise; analyse the pattern the first time, an unsymmetric one each time: its pivots follow values."""
        symmetric = tangent.excess is None and self.symmetric
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


class PivotingPardiso(Pardiso):
    """PARDISO for an unsymmetric matrix, whatever the matrix: scaled, matched, with row exchanges in each supernode.

    It takes twice the time and memory of the symmetric one, and a fraction of SuperLU's.
    """

    name = "pardiso with stronger pivoting"
    symmetric = False


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

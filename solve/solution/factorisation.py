"""Direct factorisations of a sparse tangent: MKL's PARDISO, and SciPy's SuperLU where MKL is missing or fails.

PARDISO takes the tangent as real symmetric indefinite (mtype -2) or, with friction, unsymmetric (mtype 11). It can
return a wrong answer without an error on a weak diagonal, so that whoever asks must check. In single precision it takes
60 % of the time and half the memory; iterations that it preconditions in double precision make up for the digits that
it lacks (Buttari, Dongarra, Kurzak, Luszczek and Tomov, ACM Trans. Math. Softw. 34, 2008, art. 17).
"""

import ctypes
import os
from importlib.metadata import files
from typing import Any, Protocol

import numpy as np
from scipy.sparse.linalg import splu

from foundation.arrays import Floats
from solve.fem.tangent import Tangent


class Factorisation(Protocol):
    """A direct solver that keeps its analysis of one sparsity pattern."""

    name: str

    def factorise(self, tangent: Tangent) -> None:
        """Factorise."""

    def back_substitute(self, rhs: Floats) -> Floats:
        """Solve with the last factorisation, (n,) or many at once (n, m)."""

    def free(self) -> None:
        """Give its memory back."""


ANALYSE_AND_FACTORISE, FACTORISE, BACK_SUBSTITUTE = 12, 22, 33  # PARDISO's phases


class Pardiso:
    """MKL PARDISO; the analysis of the pattern is kept."""

    name = "pardiso"
    symmetric = True
    precision: type[np.floating[Any]] = np.float64

    def __init__(self) -> None:
        self._solver: Any = None
        self._values: Any = None
        self._rows: Any = None
        self._columns: Any = None

    def factorise(self, tangent: Tangent) -> None:
        """Factorise; analyse the pattern the first time, an unsymmetric one each time: its pivots follow values."""
        symmetric = tangent.excess is None and self.symmetric
        matrix = tangent.upper if symmetric else tangent.full()
        known = symmetric and self._solver is not None
        if not known:
            self._rows, self._columns = (part.astype(np.int32) + 1 for part in (matrix.indptr, matrix.indices))
        if self._solver is None:
            self._solver = _pardiso(-2 if symmetric else 11, self.precision is np.float32)
        with np.errstate(over="raise"):  # what single precision cannot hold is for the next solver, without a warning
            self._values = matrix.data.astype(self.precision)
        self._call(FACTORISE if known else ANALYSE_AND_FACTORISE, np.zeros(matrix.shape[0], self.precision))

    def back_substitute(self, rhs: Floats) -> Floats:
        """Solve with the last factorisation, (n,) or many at once (n, m)."""
        return np.asarray(self._call(BACK_SUBSTITUTE, np.asfortranarray(rhs, self.precision)), np.float64)

    def _call(self, phase: int, rhs: Any) -> Any:
        """One phase. PyPardiso's own call copies the pattern, which takes a quarter of a back substitution."""
        from pypardiso.pardiso_wrapper import PyPardisoError

        solver, solution, error = self._solver, np.zeros_like(rhs), ctypes.c_int32(0)
        integers = ctypes.POINTER(ctypes.c_int32)
        maxfct, mnum, mtype, phase_, order, count, silent = (
            ctypes.byref(ctypes.c_int32(number))
            for number in (1, 1, solver.mtype, phase, len(rhs), 1 if rhs.ndim == 1 else rhs.shape[1], 0)
        )
        solver._mkl_pardiso(
            solver.pt.ctypes.data_as(ctypes.POINTER(solver._pt_type[0])), maxfct, mnum, mtype, phase_, order,
            self._values.ctypes.data_as(ctypes.c_void_p), self._rows.ctypes.data_as(integers),
            self._columns.ctypes.data_as(integers), solver.perm.ctypes.data_as(integers), count,
            solver.iparm.ctypes.data_as(integers), silent, rhs.ctypes.data_as(ctypes.c_void_p),
            solution.ctypes.data_as(ctypes.c_void_p), ctypes.byref(error),
        )  # fmt: skip
        if error.value:
            raise PyPardisoError(error.value)
        return solution

    def free(self) -> None:
        """Give MKL's memory back."""
        if self._solver is not None:
            self._solver.free_memory(everything=True)


class SinglePardiso(Pardiso):
    """PARDISO in single precision."""

    name = "pardiso in single precision"
    precision = np.float32


class PivotingPardiso(Pardiso):
    """PARDISO for an unsymmetric matrix, whatever the matrix: scaled, matched, with row exchanges in each supernode.

    It takes twice the time and memory of the symmetric one, and a fraction of SuperLU's.
    """

    name = "pardiso with stronger pivoting"
    symmetric = False


def _pardiso(kind: int, single: bool) -> Any:
    """PyPardiso for a matrix type, with the parameters of MKL's iparm that differ from its defaults.

    iparm(10), the size of perturbed pivots: with 1e-13, the default of unsymmetric matrices, one perturbed pivot of
    a sticking contact left residuals of 1e-3 that GMRES could not remove; with 1e-8, that of symmetric ones, 1e-7.
    """
    _tell_where_mkl_is()  # before the import, which looks for it
    from pypardiso import PyPardisoSolver

    solver = PyPardisoSolver(mtype=kind)
    symmetric = ((1, 1), (2, 3), (10, 13), (11, 0), (13, 0), (21, 1))
    unsymmetric = ((1, 1), (2, 3), (10, 8), (11, 1), (13, 1))
    for parameter, value in (*(symmetric if kind == -2 else unsymmetric), (28, int(single))):
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
        """Solve with the last factorisation, (n,) or many at once (n, m)."""
        solution: Floats = self._factor.solve(rhs)
        return solution

    def free(self) -> None:
        """Give its memory back."""
        self._factor = None

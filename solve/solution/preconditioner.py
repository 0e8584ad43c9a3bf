"""A factorisation as a preconditioner, also after constraints that it holds have been released.

A constraint j that is closed reads G_j du = r_j, with its pressure as the unknown dlambda_j in the other rows; open, it
reads -dlambda_j = r_j, and no other row has dlambda_j. The matrix with some constraints released follows from the
factorised one, K, by bordering: one more unknown mu_j in row j lets go of it, one more equation takes dlambda_j out of
the others. With E the columns of these unknowns,

    K z + E mu = r (0 in the rows j),    E^t z = 0,    (E^t K^-1 E) mu = E^t K^-1 r,

which takes a back substitution for each released constraint, many at once, and a small dense matrix (Nocedal and
Wright, Numerical Optimization, 2006, ch. 16, on the Schur complement method for changes of the active set).
"""

from dataclasses import dataclass

import numpy as np

from geometry.arrays import Bools, Floats, Ints
from solve.fem.sparsity import Tangent
from solve.solution.factorisation import Factorisation

NOTHING = 1e-12  # relative singular value of a constraint that holds nothing


class Preconditioner:
    """multipliers : (c,) unknowns of the constraints; an open one has the diagonal entry -1 and nothing else."""

    def __init__(self, direct: Factorisation, multipliers: Ints) -> None:
        self.direct, self._multipliers = direct, multipliers
        self._closed: Bools = np.zeros(len(multipliers), dtype=np.bool_)
        self._columns: dict[int, Floats] = {}
        self._release: _Release | None = None
        self.back_substitutions = 0
        """Since the factorisation."""

    def factorise(self, tangent: Tangent, shift: Floats) -> None:
        """Factorise with shift (n,) on the diagonal; an unsymmetric tangent as it is."""
        self._closed, self._release = tangent.diagonal[self._multipliers] == 0.0, None
        self._columns.clear()
        self.direct.factorise(tangent if tangent.excess is not None else tangent.shifted(shift))
        self.back_substitutions = 0

    def changed(self, tangent: Tangent) -> tuple[int, int]:
        """How many constraints of a tangent have closed and opened since the factorisation."""
        closed = tangent.diagonal[self._multipliers] == 0.0
        return int(np.sum(closed & ~self._closed)), int(np.sum(self._closed & ~closed))

    def adapt(self, tangent: Tangent) -> None:
        """Release what is open in a symmetric tangent and was closed when factorised; keep what is known of it."""
        opened = self._multipliers[self._closed & (tangent.diagonal[self._multipliers] != 0.0)]
        if len(opened) == 0 or tangent.excess is not None:
            self._release = None
            return
        if self._release is not None and np.array_equal(opened, self._release.rows):
            return
        new = np.array([row for row in opened if row not in self._columns], dtype=np.int64)
        if len(new):
            units = np.zeros((tangent.upper.shape[0], len(new)), order="F")
            units[new, np.arange(len(new))] = 1.0
            self._columns.update(zip(new.tolist(), self.direct.back_substitute(units).T, strict=True))
        columns = np.column_stack([self._columns[row] for row in opened.tolist()])
        self._release = _Release(opened, columns, np.linalg.pinv(columns[opened], rcond=NOTHING))

    def __call__(self, rhs: Floats) -> Floats:
        """Solve approximately, (n,)."""
        self.back_substitutions += 1
        release = self._release
        if release is None:
            return self.direct.back_substitute(rhs)
        free = rhs.copy()
        free[release.rows] = 0.0
        return release.applied(self.direct.back_substitute(free), rhs)


@dataclass(frozen=True)
class _Release:
    """rows (m,), columns K^-1 E (n, m) and the pseudo-inverse (m, m) of E^t K^-1 E: a constraint may hold nothing."""

    rows: Ints
    columns: Floats
    inverse: Floats

    def applied(self, held: Floats, rhs: Floats) -> Floats:
        """The solution z (n,) from that with the constraints held."""
        force = self.inverse @ held[self.rows]
        result: Floats = held - self.columns @ force
        result[self.rows] = -rhs[self.rows]
        return result

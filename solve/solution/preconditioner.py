"""A factorisation as a preconditioner, also after constraints have opened or closed since.

A constraint j that is closed reads G_j du = r_j, with its pressure as the unknown dlambda_j in the other rows; open, it
reads -dlambda_j = r_j, and no other row has dlambda_j. The matrix with some constraints changed follows from the
factorised one, K, by bordering. To open one, one more unknown mu_j in row j lets go of it, and one more equation takes
dlambda_j out of the others. To close one, G_j and its transpose are the border, and mu_j is dlambda_j itself. With B
the columns of these unknowns, unit vectors and G_j^t,

    K z + B mu = r (0 in the rows j),    B^t z = c,    (B^t K^-1 B) mu = B^t K^-1 r - c,

where c_j is 0 for one that opens and r_j for one that closes. This takes a back substitution for each constraint that
changed, many at once, and a small dense matrix (Nocedal and Wright, Numerical Optimization, 2006, ch. 16, on the Schur
complement method for changes of the active set). Without the border, GMRES took ten iterations to find out about a
single constraint that had closed.
"""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from foundation.arrays import Bools, Floats, Ints
from solve.fem.tangent import Tangent
from solve.solution.factorisation import Factorisation

EMPTY_CONSTRAINT = 1e-12  # relative singular value of a constraint that holds nothing


class Preconditioner:
    """A factorisation whose changed constraints are bordered. multipliers : (c,) unknowns of the constraints; an open
    one has the diagonal entry -1 and nothing else.
    """

    def __init__(self, direct: Factorisation, multipliers: Ints) -> None:
        self.direct, self._multipliers = direct, multipliers
        self._closed: Bools = np.zeros(len(multipliers), dtype=np.bool_)
        self._changed: _ChangedConstraints | None = None
        self._border: _Border | None = None
        self.back_substitutions = 0
        """Since the factorisation."""

    def factorise(self, tangent: Tangent, shift: Floats) -> None:
        """Factorise with shift (n,) on the diagonal; an unsymmetric tangent as it is."""
        self._closed, self._changed, self._border = self._closed_constraints(tangent), None, None
        self.direct.factorise(tangent if tangent.excess is not None else tangent.with_shift(shift))
        self.back_substitutions = 0

    def changed_constraints(self, tangent: Tangent) -> int:
        """Number of constraints of a tangent that have closed or opened since the factorisation."""
        return int(np.sum(self._closed_constraints(tangent) != self._closed))

    def _closed_constraints(self, tangent: Tangent) -> Bools:
        """Whether each constraint (c,) is closed in a tangent."""
        return np.asarray(tangent.diagonal[self._multipliers] == 0.0)

    def adapt(self, tangent: Tangent) -> None:
        """Open and close what a symmetric tangent has open and closed; keep what is known of it."""
        rows = self._multipliers[self._closed_constraints(tangent) != self._closed]
        if len(rows) == 0 or tangent.excess is not None:
            self._border = None
            return
        if self._border is not None and np.array_equal(rows, self._border.rows):
            return
        if self._changed is None:
            self._changed = _ChangedConstraints(np.zeros(0, np.int64), sp.csr_array((0, tangent.upper.shape[0])), None)
        new = np.setdiff1d(rows, self._changed.rows)
        if len(new):
            across = _borders(tangent, new)
            self._changed = self._changed.extend(new, across, self.direct.back_substitute(across.T.toarray()))
        self._border = self._changed.border(rows, tangent.diagonal[rows] != 0.0)

    def __call__(self, rhs: Floats) -> Floats:
        """Solve approximately, (n,)."""
        self.back_substitutions += 1
        border = self._border
        if border is None:
            return self.direct.back_substitute(rhs)
        rest = rhs.copy()
        rest[border.rows] = 0.0
        return border.correct(self.direct.back_substitute(rest), rhs)


def _borders(tangent: Tangent, rows: Ints) -> sp.csr_array:
    """B^t (m, n): unit vectors of the constraints that are open, the constraints themselves where they are closed."""
    count = tangent.upper.shape[0]
    units = sp.csr_array((np.ones(len(rows)), (np.arange(len(rows)), rows)), (len(rows), count))
    closed = sp.diags_array((tangent.diagonal[rows] == 0.0).astype(np.float64)) @ units
    # the diagonal, which both triangles hold, is zero
    return sp.csr_array(units - closed + closed @ tangent.upper + closed @ tangent.upper.T)


@dataclass(frozen=True)
class _ChangedConstraints:
    """Constraints that have changed at any time since the factorisation: rows (m,), across B^t (m, n) and K^-1 B
    (n, m), None where there are none.
    """

    rows: Ints
    across: sp.csr_array
    columns: Floats | None

    def extend(self, rows: Ints, across: sp.csr_array, columns: Floats) -> "_ChangedConstraints":
        """A copy with more constraints."""
        wider = columns if self.columns is None else np.column_stack([self.columns, columns])
        return _ChangedConstraints(np.append(self.rows, rows), sp.vstack([self.across, across], format="csr"), wider)

    def border(self, rows: Ints, opened: Bools) -> "_Border":
        """Border of some of the constraints. A pseudo-inverse, since a constraint may hold nothing; scaled, since one
        that opens is a pressure and one that closes a gap.
        """
        assert self.columns is not None
        order = np.argsort(self.rows)
        at = order[np.searchsorted(self.rows, rows, sorter=order)]
        across, columns = self.across[at], self.columns[:, at]
        schur = across @ columns
        size = np.sqrt(np.abs(schur.diagonal()))
        size[size == 0.0] = 1.0
        scale = np.outer(size, size)
        return _Border(rows, opened, across, columns, np.linalg.pinv(schur / scale, rcond=EMPTY_CONSTRAINT) / scale)


@dataclass(frozen=True)
class _Border:
    """Border of some changed constraints. rows (m,); opened (m,), the others closed; across B^t (m, n); columns K^-1 B
    (n, m); inverse (m, m) of B^t K^-1 B.
    """

    rows: Ints
    opened: Bools
    across: sp.csr_array
    columns: Floats
    inverse: Floats

    def correct(self, held: Floats, rhs: Floats) -> Floats:
        """Solution z (n,) with the border, from that without it."""
        own = rhs[self.rows]
        force = self.inverse @ (self.across @ held - np.where(self.opened, 0.0, own))
        result: Floats = held - self.columns @ force
        result[self.rows] = np.where(self.opened, -own, force)
        return result

"""Unsymmetric tangents (friction) beside the symmetric one: the upper triangle and the excess of the lower one.

A = U + strict(U)^t + L^t, where U is the upper triangle and L, on the same pattern and zero on its diagonal, holds
A_ji - A_ij at (i, j). Symmetric terms leave L alone, so that only friction pays for it.
"""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from foundation.arrays import Floats, Ints


@dataclass(frozen=True)
class Tangent:
    """Sparse matrix. upper : (n, n) upper triangle; excess : L on the same pattern, None for a symmetric tangent."""

    upper: sp.csr_matrix
    excess: sp.csr_matrix | None = None

    def __matmul__(self, vector: Floats) -> Floats:
        product: Floats = self.upper @ vector + self.upper.T @ vector - self.diagonal * vector
        if self.excess is not None:
            product += self.excess.T @ vector
        return product

    @property
    def diagonal(self) -> Floats:
        """Diagonal entries (n,)."""
        return np.asarray(self.upper.data[self._leading])

    @property
    def _leading(self) -> Ints:
        """Places (n,) of the diagonal in the data: it leads each row of an upper triangle."""
        return np.asarray(self.upper.indptr[:-1])

    def with_shift(self, by: Floats) -> "Tangent":
        """The tangent with a shift (n,) added to its diagonal."""
        upper = self.upper.copy()
        upper.data[self._leading] += by
        return Tangent(upper, self.excess)

    def absolute(self) -> "Tangent":
        """The tangent of absolute values, entry by entry."""
        upper = abs(self.upper)
        if self.excess is None:
            return Tangent(upper)
        excess = self.excess.copy()
        excess.data = np.abs(self.upper.data + self.excess.data) - upper.data
        return Tangent(upper, excess)

    def full(self) -> sp.csr_matrix:
        """The matrix of both triangles, explicit zeros kept so that the pattern never changes."""
        upper = self.upper
        rows = np.repeat(np.arange(upper.shape[0]), np.diff(upper.indptr))
        strict = rows != upper.indices
        lower = upper.data if self.excess is None else upper.data + self.excess.data
        row, col = np.append(rows, upper.indices[strict]), np.append(upper.indices, rows[strict])
        full = sp.csr_matrix((np.append(upper.data, lower[strict]), (row, col)), upper.shape)
        full.sort_indices()
        return full

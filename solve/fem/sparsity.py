"""The fixed pattern of the symmetric tangent and where each element entry goes in it.

Unsymmetric tangents (friction) beside the symmetric one: the upper triangle and the excess of the lower one.

A = U + strict(U)^t + L^t, where U is the upper triangle and L, on the same pattern and zero on its diagonal, holds
A_ji - A_ij at (i, j). Symmetric terms leave L alone, so that only friction pays for it.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numba as nb
import numpy as np
import scipy.sparse as sp

from geometry.arrays import Floats, Ints


@dataclass(frozen=True)
class Pattern:
    """Upper triangle in CSR form with every diagonal entry present.

    slots : for each element group (m, k (k + 1) / 2) int32, packed upper triangle -> index into the data, -1 = fixed.
    """

    indptr: Ints
    indices: Ints
    diagonal: Ints
    slots: tuple[Ints, ...]

    def matrix(self, data: Floats) -> sp.csr_matrix:
        """The upper triangle as a scipy matrix that shares data."""
        n = len(self.indptr) - 1
        return sp.csr_matrix((data, self.indices, self.indptr), shape=(n, n), copy=False)


def build_pattern(groups: Sequence[Ints], count: int) -> Pattern:
    """Pattern of count unknowns coupled by groups of elements, each an (m, k) array of unknowns (-1 = fixed)."""
    total = sp.csr_matrix(sp.identity(count, dtype=np.int8))
    for dofs in groups:
        total = total + _coupling(dofs, count)
    upper = sp.triu(total, format="csr")
    upper.sort_indices()
    indptr, indices = upper.indptr.astype(np.int32), upper.indices.astype(np.int32)
    slots = tuple(_slots(np.ascontiguousarray(dofs), indptr, indices) for dofs in groups)
    return Pattern(indptr, indices, indptr[:-1].astype(np.int64), slots)


def _coupling(dofs: Ints, count: int) -> sp.csr_matrix:
    """Which unknowns meet in an element, as the product of the incidence matrix with itself."""
    elements, width = dofs.shape
    rows = np.repeat(np.arange(elements), width)
    keep = dofs.ravel() >= 0
    shape = (elements, count)
    incidence = sp.csr_matrix((np.ones(keep.sum(), np.float32), (rows[keep], dofs.ravel()[keep])), shape)
    product = (incidence.T @ incidence).tocsr()
    product.data = np.ones(len(product.data), np.int8)
    return product


@nb.njit(parallel=True, cache=True)
def _slots(dofs, indptr, indices):  # type: ignore[no-untyped-def]
    """Binary search of each upper-triangle pair in its row."""
    elements, width = dofs.shape
    slots = np.full((elements, width * (width + 1) // 2), -1, np.int32)
    for e in nb.prange(elements):
        n = 0
        for i in range(width):
            for j in range(i, width):
                a, b = min(dofs[e, i], dofs[e, j]), max(dofs[e, i], dofs[e, j])
                if a >= 0:
                    low, high = indptr[a], indptr[a + 1] - 1
                    while low < high:
                        middle = (low + high) // 2
                        if indices[middle] < b:
                            low = middle + 1
                        else:
                            high = middle
                    slots[e, n] = low
                n += 1
    return slots


@dataclass(frozen=True)
class Tangent:
    """upper : (n, n) upper triangle; excess : L on the same pattern, None for a symmetric tangent."""

    upper: sp.csr_matrix
    excess: sp.csr_matrix | None = None

    def __matmul__(self, vector: Floats) -> Floats:
        diagonal = self.upper.data[self._leading]
        product: Floats = self.upper @ vector + self.upper.T @ vector - diagonal * vector
        if self.excess is not None:
            product += self.excess.T @ vector
        return product

    @property
    def _leading(self) -> Ints:
        """Where the diagonal is: it leads each row of an upper triangle."""
        return np.asarray(self.upper.indptr[:-1])

    def shifted(self, by: Floats) -> "Tangent":
        """With (n,) added to the diagonal."""
        upper = self.upper.copy()
        upper.data[self._leading] += by
        return Tangent(upper, self.excess)

    def absolute(self) -> "Tangent":
        """|A|, entry by entry."""
        upper = abs(self.upper)
        if self.excess is None:
            return Tangent(upper)
        excess = self.excess.copy()
        excess.data = np.abs(self.upper.data + self.excess.data) - upper.data
        return Tangent(upper, excess)

    def full(self) -> sp.csr_matrix:
        """Both triangles, explicit zeros kept so that the pattern never changes."""
        upper = self.upper
        rows = np.repeat(np.arange(upper.shape[0]), np.diff(upper.indptr))
        strict = rows != upper.indices
        lower = upper.data if self.excess is None else upper.data + self.excess.data
        row, col = np.append(rows, upper.indices[strict]), np.append(upper.indices, rows[strict])
        full = sp.csr_matrix((np.append(upper.data, lower[strict]), (row, col)), upper.shape)
        full.sort_indices()
        return full


@nb.njit(cache=True)
def scatter_unsymmetric(ke, re, dofs, slots, data, excess, residual):  # type: ignore[no-untyped-def]
    """Add full element matrices (m, k, k) to the upper triangle and to the excess of the lower one.

    slots as in sparsity.Pattern: packed upper triangle of local pairs.
    """
    for e in range(ke.shape[0]):
        n = 0
        for i in range(ke.shape[1]):
            if dofs[e, i] >= 0:
                residual[dofs[e, i]] += re[e, i]
            for j in range(i, ke.shape[1]):
                slot = slots[e, n]
                n += 1
                if slot < 0:
                    continue
                if i == j:
                    data[slot] += ke[e, i, i]
                elif dofs[e, i] == dofs[e, j]:
                    data[slot] += ke[e, i, j] + ke[e, j, i]
                else:
                    above, below = (i, j) if dofs[e, i] < dofs[e, j] else (j, i)
                    data[slot] += ke[e, above, below]
                    excess[slot] += ke[e, below, above] - ke[e, above, below]

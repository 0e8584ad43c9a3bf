"""The fixed pattern of the tangent: the upper triangle in compressed rows, and where each pair of unknowns is in it."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from foundation.arrays import Floats, Ints
from solve.compiled import in_threads


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
    slots = tuple(_slots_of(np.ascontiguousarray(dofs), indptr, indices) for dofs in groups)
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


def _slots_of(dofs: Ints, indptr: Ints, indices: Ints) -> Ints:
    """Place (m, pairs) of each upper-triangle pair of dofs (m, k) in the rows of a pattern, -1 where one is fixed."""
    elements, width = dofs.shape
    slots = np.full((elements, width * (width + 1) // 2), -1, np.int32)
    _search(dofs, indptr, indices, slots)
    return slots


@in_threads()
def _search(start, stop, dofs, indptr, indices, slots):  # type: ignore[no-untyped-def]
    """Binary search of each upper-triangle pair in its row."""
    width = dofs.shape[1]
    for e in range(start, stop):
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

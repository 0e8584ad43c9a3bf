"""Terms of the discrete problem, the numbering of its unknowns, and the fixed pattern of its tangent.

Unsymmetric tangents (friction) beside the symmetric one: the upper triangle and the excess of the lower one.

A = U + strict(U)^t + L^t, where U is the upper triangle and L, on the same pattern and zero on its diagonal, holds
A_ji - A_ij at (i, j). Symmetric terms leave L alone, so that only friction pays for it.
"""

from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numba as nb
import numpy as np
import scipy.sparse as sp

from geometry.arrays import Bools, Floats, Ints
from mesh.symmetry import in_plane
from mesh.types import TetMesh
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


@dataclass(frozen=True)
class Tangent:
    """upper : (n, n) upper triangle; excess : L on the same pattern, None for a symmetric tangent."""

    upper: sp.csr_matrix
    excess: sp.csr_matrix | None = None

    def __matmul__(self, vector: Floats) -> Floats:
        product: Floats = self.upper @ vector + self.upper.T @ vector - self.diagonal * vector
        if self.excess is not None:
            product += self.excess.T @ vector
        return product

    @property
    def diagonal(self) -> Floats:
        """Its entries (n,)."""
        return np.asarray(self.upper.data[self._leading])

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


History = Any  # arrays that a term carries from one converged state to the next; None for one without memory


@dataclass(frozen=True)
class Trial:
    """A trial state and the converged state before it, in solver units (time in s).

    x : (count,) unknowns; displacement : (n, 3) nodes; move : (3,) displacement of the dot; drive : what the rig
    prescribes of the approach (displacement of the sensor, or force). previous_... : the same, last converged.
    damped : the step is too coarse for the motion of a mass, whose oscillation is to fade.
    """

    x: Floats
    displacement: Floats
    move: Floats
    drive: float
    previous_displacement: Floats
    previous_move: Floats
    previous_drive: float
    time: float
    time_step: float
    damped: bool = False


class Block(NamedTuple):
    """Element matrices (s, k, k) and residuals (s, k) of the elements in part of one group of a term.

    part : a slice, or the numbers of the elements. Symmetric terms fill the upper triangles only.
    """

    group: int
    part: slice | Ints
    matrices: Floats
    residuals: Floats


class Term(ABC):
    """One part of the problem: a medium, the film, a bond, the contact, the rig.

    groups : arrays (m, k) of unknowns, -1 where prescribed, one row an element.
    """

    symmetric = True
    is_load = False  # whether load_norm is to be asked
    inelastic: tuple[Any, ...] = ()  # laws with memory, whose memories are the history of the term

    @property
    @abstractmethod
    def groups(self) -> tuple[Ints, ...]:
        """Unknowns (m, k) of each group of elements."""

    def start(self) -> History:
        """Memory of the undeformed state at rest."""
        return None

    @abstractmethod
    def elements(self, trial: Trial, history: History) -> Iterator[Block]:
        """Residuals and consistent tangents, group by group and chunk by chunk."""

    def advance(self, trial: Trial, history: History) -> History:
        """Memory once the trial state has converged."""
        return history

    def status(self, trial: Trial, history: History) -> Bools:
        """Discrete states (open or touching, stick or slip) that must repeat before Newton has converged."""
        return np.zeros(0, bool)

    def elements_in(self, trial: Trial, status: Bools) -> Iterator[Block] | None:
        """As elements, with constraints in these states in place of the trial's own; None where there is no way."""
        return None

    def touches(self, status: Bools) -> bool:
        """Whether the dot touches, by the discrete states of this term."""
        return False

    def load_norm(self, trial: Trial, forces: Floats) -> float:
        """Norm of the load that this term puts on; forces : its part of the residual at the displacements."""
        return 0.0

    def dot_force(self, trial: Trial) -> Floats:
        """Its part (3,) of the dot's force on the meshed body."""
        return np.zeros(3)

    def contact_traction(self, trial: Trial) -> Floats:
        """Of the dot on the surface, per undeformed area, at nodes of the contact facets (c, 3); none: zeros (3,)."""
        return np.zeros(3)

    def constraints(self) -> tuple[Ints, Floats]:
        """Lagrange multipliers without a diagonal entry: their unknowns (c,) and nodal areas (c,)."""
        return np.zeros(0, np.int64), np.zeros(0)

    def time_error(self, history: History, new: History, time_step: float, after_kink: bool) -> float:
        """Estimated error of the time integration in a step, relative; zero for a term without rates.

        after_kink : the rate of loading jumped at the start of the step.
        """
        return 0.0


class Numbers:
    """Hands out the numbers of unknowns, one after the other."""

    def __init__(self) -> None:
        self.count = 0

    def take(self, how_many: int) -> Ints:
        """The next numbers (how_many,)."""
        self.count += how_many
        return np.arange(self.count - how_many, self.count)


@dataclass(frozen=True)
class Unknowns:
    """Global numbers; -1 stands for a value that is prescribed.

    displacement : (n, 3) one row a node, twins share theirs.
    pressure : (m, 4) of the corners of each tetrahedron, continuous inside a region only; -1 in film and foam.
    voltage : (e,) one per electrode, the same for electrodes in parallel, -1 where it does not act back on the film.
    contact : (n,) contact pressure at the nodes of the contact facets, else -1.
    approach : number of the dot's approach, or -1 when it is prescribed.
    """

    displacement: Ints
    pressure: Ints
    voltage: Ints
    contact: Ints
    approach: int


def fixed_nodes(tet_mesh: TetMesh, held_regions: tuple[str, ...]) -> Ints:
    """Nodes whose displacement is zero: the base and the sides of the regions that the case holds."""
    names = ["base", *(f"side-{name}" for name in held_regions)]
    facets = [tet_mesh.facets[name].ravel() for name in names if name in tet_mesh.facets]
    return np.unique(np.concatenate(facets))


def number(
    tet_mesh: TetMesh,
    numbers: Numbers,
    held_regions: tuple[str, ...],
    plane_strain: bool,
    without_pressure: tuple[str, ...],
    electrodes: Ints,
    two_way: bool,
    parallel: bool,
    approach: bool,
) -> Unknowns:
    """Number the unknowns of a problem.

    electrodes : (e,) numbers from 0, equal for electrodes of equal voltage; two_way : voltages act back, of electrodes
    in parallel or each alone.
    """
    twin = tet_mesh.twin
    free = _free(tet_mesh, held_regions, plane_strain)
    displacement = np.full(free.shape, -1)
    displacement[free] = numbers.take(int(free.sum()))
    pressure, corners = _pressures(tet_mesh, numbers, without_pressure)
    contact = np.full(len(free), -1)
    touching = np.unique(twin[tet_mesh.facets["contact"]])
    contact[touching] = numbers.take(len(touching))

    nodes = np.concatenate([np.nonzero(free)[0], corners, touching])
    new = np.append(along_x(tet_mesh.points_mm[nodes]), -1)  # -1 stays -1
    voltage = np.full(len(electrodes), -1)
    if two_way:
        voltage[:] = numbers.take(1) if parallel else numbers.take(int(electrodes.max()) + 1)[electrodes]
    dot = int(numbers.take(1)[0]) if approach else -1
    return Unknowns(new[displacement][twin], new[pressure], voltage, new[contact][twin], dot)


def _free(tet_mesh: TetMesh, held_regions: tuple[str, ...], plane_strain: bool) -> Bools:
    """Which displacements are unknown (n, 3); of twins only the first."""
    free = np.zeros((len(tet_mesh.points_mm), 3), bool)
    free[tet_mesh.twin[tet_mesh.tets]] = True
    free[tet_mesh.twin[fixed_nodes(tet_mesh, held_regions)]] = False
    if plane_strain:
        free[:, 1] = False
    for axis in tet_mesh.planes:
        free[in_plane(tet_mesh.points_mm, axis), axis] = False
    return free


def _pressures(tet_mesh: TetMesh, numbers: Numbers, without_pressure: tuple[str, ...]) -> tuple[Ints, Ints]:
    """Numbers (m, 4) at the corners of the tetrahedra, -1 where there is none, and the node of each number."""
    pressure, nodes = np.full((len(tet_mesh.tets), 4), -1), [np.zeros(0, np.int64)]
    for region, name in enumerate(tet_mesh.region_names):
        if name in without_pressure:
            continue
        inside = tet_mesh.region == region
        corners, local = np.unique(tet_mesh.twin[tet_mesh.tets[inside, :4]], return_inverse=True)
        pressure[inside] = numbers.take(len(corners))[local.reshape(-1, 4)]
        nodes.append(corners)
    return pressure, np.concatenate(nodes)


def along_x(points: Floats) -> Ints:
    """New number of each unknown (count,) from its node's place (count, 3): by x, then y, then z.

    Nested dissection starts from the given numbers. Unknowns that lie together had up to a quarter less to factorise
    when they were numbered together, on a cube of 280 000; on a segment it makes no difference.
    """
    new = np.empty(len(points), np.int64)
    new[np.lexsort(points.T[::-1])] = np.arange(len(points))
    return new

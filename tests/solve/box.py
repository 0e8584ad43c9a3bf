"""A box of tetrahedra, distorted inside, and the mixed solid on it: the smallest stage for patch tests."""

import itertools
from dataclasses import dataclass

import numpy as np
from scipy.sparse.linalg import spsolve

from foundation.arrays import Floats, Ints
from softdot.verify.lattice import KUHN_PATHS
from solve.fem.assembly import scatter
from solve.fem.pattern import build_pattern
from solve.fem.shape_functions import TET_EDGES
from solve.materials.laws import MediumLaw
from solve.terms.solid import SolidRegion, solid_region
from tests.solve.trial import trial


def box(cells: int, size: tuple[float, float, float] = (1.0, 1.0, 1.0), jitter: float = 0.0) -> tuple[Floats, Ints]:
    """Quadratic nodes (n, 3) and tets (m, 10): each cube in six, inner corners moved by jitter of the cell."""
    grid = np.stack(np.meshgrid(*3 * [np.arange(cells + 1)], indexing="ij"), -1).reshape(-1, 3)
    inner = ((grid > 0) & (grid < cells)).all(axis=1)
    corners = grid / cells
    rng = np.random.default_rng(1)
    corners[inner] += rng.uniform(-jitter, jitter, (inner.sum(), 3)) / cells
    tets = []
    stride = np.array([(cells + 1) ** 2, cells + 1, 1])
    offset = [stride @ [(k >> a) & 1 for a in range(3)] for k in range(8)]
    for cube in itertools.product(range(cells), repeat=3):
        vertex = [stride @ cube + shift for shift in offset]
        tets += [[vertex[k] for k in path] for path in KUHN_PATHS]
    linear = np.array(tets)
    edge = corners[linear[:, 1:]] - corners[linear[:, :1]]
    flip = np.linalg.det(edge) < 0
    linear[flip, 2:] = linear[flip, :1:-1]
    pairs = np.sort(linear[:, TET_EDGES].reshape(-1, 2), axis=1)
    unique, middle = np.unique(pairs, axis=0, return_inverse=True)
    points = np.vstack([corners, corners[unique].mean(axis=1)]) * size
    return points, np.hstack([linear, len(corners) + middle.reshape(-1, 6)])


@dataclass
class MixedBody:
    """One medium whose boundary displacement is prescribed."""

    points: Floats
    tets: Ints
    solid: SolidRegion
    displacement_dofs: Ints
    count: int

    def solve(self, prescribed: Floats, load: Floats | None = None) -> tuple[Floats, Floats]:
        """Displacement (n, 3) and pressure at corners, given prescribed (n, 3) on the boundary
        (inside it is only the start of the iteration); load (n, 3)."""
        pattern = build_pattern([self.solid.dofs], self.count)
        x, fixed = np.zeros(self.count), self.displacement_dofs < 0
        x[self.displacement_dofs[~fixed]] = 0.9 * prescribed[~fixed]  # a start that inverts no element
        external = np.zeros(self.count)
        if load is not None:
            external[self.displacement_dofs[~fixed]] = load[~fixed]
        for _ in range(12):
            displacement = np.where(fixed, prescribed, np.append(x, 0.0)[self.displacement_dofs])
            residual, data = -external, np.zeros(len(pattern.indices))
            for block in self.solid.elements(trial(displacement, x), self.solid.start()):
                slots = pattern.slots[0][block.part]
                scatter(block.matrices, block.residuals, self.solid.dofs[block.part], slots, data, residual)
            if np.linalg.norm(residual) < 1e-12:
                break
            upper = pattern.matrix(data)
            full = (upper + upper.T).tolil()
            full.setdiag(upper.diagonal())
            x -= spsolve(full.tocsc(), residual)
        pressure = np.full(len(self.points), np.nan)
        pressure[self.tets[:, :4]] = x[self.solid.dofs[:, 30:]]
        return np.where(fixed, prescribed, np.append(x, 0.0)[self.displacement_dofs]), pressure


def mixed_body(points: Floats, tets: Ints, law: MediumLaw) -> MixedBody:
    """Number the unknowns of a box whose whole surface is prescribed."""
    low, high = points.min(axis=0), points.max(axis=0)
    free = ((points > low + 1e-12) & (points < high - 1e-12)).all(axis=1)
    dofs = np.full((len(points), 3), -1)
    dofs[free] = np.arange(3 * free.sum()).reshape(-1, 3)
    count = 3 * int(free.sum())
    corners, local = np.unique(tets[:, :4], return_inverse=True)
    element = np.concatenate([dofs[tets].reshape(-1, 30), count + local.reshape(-1, 4)], axis=1)
    solid = solid_region("box", law, points, tets, element)
    return MixedBody(points, tets, solid, dofs, count + len(corners))

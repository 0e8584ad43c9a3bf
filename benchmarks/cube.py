"""The problem that all codes solve: a unit cube of rubber, its base fixed, in a given state of finite strain.

Quadratic displacement, linear continuous pressure, neo-Hookean with nu = 0.495, eight quadrature points of degree 3.
The state is quadratic (displacement) and linear (pressure) in the position, so that every code holds it exactly.
"""

import itertools
from dataclasses import dataclass

import numpy as np

from solve.fem.shape_functions import TET_EDGES

YOUNG, POISSON = 1.0, 0.495
SHEAR = YOUNG / (2.0 * (1.0 + POISSON))
BULK = YOUNG / (3.0 * (1.0 - 2.0 * POISSON))
KUHN = [list(itertools.accumulate((0, *(1 << a for a in axes)))) for axes in itertools.permutations(range(3))]


@dataclass(frozen=True)
class Cube:
    """points (n, 3), tets (m, 10) in VTK's order, dofs (m, 34) with -1 at the base, count of unknowns, corners (c,)."""

    points: np.ndarray
    tets: np.ndarray
    dofs: np.ndarray
    count: int
    corners: np.ndarray

    @property
    def displacement_dofs(self) -> np.ndarray:
        """(n, 3), -1 at the base."""
        free = self.points[:, 2] > 1e-9
        dofs = np.full((len(self.points), 3), -1)
        dofs[free] = np.arange(3 * free.sum()).reshape(-1, 3)
        return dofs


def state(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Displacement (n, 3) and pressure (n,): some 10 % of strain, zero displacement at the base."""
    x, y, z = points.T
    u = np.column_stack([0.08 * z * x, -0.06 * z * y, 0.03 * z * x - 0.05 * z * z])
    return u, 0.1 * x - 0.2 * z


def _linear(cells: int) -> tuple[np.ndarray, np.ndarray]:
    """Corners and positively oriented tets: each little cube in six."""
    grid = np.stack(np.meshgrid(*3 * [np.arange(cells + 1)], indexing="ij"), -1).reshape(-1, 3)
    stride = np.array([(cells + 1) ** 2, cells + 1, 1])
    offset = np.array([stride @ [(k >> a) & 1 for a in range(3)] for k in range(8)])
    cubes = grid[(grid < cells).all(axis=1)] @ stride
    tets = (cubes[:, None, None] + offset[np.array(KUHN)]).reshape(-1, 4)
    corners = grid / cells
    flip = np.linalg.det(corners[tets[:, 1:]] - corners[tets[:, :1]]) < 0
    tets[flip] = tets[flip][:, [0, 1, 3, 2]]
    return corners, tets


def cube(cells: int) -> Cube:
    """A cube of cells^3 little cubes."""
    corners, tets = _linear(cells)
    pairs = np.sort(tets[:, TET_EDGES].reshape(-1, 2), axis=1)
    unique, middle = np.unique(pairs, axis=0, return_inverse=True)
    points = np.vstack([corners, corners[unique].mean(axis=1)])
    tets = np.hstack([tets, len(corners) + middle.reshape(-1, 6)])
    empty = Cube(points, tets, np.zeros((0, 34)), 0, np.arange(len(corners)))
    displacement = empty.displacement_dofs
    first = int(displacement.max()) + 1
    dofs = np.concatenate([displacement[tets].reshape(-1, 30), first + tets[:, :4]], axis=1)
    return Cube(points, tets, dofs, first + len(corners), empty.corners)

"""Layers of tetrahedra with interfaces between them, and Newton's method on the solver's own terms.

Every displacement is numbered, the prescribed ones too, so that reactions are plain residuals.
"""

from dataclasses import dataclass

import numpy as np
from scipy.sparse.linalg import spsolve

from foundation.arrays import Bools, Floats, Ints
from mesh.slice import node_twins
from mesh.types import TetMesh
from softdot.verify.lattice import grid
from solve.fem.assembly import scatter
from solve.fem.pattern import build_pattern
from solve.materials.laws import MediumLaw
from solve.terms.base import Term, Trial
from solve.terms.solid import solid_region

MAX_ITERATIONS = 60  # an interface that peels opens about one node an iteration
ROUND_OFF = 1e-14  # of forces where stresses are about 1
NAMES = ("medium2", "film", "medium1", "effector")


def layers(x, y, heights, jitter: float = 0.0, is_slice: bool = False) -> TetMesh:
    """Layers between lattice coordinates x and y (in any unit), each from its list of z to the next one's first."""
    z = np.concatenate([heights[0][:1], *(h[1:] for h in heights)])
    breaks = np.array([h[0] for h in heights[1:]])

    def flat(points):
        """Interfaces stay plane where the corners are jittered."""
        nearest = breaks[np.abs(points[:, 2:] - breaks).argmin(axis=1)]
        on = np.abs(points[:, 2] - nearest) < 0.5 * np.diff(z).min()
        return np.column_stack([points[:, :2], np.where(on, nearest, points[:, 2])])

    lattice = grid((x, y, z), flat, jitter=jitter)
    region = np.searchsorted(breaks, lattice.centres[:, 2])
    twin = node_twins(lattice.points) if is_slice else np.arange(len(lattice.points))
    facets = {"base": lattice.facets(lambda p: p[:, 2] == z[0]), "top": lattice.facets(lambda p: p[:, 2] == z[-1])}
    return TetMesh(lattice.points, lattice.tets, region, NAMES[: len(heights)], facets, twin, float(np.ptp(y)))


@dataclass
class State:
    """Unknowns (count,), displacement (n, 3), and the residual (count,): what holds the prescribed unknowns."""

    x: Floats
    displacement: Floats
    residual: Floats
    iterations: int


class TermBody:
    """Media of one law each, and any terms between them."""

    def __init__(self, tet_mesh: TetMesh, laws: dict[str, MediumLaw]) -> None:
        self.points = tet_mesh.points_mm
        _, local = np.unique(tet_mesh.twin, return_inverse=True)
        self.dofs = 3 * local.reshape(-1, 1) + np.arange(3)
        self.count = int(self.dofs.max()) + 1
        self.terms: list[Term] = []
        for name, law in laws.items():
            tets = tet_mesh.tets[tet_mesh.region_tets(name)]
            corners, number = np.unique(tet_mesh.twin[tets[:, :4]], return_inverse=True)
            pressure = self.unknowns(len(corners))[number.reshape(-1, 4)]
            dofs = np.hstack([self.dofs[tets].reshape(-1, 30), pressure])
            self.terms.append(solid_region(name, law, self.points, tets, dofs))

    def unknowns(self, count: int) -> Ints:
        """Further unknowns."""
        self.count += count
        return np.arange(self.count - count, self.count)

    def trial(self, x: Floats, before: Floats | None = None, time_step: float = 1.0) -> Trial:
        u = x[self.dofs]
        old = u if before is None else before[self.dofs]
        return Trial(x, u, np.zeros(3), 0.0, old, np.zeros(3), 0.0, 0.0, time_step)

    def force(self, state: State, nodes: Bools) -> Floats:
        """Force (3,) that holds the nodes; twins count once."""
        return state.residual[np.unique(self.dofs[nodes], axis=0)].sum(axis=0)

    def assemble(self, pattern, trial: Trial):
        """Residual, full symmetric tangent and status."""
        residual, data, slots = np.zeros(self.count), np.zeros(len(pattern.indices)), iter(pattern.slots)
        for term in self.terms:
            mine = [next(slots) for _ in term.groups]
            for group, part, ke, re in term.elements(trial, term.start()):
                scatter(ke, re, term.groups[group][part], mine[group][part], data, residual)
        upper = pattern.matrix(data)
        full = (upper + upper.T).tolil()
        full.setdiag(upper.diagonal())
        return residual, full.tocsr(), np.concatenate([term.status(trial, term.start()) for term in self.terms])

    def solve(self, fixed: Bools, prescribed: Floats | float = 0.0, load=0.0, x: Floats | None = None) -> State:
        """Equilibrium near x with displacements prescribed (n, 3) where fixed (n, 3), and nodal forces load (n, 3)."""
        x = np.zeros(self.count) if x is None else x.copy()
        free = np.ones(self.count, bool)
        free[self.dofs[fixed]] = False
        target = np.broadcast_to(prescribed, fixed.shape)[fixed]
        external = np.zeros(self.count)
        np.add.at(external, self.dofs, np.broadcast_to(load, fixed.shape))
        pattern = build_pattern([g for term in self.terms for g in term.groups], self.count)
        before, largest = None, np.linalg.norm(external)
        for iteration in range(MAX_ITERATIONS):
            residual, tangent, status = self.assemble(pattern, self.trial(x))
            change = np.zeros(self.count)
            change[self.dofs[fixed]] = target - x[self.dofs[fixed]]
            rhs = (external - residual - tangent @ change)[free]
            largest = max(largest, np.linalg.norm(rhs))
            settled = before is not None and np.array_equal(before, status)
            if settled and np.linalg.norm(rhs) <= 1e-11 * largest + ROUND_OFF:
                return State(x, x[self.dofs], residual - external, iteration)
            x[free] += spsolve(tangent[free][:, free].tocsc(), rhs)
            x += change
            before = status
        raise ArithmeticError("no equilibrium")


def tangent_error(term: Term, trial_at, x: Floats, step: float = 1e-6) -> float:
    """Largest difference of the element tangents from central differences, relative to the largest entry."""
    count = len(x)

    def gathered(at):
        residual, matrix = np.zeros(count), np.zeros((count, count))
        for group, part, ke, re in term.elements(trial_at(at), term.start()):
            for dofs, k, r in zip(term.groups[group][part], ke, re, strict=True):
                full = np.triu(k) + np.triu(k, 1).T
                here = dofs >= 0
                np.add.at(residual, dofs[here], r[here])
                np.add.at(matrix, np.ix_(dofs[here], dofs[here]), full[np.ix_(here, here)])
        return residual, matrix

    tangent = gathered(x)[1]
    numeric = np.empty_like(tangent)
    for column, change in enumerate(step * np.eye(count)):
        numeric[:, column] = (gathered(x + change)[0] - gathered(x - change)[0]) / (2.0 * step)
    return float(np.abs(tangent - numeric).max() / np.abs(tangent).max())

"""A block on a rigid base, in plane strain along y, under a rigid dot that presses and drags. Newton's method on the
solver's own solid and contact terms, with SciPy's SuperLU.
"""

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from foundation.arrays import Floats, Ints
from geometry.dot import DotShape
from softdot.verify.lattice import Grid
from solve.fem.numbering import Unknowns
from solve.materials.laws import MediumLaw
from solve.terms.base import Term, Trial
from solve.terms.contact import ContactFacets, contact_facets
from solve.terms.friction import FrictionalContact
from solve.terms.rigid_dot import RigidDot
from solve.terms.solid import solid_region

MAX_ITERATIONS, TOLERANCE = 30, 1e-10  # of the contact forces


class DraggedBlock:
    """A block with base at z = 0 under a dot.

    radius : of a cylinder along y, None for a flat plate. level : all nodes of one height move alike. x, u, move :
    unknowns, displacement (n, 3) and that of the dot, as last converged.
    """

    def __init__(self, block: Grid, law: MediumLaw, radius: float | None, friction: float, level: bool = False) -> None:
        points, tets = block.points, block.tets
        top = points[:, 2].max()
        numbers = _numbers(points, level)
        count = int(numbers.max()) + 1
        corners, local = np.unique(tets[:, :4], return_inverse=True)
        pressure = count + local.reshape(-1, 4)
        count += len(corners)
        solid = solid_region("block", law, points, tets, np.hstack([numbers[tets].reshape(-1, 30), pressure]))
        facets = block.facets(lambda p: np.isclose(p[:, 2], top))
        surface = np.unique(facets)
        contact = np.full(len(points), -1)
        contact[surface] = count + (0 if level else np.arange(len(surface)))
        place = np.zeros((1, 3)), np.array([0.0, 0.0, top]), np.eye(3)
        dot = DotShape("plate", 0.0, 0.0, *place) if radius is None else DotShape("ridge", radius, radius, *place)
        none = np.zeros((0, 4), int)
        unknowns = Unknowns(numbers, none, none, contact, -1)
        self.contact = contact_facets(points, facets, unknowns, RigidDot(dot, 1.0))
        self.touch: Term = self.contact
        count = int(contact.max()) + 1
        if friction > 0.0:
            tau = count + np.arange(3 * len(self.contact.pressure_dofs)).reshape(-1, 3)
            self.touch = FrictionalContact(self.contact, tau, friction)
            count += tau.size
        self.terms, self.numbers = (solid, self.touch), numbers
        self.x, self.u, self.move = np.zeros(count), np.zeros_like(points), np.zeros(3)

    @property
    def force(self) -> Floats:
        """Force (3,) of the dot on the block."""
        pressure = self.x[self.contact.pressure_dofs]
        if isinstance(self.touch, ContactFacets):
            return self.contact.force(self.u, self.move, pressure)
        assert isinstance(self.touch, FrictionalContact)
        return self.touch.force(self.u, self.move, pressure, self.x[self.touch.friction_dofs])

    def drag(self, x: float, z: float) -> Floats:
        """Move the dot to (x, z) in one step and return its force (3,) there. ArithmeticError."""
        move, unknown, before = np.array([x, 0.0, z]), self.x.copy(), None
        for _ in range(MAX_ITERATIONS):
            u = np.append(unknown, 0.0)[self.numbers]
            trial = Trial(unknown, u, move, 0.0, self.u, self.move, 0.0, 0.0, 1.0)
            residual, tangent = self._assemble(trial)
            status = self.touch.status(trial, None)
            scale = np.linalg.norm(unknown[self.contact.pressure_dofs] * self.contact.nodal_area)
            if before is not None and np.array_equal(status, before) and np.linalg.norm(residual) < TOLERANCE * scale:
                self.x, self.u, self.move = unknown, u, move
                return self.force
            unknown, before = unknown - splu(tangent).solve(residual), status
        raise ArithmeticError(f"no equilibrium at x = {x:g}, z = {z:g}")

    def _assemble(self, trial: Trial) -> tuple[Floats, sp.csc_matrix]:
        """Residual and tangent of a trial state."""
        count, entries = len(trial.x), []
        residual = np.zeros(count + 1)  # the last one collects what is prescribed
        for term in self.terms:
            for group, part, ke, re in term.elements(trial, term.start()):
                dofs = term.groups[group][part]
                if term.symmetric:
                    ke = np.triu(ke) + np.triu(ke, 1).swapaxes(1, 2)
                np.add.at(residual, dofs, re)
                rows, columns = np.broadcast_arrays(dofs[:, :, None], dofs[:, None, :])
                inside = (rows >= 0) & (columns >= 0)
                entries.append((ke[inside], rows[inside], columns[inside]))
        data, rows, columns = (np.concatenate(e) for e in zip(*entries, strict=True))
        return residual[:count], sp.csc_matrix((data, (rows, columns)), (count, count))


def _numbers(points: Floats, level: bool) -> Ints:
    """Unknowns (n, 3) of the displacements along x and z above the base, -1 for what is held."""
    numbers = np.full(points.shape, -1)
    _, own = np.unique(np.round(points[:, 2], 9), return_inverse=True)
    moving = own > 0
    group = own[moving] - 1 if level else np.arange(moving.sum())
    numbers[np.flatnonzero(moving)[:, None], [0, 2]] = 2 * group[:, None] + [0, 1]
    return numbers

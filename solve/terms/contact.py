"""Frictionless contact with the rigid dot: a contact pressure at every surface node, no penalty number.

Lagrangian L = W - sum_i lambda_i g_i with the weighted gap g_i = int phi_i g(X + u) dA over the undeformed facet.
phi_i is the hat function of node i on the facet cut into four, so that there is one positive pressure for each
surface node: with the corner nodes alone a compressed surface can wrinkle below the size of the elements.
The complementarity lambda_i >= 0, g_i >= 0 is solved by the primal-dual active set, a semismooth Newton method
(Hueeber and Wohlmuth, Comput. Methods Appl. Mech. Eng. 194, 2005; Popp et al., Int. J. Numer. Meth. Eng. 83,
2010). lambda is a nominal pressure, per undeformed area.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from foundation.arrays import Bools, Floats, Ints
from solve.fem.numbering import Unknowns
from solve.fem.quadrature import triangle
from solve.fem.shape_functions import linear, quadratic
from solve.terms.base import Block, History, Term, Trial
from solve.terms.rigid_dot import RigidDot

ACTIVE_SET_STIFFNESS = 10.0  # only steers the active set; the converged answer does not contain it

QUARTERS = ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5))  # a quadratic facet as four linear ones
NODES = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]])


def composite_rule() -> tuple[Floats, Floats, Floats]:
    """Quadrature on the four quarters of a facet: points (q, 2), weights (q,), hat functions (q, 6)."""
    points, weights = triangle()
    hats = np.zeros((4, len(points), 6))
    for quarter, nodes in enumerate(QUARTERS):
        hats[quarter][:, nodes] = linear(points)
    hat = hats.reshape(-1, 6)
    return hat @ NODES, np.tile(weights / 4.0, 4), hat


POINTS, WEIGHTS, HATS = composite_rule()
SHAPES, SLOPES = quadratic(POINTS)


@dataclass(frozen=True)
class ContactFacets(Term):
    """Contact facets with their quadrature, in the solver's unit of length.

    facets : (k, 6) nodes; points : (n, 3) undeformed nodes; area : (k, q) weights;
    dofs : (k, 25) unknowns: 6 x 3 displacements, 6 contact pressures, the dot's approach.
    pressure_dofs : (c,) distinct contact-pressure unknowns, index : (k, 6) into them.
    """

    facets: Ints
    points: Floats
    area: Floats
    dofs: Ints
    pressure_dofs: Ints
    index: Ints
    dot: RigidDot
    is_load = True

    @property
    def groups(self) -> tuple[Ints, ...]:
        """Facets (k, 25) and, for the rows of open nodes, contact pressures (c, 1)."""
        return self.dofs, self.pressure_dofs[:, None]

    @property
    def nodal_area(self) -> Floats:
        """Area int phi_i dA of each node, (c,)."""
        return self._sum(np.einsum("kq,qi->ki", self.area, HATS))

    def _sum(self, local: Floats) -> Floats:
        total: Floats = np.bincount(self.index.ravel(), local.ravel(), len(self.pressure_dofs)).astype(np.float64)
        return total

    def _at_quadrature(self, displacement: Floats, move: Floats) -> tuple[Floats, Floats, Floats]:
        position = (self.points + displacement)[self.facets]
        x = np.einsum("qn,kni->kqi", SHAPES, position)
        gap, normal, hessian = self.dot.distance(x.reshape(-1, 3), move)
        shape = x.shape[:2]
        return gap.reshape(shape), normal.reshape(*shape, 3), hessian.reshape(*shape, 3, 3)

    def weighted_gap(self, displacement: Floats, move: Floats) -> Floats:
        """Weighted gaps g_i (c,) at nodal displacements (n, 3) and the dot displaced by move (3,)."""
        return self._weighted_gaps(self._at_quadrature(displacement, move)[0])

    def _weighted_gaps(self, gap: Floats) -> Floats:
        """Weighted gaps g_i (c,) from the gap (k, q) at the quadrature points."""
        return self._sum(np.einsum("kq,qi,kq->ki", self.area, HATS, gap))

    def mean_gap(self, displacement: Floats, move: Floats) -> Floats:
        """Weighted gap over nodal area: the mean gap around each node (c,)."""
        return self.weighted_gap(displacement, move) / self.nodal_area

    def constraints(self) -> tuple[Ints, Floats]:
        """Contact pressures (c,) and nodal areas (c,)."""
        return self.pressure_dofs, self.nodal_area

    def status(self, trial: Trial, history: History) -> Bools:
        """Nodes in contact (c,)."""
        return self.closed_nodes(trial)

    def touches(self, status: Bools) -> bool:
        """Whether any node is in contact."""
        return bool(status.any())

    def load_norm(self, trial: Trial, forces: Floats) -> float:
        """Norm of the contact forces."""
        return float(np.linalg.norm(forces))

    def dot_force(self, trial: Trial) -> Floats:
        """Resultant (3,) of the contact pressures."""
        return self.force(trial.displacement, trial.move, trial.x[self.pressure_dofs])

    def contact_traction(self, trial: Trial) -> Floats:
        """Traction (c, 3) t_i = int phi_i lambda n dA / int phi_i dA, with n away from the dot: sum t_i int phi_i dA is
        the force.
        """
        lam = np.einsum("qi,ki->kq", HATS, trial.x[self.pressure_dofs][self.index])
        normal = self._at_quadrature(trial.displacement, trial.move)[1]
        force = np.einsum("kq,qi,kq,kqa->kia", self.area, HATS, lam, normal)
        return np.column_stack([self._sum(part) for part in np.moveaxis(force, -1, 0)]) / self.nodal_area[:, None]

    def closed_nodes(self, trial: Trial) -> Bools:
        """Whether each node (c,) is in contact: lambda_i - c g_i > 0."""
        return self._active_nodes(trial, self._at_quadrature(trial.displacement, trial.move)[0])

    def _active_nodes(self, trial: Trial, gap: Floats) -> Bools:
        """Whether each node (c,) is in contact, from the gap (k, q) at the quadrature points."""
        mean_gap = self._weighted_gaps(gap) / self.nodal_area
        return np.asarray(trial.x[self.pressure_dofs] - ACTIVE_SET_STIFFNESS * mean_gap > 0.0)

    def elements(self, trial: Trial, history: History) -> Iterator[Block]:
        """Blocks of the facets, -sum lambda_i g_i over the active nodes, and of the others' rows, -lambda_i = 0."""
        distance = self._at_quadrature(trial.displacement, trial.move)
        return self._blocks(trial, distance, self._active_nodes(trial, distance[0]))

    def elements_in(self, trial: Trial, status: Bools) -> Iterator[Block]:
        """Blocks as of elements, with these nodes (c,) in contact."""
        return self._blocks(trial, self._at_quadrature(trial.displacement, trial.move), status)

    def _blocks(self, trial: Trial, distance: tuple[Floats, Floats, Floats], active: Bools) -> Iterator[Block]:
        pressure = trial.x[self.pressure_dofs]
        near = np.flatnonzero(active[self.index].any(axis=1))  # of the others all is zero
        yield Block(0, near, *self._facets(near, distance, pressure, active))
        closed = np.where(active, 0.0, -1.0)
        yield Block(1, np.arange(len(closed)), closed[:, None, None], (closed * pressure)[:, None])

    def _facets(
        self, near: Ints, distance: tuple[Floats, Floats, Floats], pressure: Floats, active: Bools
    ) -> tuple[Floats, Floats]:
        """Matrices (k, 25, 25) and residuals (k, 25) of some facets; rows of inactive nodes carry no coupling."""
        phi, index, area = HATS, self.index[near], self.area[near]
        gap, normal, hessian = (part[near] for part in distance)
        on = active[index].astype(float)
        lam = np.einsum("qi,ki->kq", phi, np.where(active, pressure, 0.0)[index])
        # generalised direction of each unknown: displacement of node n along i, then the approach along -z
        count, points = len(near), len(phi)
        direction = np.zeros((points, 19, 3))
        direction[:, :18] = np.einsum("qn,ij->qnij", SHAPES, np.eye(3)).reshape(points, 18, 3)
        direction[:, 18, 2] = 1.0  # the dot moves by -z: the gap changes as if the surface moved by +z
        slope = np.matmul(direction, normal[..., None])[..., 0]
        columns = np.r_[0:18, 24]
        ke, re = np.zeros((count, 25, 25)), np.zeros((count, 25))
        bent = np.matmul((area * lam)[..., None, None] * hessian, direction.swapaxes(1, 2))
        curvature = np.matmul(direction.transpose(1, 0, 2).reshape(19, -1), bent.reshape(count, 3 * points, 19))
        ke[:, columns[:, None], columns[None, :]] = -curvature
        coupling = -np.matmul((area[..., None] * slope).swapaxes(1, 2), phi) * on[:, None, :]
        ke[:, columns, 18:24] = coupling
        ke[:, 18:24, 24] = coupling[:, 18, :]
        re[:, columns] = -np.einsum("kq,kqd->kd", area * lam, slope)
        re[:, 18:24] = -np.einsum("kq,qi->ki", area * gap, phi) * on
        return ke, re

    def force(self, displacement: Floats, move: Floats, pressure: Floats) -> Floats:
        """Resultant of the dot on the meshed body, shape (3,), in the solver's units."""
        lam = np.einsum("qi,ki->kq", HATS, pressure[self.index])
        normal = self._at_quadrature(displacement, move)[1]
        resultant: Floats = np.einsum("kq,kq,kqi->i", self.area, lam, normal)
        return resultant


def facet_area(points: Floats, facets: Ints) -> Floats:
    """Area weights (k, q) of quadratic facets (k, 6) under the composite rule."""
    tangents = np.einsum("qna,kni->kqai", SLOPES, points[facets])
    area: Floats = np.linalg.norm(np.cross(tangents[:, :, 0], tangents[:, :, 1]), axis=-1) * WEIGHTS
    return area


def contact_facets(points: Floats, facets: Ints, unknowns: Unknowns, dot: RigidDot) -> ContactFacets:
    """Collect the contact facets (k, 6) of a problem; points (n, 3)."""
    pressure_dofs, index = np.unique(unknowns.contact[facets], return_inverse=True)
    dofs = np.concatenate(
        [
            unknowns.displacement[facets].reshape(-1, 18),
            unknowns.contact[facets],
            np.full((len(facets), 1), unknowns.approach),
        ],
        axis=1,
    )
    return ContactFacets(facets, points, facet_area(points, facets), dofs, pressure_dofs, index.reshape(-1, 6), dot)

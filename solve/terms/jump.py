"""The jump across an interface of matched quadratic facets, and its opening along the deformed normal.

With the mid-surface x_m = X + (u_lower + u_upper) / 2, its tangents t1, t2 and a = t1 x t2,
    d = u_upper - u_lower,    n = a / |a|,    opening = d . n
The opening is a function of z = (d, t1, t2). With p = (d - (d . n) n) / |a|:
    d opening = n . dd + p . da,    da = dt1 x t2 + t1 x dt2
    d2 opening / dd da = (1 - n n) / |a|
    d2 opening / da2 = -(d . n) (1 - n n) / |a|^2 - (p n + n p) / |a|
(Ortiz and Pandolfi, Int. J. Numer. Meth. Eng. 44, 1999, for the mid-surface; the derivatives follow from the chain
rule.) A rigid motion of both faces turns d with n: the opening and |d| do not change.
"""

from dataclasses import dataclass

import numpy as np

from foundation.arrays import Floats, Ints
from solve.fem.shape_functions import quadratic
from solve.terms.jump_kernels import differentiate_opening, integrate_tangent

Rule = tuple[Floats, Floats]  # points (q, 2) and weights (q,) on the reference triangle


@dataclass(frozen=True)
class Jump:
    """Jump at quadrature points: d (k, q, 3), opening (k, q), its derivatives by z (k, q, 9) and (k, q, 9, 9)."""

    d: Floats
    opening: Floats
    slope: Floats
    curvature: Floats


@dataclass(frozen=True)
class MatchedFacets:
    """Two faces of an interface. nodes : (k, n), the 6 lower then the 6 upper, or the 6 above a rigid ground.

    rows : (q, 3, n) so that (d, t1, t2) = rows u, alike for x, y and z; tangents : (k, q, 6) undeformed t1 and t2;
    area : (k, q) undeformed weights; dofs : (k, 3n) unknowns.
    """

    nodes: Ints
    rows: Floats
    tangents: Floats
    area: Floats
    dofs: Ints

    def jump(self, displacement: Floats) -> Jump:
        """The jump at nodal displacements (n, 3)."""
        z = np.matmul(self._stacked_rows, displacement[self.nodes]).reshape(*self.area.shape, 9)
        z[..., 3:] += self.tangents
        value, slope, curvature = np.empty(self.area.size), np.empty((z.size // 9, 9)), np.empty((z.size // 9, 9, 9))
        differentiate_opening(z.reshape(-1, 9), value, slope, curvature)
        shape = self.area.shape
        return Jump(z[..., :3], value.reshape(shape), slope.reshape(*shape, 9), curvature.reshape(*shape, 9, 9))

    @property
    def _stacked_rows(self) -> Floats:
        return self.rows.reshape(-1, self.rows.shape[2])

    def residual(self, gradient: Floats) -> Floats:
        """Residuals int gradient . dz/du (k, 3n) of the derivative by z (k, q, 9) of an energy per undeformed area."""
        return self.coupling(gradient[..., None])[..., 0]

    def coupling(self, columns: Floats) -> Floats:
        """Integrals int (dz/du)^t columns (k, 3n, c) of columns (k, q, 9, c)."""
        count, width = len(self.nodes), columns.shape[-1]
        weighted = (columns * self.area[..., None, None]).reshape(count, -1, 3 * width)
        return np.asarray(np.matmul(self._stacked_rows.T, weighted).reshape(count, -1, width))

    def tangent(self, hessian: Floats) -> Floats:
        """Integrals int (dz/du)^t hessian dz/du, upper triangle (k, 3n, 3n), of the second derivative by z
        (k, q, 9, 9).
        """
        ke = np.empty((*self.dofs.shape, self.dofs.shape[1]))
        integrate_tangent(hessian, self.rows, self.area, ke)
        return ke


def matched_facets(points: Floats, lower: Ints, upper: Ints, displacement_dofs: Ints, rule: Rule) -> MatchedFacets:
    """Prepare an interface: points (n, 3), facets lower and upper (k, 6) with normal up, dofs (n, 3).

    Lower nodes of -1 are the rigid ground: the mid-surface then stays where it is.
    """
    shape, slope = quadratic(rule[0])
    tangents = np.einsum("qna,kni->kqai", slope, points[upper])
    area = np.linalg.norm(np.cross(tangents[:, :, 0], tangents[:, :, 1]), axis=-1) * rule[1]
    ground = bool((lower < 0).all())
    nodes = upper if ground else np.concatenate([lower, upper], axis=1)
    signed = shape if ground else np.concatenate([-shape, shape], axis=1)
    middle = np.zeros_like(slope) if ground else np.tile(0.5 * slope, (1, 2, 1))
    rows = np.ascontiguousarray(np.concatenate([signed[:, None], middle.transpose(0, 2, 1)], axis=1))
    dofs = np.ascontiguousarray(displacement_dofs[nodes].reshape(len(nodes), -1))
    return MatchedFacets(nodes, rows, tangents.reshape(*area.shape, 6), area, dofs)

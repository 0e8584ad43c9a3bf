"""The jump across an interface of matched quadratic facets, and its opening along the deformed normal.

With the mid-surface x_m = X + (u_lower + u_upper) / 2, its tangents t1, t2 and a = t1 x t2,
    d = u_upper - u_lower,    n = a / |a|,    opening = d . n
The opening is a function of z = (d, t1, t2). With p = (d - (d . n) n) / |a|:
    d opening = n . dd + p . da,    da = dt1 x t2 + t1 x dt2
    d2 opening / dd da = (1 - n n) / |a|
    d2 opening / da2 = -(d . n) (1 - n n) / |a|^2 - (p n + n p) / |a|
(Ortiz and Pandolfi, Int. J. Numer. Meth. Eng. 44, 1999, for the mid-surface; the derivatives follow from the chain
rule.) A rigid motion of both faces turns d with n: the opening and |d| do not change.

Compiled loops over the quadrature points of an interface; the formulae are those of solve.terms.jump.

A delaminated patch: two faces that may part but neither pass through each other nor stick.

Lagrangian -sum lambda_i g_i with the weighted opening g_i = int phi_i d . n dA over the undeformed facets
(solve.terms.jump; points stay matched, so slip along the faces is small against the facets). phi_i is the hat function
of the facet cut into four, and the complementarity lambda_i >= 0, g_i >= 0 is solved by the primal-dual active set
(solve.terms.contact).
Where the faces join, at the rim, no pressure is needed: the hats there are given to the other nodes of their facet,
so that the phi_i still add up to one and an even pressure is held exactly (as at crosspoints of mortar methods:
Wohlmuth, Discretization Methods and Iterative Solvers Based on Domain Decomposition, 2001).
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from geometry.arrays import Bools, Floats, Ints
from solve.compiled import in_threads
from solve.fem.shape_functions import quadratic
from solve.terms.base import Block, History, Term, Trial
from solve.terms.contact import ACTIVE_SET_STIFFNESS, HATS, POINTS, WEIGHTS


@in_threads()
def differentiate_opening(start, stop, z, value, slope, curvature):  # type: ignore[no-untyped-def]
    """Opening (p,), its slope (p, 9) and curvature (p, 9, 9) by z = (d, t1, t2) (p, 9); all are overwritten."""
    a, n, p = np.empty(3), np.empty(3), np.empty(3)
    by_tangents, product = np.empty((3, 6)), np.empty((3, 6))
    across, by_area = np.empty((3, 3)), np.empty((3, 3))
    for point in range(start, stop):
        d, t1, t2 = z[point, :3], z[point, 3:6], z[point, 6:]
        delta = 0.0
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            a[i] = t1[j] * t2[k] - t1[k] * t2[j]
            for b in range(6):
                by_tangents[i, b] = 0.0
            by_tangents[i, j], by_tangents[i, k] = t2[k], -t2[j]  # -t2 x
            by_tangents[i, 3 + j], by_tangents[i, 3 + k] = -t1[k], t1[j]  # t1 x
        size = np.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])
        for i in range(3):
            n[i] = a[i] / size
            delta += d[i] * n[i]
        value[point] = delta
        for i in range(3):
            p[i] = (d[i] - delta * n[i]) / size
        for i in range(3):
            for j in range(3):
                across[i, j] = ((1.0 if i == j else 0.0) - n[i] * n[j]) / size
                by_area[i, j] = -(delta * across[i, j] + p[i] * n[j] + n[i] * p[j]) / size
        c, s = curvature[point], slope[point]
        for i in range(3):
            s[i] = n[i]
            for j in range(3):
                c[i, j] = 0.0
            for b in range(6):
                c[i, 3 + b] = product[i, b] = 0.0
                for k in range(3):
                    c[i, 3 + b] += across[i, k] * by_tangents[k, b]
                    product[i, b] += by_area[i, k] * by_tangents[k, b]
                c[3 + b, i] = c[i, 3 + b]
        for b in range(6):
            s[3 + b] = 0.0
            for k in range(3):
                s[3 + b] += p[k] * by_tangents[k, b]
            for e in range(6):
                c[3 + b, 3 + e] = 0.0
                for k in range(3):
                    c[3 + b, 3 + e] += by_tangents[k, b] * product[k, e]
        for i in range(3):  # p . (dt1 x dt2)
            j, k = (i + 1) % 3, (i + 2) % 3
            c[3 + j, 6 + k] += p[i]
            c[3 + k, 6 + j] -= p[i]
            c[6 + k, 3 + j] += p[i]
            c[6 + j, 3 + k] -= p[i]


@in_threads()
def integrate_tangent(start, stop, hessian, rows, area, ke):  # type: ignore[no-untyped-def]
    """ke (k, 3n, 3n), upper triangle: sum over q of area (k, q) times rows (q, 3, n) on both sides of (k, q, 9, 9)."""
    count = rows.shape[2]
    half = np.empty((9, 3 * count))
    for e in range(start, stop):
        ke[e] = 0.0
        for q in range(rows.shape[0]):
            for i in range(9):
                for b in range(count):
                    for j in range(3):
                        x = 0.0
                        for r in range(3):
                            x += hessian[e, q, i, 3 * r + j] * rows[q, r, b]
                        half[i, 3 * b + j] = area[e, q] * x
            for b in range(count):
                for i in range(3):
                    for r in range(3):
                        factor = rows[q, r, b]
                        for j in range(3 * b, 3 * count):
                            ke[e, 3 * b + i, j] += factor * half[3 * r + i, j]


Rule = tuple[Floats, Floats]  # points (q, 2) and weights (q,) on the reference triangle


@dataclass(frozen=True)
class Jump:
    """At quadrature points: d (k, q, 3), opening (k, q), its derivatives by z (k, q, 9) and (k, q, 9, 9)."""

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
        z = np.matmul(self._stacked, displacement[self.nodes]).reshape(*self.area.shape, 9)
        z[..., 3:] += self.tangents
        value, slope, curvature = np.empty(self.area.size), np.empty((z.size // 9, 9)), np.empty((z.size // 9, 9, 9))
        differentiate_opening(z.reshape(-1, 9), value, slope, curvature)
        shape = self.area.shape
        return Jump(z[..., :3], value.reshape(shape), slope.reshape(*shape, 9), curvature.reshape(*shape, 9, 9))

    @property
    def _stacked(self) -> Floats:
        return self.rows.reshape(-1, self.rows.shape[2])

    def residual(self, gradient: Floats) -> Floats:
        """int gradient . dz/du, shape (k, 3n), of the derivative by z (k, q, 9) of an energy per undeformed area."""
        return self.coupling(gradient[..., None])[..., 0]

    def coupling(self, columns: Floats) -> Floats:
        """int (dz/du)^t columns, shape (k, 3n, c), of columns (k, q, 9, c)."""
        count, width = len(self.nodes), columns.shape[-1]
        weighted = (columns * self.area[..., None, None]).reshape(count, -1, 3 * width)
        return np.asarray(np.matmul(self._stacked.T, weighted).reshape(count, -1, width))

    def tangent(self, hessian: Floats) -> Floats:
        """int (dz/du)^t hessian dz/du, upper triangle (k, 3n, 3n), of the second derivative by z (k, q, 9, 9)."""
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


ADHESION = 1e-12  # tension, in solver units, that faces at rest may carry: round-off must not open and close them


@dataclass(frozen=True)
class UnilateralInterface(Term):
    """facets : (k, .) ; hats : (k, q, 6) functions phi_i; index : (k, 6) into multipliers (c,), -1 at the rim."""

    facets: MatchedFacets
    hats: Floats
    index: Ints
    multipliers: Ints

    @property
    def groups(self) -> tuple[Ints, ...]:
        """Facets: displacements, then six pressures. Nodes: each pressure alone, for its row where open."""
        pressures = np.append(self.multipliers, -1)[self.index]
        return np.concatenate([self.facets.dofs, pressures], axis=1), self.multipliers[:, None]

    @property
    def nodal_area(self) -> Floats:
        """int phi_i dA, shape (c,)."""
        return self._sum(np.einsum("kq,kqi->ki", self.facets.area, self.hats))

    def _sum(self, local: Floats) -> Floats:
        """Sum over facets (k, 6), shape (c,)."""
        counted = self.index >= 0
        total = np.bincount(self.index[counted], local[counted], len(self.multipliers))
        return np.asarray(total, dtype=np.float64)

    def weighted_opening(self, displacement: Floats) -> Floats:
        """g_i, shape (c,), at nodal displacements (n, 3)."""
        return self._weighted(self.facets.jump(displacement).opening)

    def _weighted(self, opening: Floats) -> Floats:
        """int phi_i opening dA, shape (c,), of an opening (k, q)."""
        return self._sum(np.einsum("kqi,kq->ki", self.hats, self.facets.area * opening))

    def constraints(self) -> tuple[Ints, Floats]:
        """The pressures."""
        return self.multipliers, self.nodal_area

    def status(self, trial: Trial, history: History) -> Bools:
        """Closed nodes (c,): lambda_i - c g_i >= 0. The faces touch at rest."""
        return self._closed(trial, self.weighted_opening(trial.displacement))

    def _closed(self, trial: Trial, gap: Floats) -> Bools:
        return np.asarray(trial.x[self.multipliers] - ACTIVE_SET_STIFFNESS * gap / self.nodal_area >= -ADHESION)

    def elements(self, trial: Trial, history: History) -> Iterator[Block]:
        """Facets: -sum lambda_i g_i over closed nodes. Nodes: -lambda_i^2 / 2 over open ones."""
        return self._blocks(trial, self.status(trial, history))

    def elements_in(self, trial: Trial, status: Bools) -> Iterator[Block]:
        """As elements, with these nodes closed."""
        return self._blocks(trial, status)

    def _blocks(self, trial: Trial, closed: Bools) -> Iterator[Block]:
        jump, width, pressure = (
            self.facets.jump(trial.displacement),
            self.facets.dofs.shape[1],
            trial.x[self.multipliers],
        )
        hats = self.hats * np.append(closed, False)[self.index][:, None, :]
        at = np.einsum("kqi,ki->kq", hats, np.append(pressure, 0.0)[self.index])
        matrices = np.zeros((len(hats), width + 6, width + 6))
        residuals = np.empty((len(hats), width + 6))
        matrices[:, :width, :width] = -self.facets.tangent(at[..., None, None] * jump.curvature)
        matrices[:, :width, width:] = -self.facets.coupling(jump.slope[..., None] * hats[:, :, None, :])
        residuals[:, :width] = -self.facets.residual(at[..., None] * jump.slope)
        residuals[:, width:] = -np.einsum("kqi,kq->ki", hats, self.facets.area * jump.opening)
        yield Block(0, slice(0, len(hats)), matrices, residuals)
        opened = np.where(closed, 0.0, -1.0)[:, None]
        yield Block(1, slice(0, len(closed)), opened[:, :, None], opened * pressure[:, None])


def opening_nodes(lower: Ints, upper: Ints, displacement_dofs: Ints) -> tuple[Ints, int]:
    """Which pressure belongs to each facet node, (k, 6), -1 where the faces cannot part; and how many there are.

    Nodes cannot part at the rim, nor where both faces are held. Twins of a plane-strain slice share a pressure.
    lower -1 is the ground.
    """
    dofs = np.concatenate([displacement_dofs, np.full((1, 3), -1)])
    below, above = dofs[lower], dofs[upper]
    parting = (below != above).any(axis=-1)
    own = np.maximum(below, above).max(axis=-1)
    distinct, number = np.unique(own[parting], return_inverse=True)
    index = np.full(lower.shape, -1)
    index[parting] = number.ravel()
    return index, len(distinct)


def unilateral_interface(
    points: Floats, lower: Ints, upper: Ints, displacement_dofs: Ints, multipliers: Ints
) -> UnilateralInterface:
    """Delaminate the facets lower and upper (k, 6) of mesh.interfaces.split_interface.

    points (n, 3) in the solver's units; multipliers (c,) unknowns of the pressures, c from opening_nodes.
    """
    facets = matched_facets(points, lower, upper, displacement_dofs, (POINTS, WEIGHTS))
    index, _ = opening_nodes(lower, upper, displacement_dofs)
    return UnilateralInterface(facets, _hats(index >= 0), index, multipliers)


def _hats(parting: Bools) -> Floats:
    """Hat functions (k, q, 6) of the parting nodes (k, 6), those of the others spread evenly over them."""
    share = parting / np.maximum(parting.sum(axis=1, keepdims=True), 1)
    spread = np.where(parting[:, :, None], np.eye(6), share[:, None, :])
    return np.asarray(np.matmul(HATS, spread))

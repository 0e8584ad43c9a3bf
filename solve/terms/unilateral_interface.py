"""A delaminated patch: two faces that may part but neither pass through each other nor stick.

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

from foundation.arrays import Bools, Floats, Ints
from solve.terms.base import Block, History, Term, Trial
from solve.terms.contact import ACTIVE_SET_STIFFNESS, HATS, POINTS, WEIGHTS
from solve.terms.jump import MatchedFacets, matched_facets

ADHESION = 1e-12  # tension, in solver units, that faces at rest may carry: round-off must not open and close them


@dataclass(frozen=True)
class UnilateralInterface(Term):
    """Two faces that may part. facets : (k, .) ; hats : (k, q, 6) functions phi_i; index : (k, 6) into multipliers
    (c,), -1 at the rim.
    """

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
        """Area int phi_i dA of each node, (c,)."""
        return self._sum(np.einsum("kq,kqi->ki", self.facets.area, self.hats))

    def _sum(self, local: Floats) -> Floats:
        """Sum over facets (k, 6), shape (c,)."""
        counted = self.index >= 0
        total = np.bincount(self.index[counted], local[counted], len(self.multipliers))
        return np.asarray(total, dtype=np.float64)

    def weighted_opening(self, displacement: Floats) -> Floats:
        """Weighted openings g_i (c,) at nodal displacements (n, 3)."""
        return self._weighted_openings(self.facets.jump(displacement).opening)

    def _weighted_openings(self, opening: Floats) -> Floats:
        """Weighted openings int phi_i opening dA (c,) of an opening (k, q)."""
        return self._sum(np.einsum("kqi,kq->ki", self.hats, self.facets.area * opening))

    def constraints(self) -> tuple[Ints, Floats]:
        """Pressures (c,) and nodal areas (c,)."""
        return self.multipliers, self.nodal_area

    def status(self, trial: Trial, history: History) -> Bools:
        """Whether each node (c,) is closed: lambda_i - c g_i >= 0. The faces touch at rest."""
        return self._closed_nodes(trial, self.weighted_opening(trial.displacement))

    def _closed_nodes(self, trial: Trial, gap: Floats) -> Bools:
        """Whether each node (c,) is closed, from the weighted openings (c,)."""
        return np.asarray(trial.x[self.multipliers] - ACTIVE_SET_STIFFNESS * gap / self.nodal_area >= -ADHESION)

    def elements(self, trial: Trial, history: History) -> Iterator[Block]:
        """Blocks of the facets, -sum lambda_i g_i over closed nodes, and of the nodes, -lambda_i^2 / 2 over
        open ones.
        """
        return self._blocks(trial, self.status(trial, history))

    def elements_in(self, trial: Trial, status: Bools) -> Iterator[Block]:
        """Blocks as of elements, with these nodes (c,) closed."""
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

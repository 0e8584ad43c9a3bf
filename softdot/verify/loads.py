"""Loads on facets: dead tractions and a pressure that follows the surface."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from foundation.arrays import Floats, Ints
from solve.terms.base import Block, History, Term, Trial
from solve.terms.contact import SHAPES, SLOPES, WEIGHTS


@dataclass
class FollowerPressure(Term):
    """Pressure on facets (k, 6), along the normal of the deformed surface: r = p int N n da.

    Its tangent is the symmetric part, which is the whole where the facets' edge slides on planes of symmetry, since the
    load then has a potential (Wriggers, Nonlinear Finite Element Methods, 2008, sec. 4.2.5).
    """

    points: Floats
    facets: Ints
    dofs: Ints
    value: float = 0.0

    @property
    def groups(self) -> tuple[Ints, ...]:
        """Numbers of the unknowns of the facets."""
        return (self.dofs,)

    def elements(self, trial: Trial, history: History) -> Iterator[Block]:
        """Matrices and residuals of the facets as one block."""
        position = (self.points + trial.displacement)[self.facets]
        a, b = np.einsum("qnd,kni->dkqi", SLOPES, position)
        re = self.value * np.einsum("q,qn,kqi->kni", WEIGHTS, SHAPES, np.cross(a, b)).reshape(-1, 18)
        skew_a, skew_b = (np.cross(v[..., None, :], np.eye(3)) for v in (a, b))  # row j: v x e_j
        slope = np.einsum("qm,kqji->kqmij", SLOPES[..., 1], skew_a)
        slope -= np.einsum("qm,kqji->kqmij", SLOPES[..., 0], skew_b)
        ke = self.value * np.einsum("q,qn,kqmij->knimj", WEIGHTS, SHAPES, slope).reshape(-1, 18, 18)
        yield Block(0, slice(None), 0.5 * (ke + ke.swapaxes(1, 2)), re)


def traction_force(points: Floats, facets: Ints, traction: ArrayLike) -> Floats:
    """Nodal forces (n, 3) of a dead traction (3,), or (k, q, 3) at the quadrature points, on facets (k, 6)."""
    tangent = np.einsum("qnd,kni->dkqi", SLOPES, points[facets])
    area = np.linalg.norm(np.cross(*tangent), axis=-1) * WEIGHTS
    force = np.zeros_like(points)
    value = np.broadcast_to(traction, (*area.shape, 3))
    np.add.at(force, facets, np.einsum("kq,qn,kqi->kni", area, SHAPES, value))
    return force

"""Elastic sides: the case as springs, normal and tangential, per undeformed area of the held faces."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from foundation.arrays import Floats, Ints
from solve.terms.base import Block, History, Term, Trial
from solve.terms.contact import SHAPES, facet_area


@dataclass(frozen=True)
class SideSprings(Term):
    """Traction -k u on facets. dofs : (k, 18); matrices : (k, 18, 18) constant."""

    facets: Ints
    dofs: Ints
    matrices: Floats

    @property
    def groups(self) -> tuple[Ints, ...]:
        """Unknowns of the facets."""
        return (self.dofs,)

    def elements(self, trial: Trial, history: History) -> Iterator[Block]:
        """The constant matrices and their residuals (k, 18)."""
        local = trial.displacement[self.facets].reshape(-1, 18)
        yield Block(0, slice(0, len(local)), self.matrices, np.einsum("kij,kj->ki", self.matrices, local))


def side_springs(points: Floats, facets: Ints, displacement_dofs: Ints, stiffness: float) -> SideSprings:
    """Springs of a stiffness (traction per displacement, the solver's units) on facets (k, 6)."""
    mass = stiffness * np.einsum("kq,qn,qm->knm", facet_area(points, facets), SHAPES, SHAPES)
    matrices = np.einsum("knm,ij->knimj", mass, np.eye(3)).reshape(-1, 18, 18)
    return SideSprings(facets, displacement_dofs[facets].reshape(-1, 18), matrices)

"""Any body of mixed quadratic tetrahedra under prescribed displacements, dead loads and a follower pressure.

Newton's method on the solver's own terms, pattern, scatter and linear solver; only the boundary conditions are
separate. All unknowns are numbered, the prescribed ones too, so that reactions are plain residuals.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_matrix

from foundation.arrays import Bools, Floats, Ints
from softdot.verify.loads import FollowerPressure
from solve.fem.assembly import scatter
from solve.fem.numbering import Unknowns
from solve.fem.pattern import Pattern, build_pattern
from solve.fem.tangent import Tangent
from solve.materials.laws import MediumLaw
from solve.solution.linear import LinearSolver
from solve.terms.base import Term, Trial
from solve.terms.contact import ContactFacets, contact_facets
from solve.terms.rigid_dot import RigidDot
from solve.terms.solid import solid_region

FREE = np.nan
"""Marks a displacement that is not prescribed."""
MAX_ITERATIONS = 60  # an interface that peels opens about one node an iteration


@dataclass
class ElasticBody:
    """A body of points (n, 3) and terms.

    displacement (n, 3) : numbers of its unknowns. pressure : for each region (m, 4) numbers of the nodal pressures of
    its tetrahedra. x (count,) : the state.
    """

    points: Floats
    displacement: Ints
    count: int
    terms: list[Term] = field(default_factory=list)
    pressure: list[Ints] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.x, self.residual, self.move = np.zeros(self.count), np.zeros(self.count), np.zeros(3)

    @property
    def u(self) -> Floats:
        """Displacement (n, 3) of the points."""
        return self.x[self.displacement]

    @property
    def trial(self) -> Trial:
        """The state in the form that terms take, without a history."""
        return Trial(self.x, self.u, self.move, 0.0, self.u, self.move, 0.0, 0.0, 1.0)

    def add_unknowns(self, count: int) -> Ints:
        """Add unknowns to the body and return their numbers (count,)."""
        self.count += count
        self.x, self.residual = np.zeros(self.count), np.zeros(self.count)
        return np.arange(self.count - count, self.count)

    def add_region(self, name: str, law: MediumLaw, tets: Ints, twin: Ints | None = None) -> None:
        """Add a medium of tets (m, 10), with its own pressures unless its law is compressible."""
        dofs = self.displacement[tets].reshape(-1, 30)
        if not law.compressible:
            corners, local = np.unique((tets if twin is None else twin[tets])[:, :4], return_inverse=True)
            self.pressure.append(self.add_unknowns(len(corners))[local.reshape(-1, 4)])
            dofs = np.hstack([dofs, self.pressure[-1]])
        self.terms.append(solid_region(name, law, self.points, tets, dofs))

    def add_pressure(self, facets: Ints) -> FollowerPressure:
        """Add a follower pressure on facets (k, 6), zero until its value is set."""
        load = FollowerPressure(self.points, facets, self.displacement[facets].reshape(-1, 18))
        self.terms.append(load)
        return load

    def add_contact(self, facets: Ints, dot: RigidDot) -> ContactFacets:
        """Add frictionless contact of facets (k, 6) with a dot, which move displaces."""
        nodes = np.unique(self.displacement[facets, 0], return_inverse=True)[1].reshape(facets.shape)
        contact = np.full(len(self.points), -1)
        contact[facets] = self.add_unknowns(int(nodes.max()) + 1)[nodes]
        none = np.zeros((0, 4), int)
        term = contact_facets(self.points, facets, Unknowns(self.displacement, none, none, contact, -1), dot)
        self.terms.append(term)
        return term

    def reaction(self, nodes: Ints) -> Floats:
        """Force (3,) that holds the nodes together."""
        return np.asarray(self.residual[np.unique(self.displacement[nodes], axis=0)].sum(axis=0))

    def reactions(self) -> Floats:
        """Forces (n, 3) that hold each node; twins, which share unknowns, all show the same force."""
        return self.residual[self.displacement]

    def free_displacements(self) -> Floats:
        """Prescribed displacements (n, 3) with every one free."""
        return np.full(self.points.shape, FREE)

    def solve(
        self,
        prescribed: Floats,
        force: Floats | float = 0.0,
        steps: int = 1,
        held: Mapping[int, float] | None = None,
        move: ArrayLike | None = None,
        tolerance: float = 1e-10,
    ) -> None:
        """Move from the present state to prescribed (n, 3), NaN where free, and dead nodal forces (n, 3).

        move : (3,) displacement of the dot. held : {unknown: value} of any other unknown. tolerance : residual over
        reactions and loads. ArithmeticError where Newton does not converge.
        """
        target = np.full(self.count, FREE)
        target[self.displacement] = prescribed
        for unknown, value in (held or {}).items():
            target[unknown] = value
        external = np.zeros(self.count)
        np.add.at(external, self.displacement, np.broadcast_to(force, self.points.shape))
        pattern = build_pattern([g for term in self.terms for g in term.groups], self.count)
        fixed, start = ~np.isnan(target), self.x.copy()
        linear = LinearSolver(self._contact_shift()[~fixed])
        loads = [term for term in self.terms if isinstance(term, FollowerPressure)]
        full = [term.value for term in loads]
        first, last = self.move, self.move if move is None else np.asarray(move)
        for fraction in np.arange(1, steps + 1) / steps:
            for term, value in zip(loads, full, strict=True):
                term.value = fraction * value
            self.move = first + fraction * (last - first)
            aim = np.where(fixed, start + fraction * (target - start), 0.0)
            self._newton(pattern, linear, fixed, aim, fraction * external, tolerance)
        linear.close()

    def _contact_shift(self) -> Floats:
        """Diagonal of the contact rows for the factorisation only, as in solve.system."""
        shift = np.zeros(self.count)
        for term in self.terms:
            if isinstance(term, ContactFacets):
                shift[term.pressure_dofs] = -1e-4 * term.nodal_area
        return shift

    def assemble(self, pattern: Pattern, external: Floats) -> tuple[Floats, csr_matrix]:
        """Residual and tangent (upper triangle) with all unknowns free."""
        residual, data, first = -external, np.zeros(len(pattern.indices)), 0
        for term in self.terms:
            for group, part, ke, re in term.elements(self.trial, term.start()):
                scatter(ke, re, term.groups[group][part], pattern.slots[first + group][part], data, residual)
            first += len(term.groups)
        return residual, pattern.matrix(data)

    def _newton(
        self, pattern: Pattern, linear: LinearSolver, fixed: Bools, aim: Floats, external: Floats, tolerance: float
    ) -> None:
        """Solve for one load step. ArithmeticError."""
        change, before = np.where(fixed, aim - self.x, 0.0), None
        for _ in range(MAX_ITERATIONS):
            self.residual, tangent = self.assemble(pattern, external)
            status = np.concatenate([term.status(self.trial, term.start()) for term in self.terms])
            settled = not change.any() and (before is None or np.array_equal(status, before))
            scale = np.linalg.norm(self.residual[fixed]) + np.linalg.norm(external)
            if settled and np.linalg.norm(self.residual[~fixed]) <= tolerance * scale:
                return
            rhs = (self.residual + Tangent(tangent) @ change)[~fixed]
            self.x[~fixed] -= linear.solve(Tangent(tangent[~fixed][:, ~fixed].sorted_indices()), rhs, 1e-6)
            self.x[fixed], before = aim[fixed], status
            change[:] = 0.0
        raise ArithmeticError(f"no equilibrium: residual {np.linalg.norm(self.residual[~fixed]) / scale:.1e}")


def solid_body(points: Floats, law: MediumLaw, tets: Ints, twin: Ints | None = None) -> ElasticBody:
    """A body of one medium. twin (n,) : the node whose displacement each node shares."""
    _, local = np.unique(np.arange(len(points)) if twin is None else twin, return_inverse=True)
    numbers = 3 * local.reshape(-1, 1) + np.arange(3)
    body = ElasticBody(points, numbers, int(numbers.max()) + 1)
    body.add_region("body", law, tets, twin)
    return body

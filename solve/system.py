"""The discrete problem: residual and symmetric tangent of everything that acts on the segment.

Unknowns live in one vector; all are in units of a length (the segment's) and a stress (the stiffest medium's shear
modulus), so that the answer and the iterations do not depend on metres or millimetres.
"""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from mesh.types import Bools, Floats
from solve.contact import ContactFacets
from solve.element_kernels import scatter
from solve.film import FilmRegion
from solve.sides import SideSprings
from solve.solid import SolidRegion
from solve.sparsity import Pattern
from solve.unknowns import Unknowns

ACTIVE_SET_STIFFNESS = 10.0  # only steers the active set; the converged answer does not contain it

CONTACT_SPRING = 1e4  # only steers the preconditioner of the linear solver


@dataclass(frozen=True)
class Units:
    """One solver unit of length in m, of stress in Pa and of voltage in V."""

    length: float
    stress: float
    voltage: float

    @property
    def force(self) -> float:
        """N."""
        return self.stress * self.length**2


@dataclass(frozen=True)
class Load:
    """What the rig prescribes, in solver units: lateral position of the dot, and its approach or its force."""

    lateral: tuple[float, float]
    approach: float = 0.0
    force: float | None = None


@dataclass(frozen=True)
class Evaluation:
    """Residual (count,), tangent (upper triangle), norm of the contact forces, active contact nodes."""

    residual: Floats
    tangent: sp.csr_matrix
    load_norm: float
    active: Bools


@dataclass(frozen=True)
class System:
    """All parts of the problem; points in solver units."""

    points: Floats
    unknowns: Unknowns
    units: Units
    solids: tuple[SolidRegion, ...]
    film: FilmRegion
    sides: tuple[SideSprings, ...]
    contact: ContactFacets
    pattern: Pattern

    def displacement(self, x: Floats) -> Floats:
        """Nodal displacements (n, 3) of an unknown vector (count,)."""
        return self._with_zero(x)[self.unknowns.displacement]

    def voltage(self, x: Floats) -> Floats:
        """Electrode voltages (e,) that act back on the film; zero when the coupling is one-way."""
        return self._with_zero(x)[self.unknowns.voltage]

    def move(self, x: Floats, load: Load) -> Floats:
        """Displacement of the dot (3,)."""
        approach = load.approach if self.unknowns.approach < 0 else x[self.unknowns.approach]
        return np.array([*load.lateral, -approach])

    @property
    def factorisation_shift(self) -> Floats:
        """Diagonal of the contact rows for the factorisation only: a stiff spring instead of a constraint."""
        shift = np.zeros(self.unknowns.count)
        shift[self.contact.pressure_dofs] = -self.contact.nodal_area / CONTACT_SPRING
        return shift

    @staticmethod
    def _with_zero(x: Floats) -> Floats:
        return np.append(x, 0.0)  # index -1, a prescribed value, reads zero

    def active_nodes(self, x: Floats, load: Load) -> Bools:
        """Nodes in contact: lambda_i - c g_i > 0, shape (c,) bool."""
        gap = self.contact.weighted_gap(self.displacement(x), self.move(x, load)) / self.contact.nodal_area
        return np.asarray(x[self.contact.pressure_dofs] - ACTIVE_SET_STIFFNESS * gap > 0.0)

    def evaluate(self, x: Floats, load: Load) -> Evaluation:
        """Residual and tangent at x; pressures of open nodes in x are set to zero. InvertedElementError."""
        active = self.active_nodes(x, load)
        pressure_dofs = self.contact.pressure_dofs
        x[pressure_dofs[~active]] = 0.0
        displacement = self.displacement(x)
        residual = np.zeros(len(x))
        data = np.zeros(len(self.pattern.indices))
        slots = iter(self.pattern.slots)

        for solid in self.solids:
            slot = next(slots)
            for part, ke, re in solid.elements(displacement, x):
                scatter(ke, re, solid.dofs[part], slot[part], data, residual)
        ke, re = self.film.elements(displacement, self.voltage(x))
        scatter(ke, re, self.film.dofs, next(slots), data, residual)
        for side in self.sides:
            ke, re = side.elements(displacement)
            scatter(ke, re, side.dofs, next(slots), data, residual)

        internal = residual.copy()
        ke, re = self.contact.elements(displacement, self.move(x, load), x[pressure_dofs], active)
        scatter(ke, re, self.contact.dofs, next(slots), data, residual)
        data[self.pattern.diagonal[pressure_dofs[~active]]] = -1.0
        mechanical = np.arange(len(x)) <= self.unknowns.displacement.max()
        load_norm = float(np.linalg.norm((residual - internal)[mechanical]))
        if self.unknowns.approach >= 0:
            residual[self.unknowns.approach] -= load.force or 0.0
        return Evaluation(residual, self.pattern.matrix(data), load_norm, active)

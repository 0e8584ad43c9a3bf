"""The piezoelectric film: quadratic tetrahedra of its true thickness, charge collected by electrodes."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from foundation.arrays import Floats, Ints
from solve.fem.film_solid import film_solid
from solve.fem.kinematics import deformation_gradient, green_lagrange
from solve.fem.quadrature import tetrahedron
from solve.fem.shape_functions import physical_gradients, quadratic
from solve.materials.film import FilmLaw
from solve.materials.inelastic import Inelastic, StressResponse, respond, rest_memories, time_error
from solve.terms.base import Block, History, Term, Trial
from solve.terms.electrodes import Coverage, coverage, electrode_over, electrode_pieces
from solve.terms.solid import refuse_inversion


@dataclass(frozen=True)
class FilmRegion(Term):
    """The film in the solver's units.

    tets : (m, 10); dofs : (m, 31) displacements and the voltage (-1 when it does not act back);
    electrode : (m,) index of the electrode over the element, -1 for bare film; electrodes : their number.
    coverage : what each electrode collects, also of elements that its edges cut.
    voltage_dofs : (e,); thickness : undeformed; prestrain : (6,) Green-Lagrange, engineering shears.
    inelastic : laws with memory that act on the stress.
    """

    law: FilmLaw
    tets: Ints
    dofs: Ints
    gradient: Floats
    weight: Floats
    electrode: Ints
    coverage: Coverage
    voltage_dofs: Ints
    thickness: float
    prestrain: Floats
    inelastic: tuple[Inelastic, ...] = ()

    @property
    def groups(self) -> tuple[Ints, ...]:
        """Unknowns of the elements."""
        return (self.dofs,)

    @property
    def electrodes(self) -> int:
        """Number of the electrodes."""
        return len(self.voltage_dofs)

    def start(self) -> History:
        """Memory of every inelastic law at rest."""
        return rest_memories(self.inelastic, self.weight.size)

    def elements(self, trial: Trial, history: History) -> Iterator[Block]:
        """Element matrices (m, 31, 31), upper triangle, and residuals (m, 31)."""
        f = deformation_gradient(self.gradient, trial.displacement[self.tets])
        refuse_inversion(f, "film", self.tets)
        response = self._respond(trial, history)[0]
        points = self.weight.shape
        charge = response.stress @ self.law.coupling + self.law.permittivity * self._field(trial).ravel()
        ke, re = np.empty((len(f), 31, 31)), np.empty((len(f), 31))
        film_solid(
            self.gradient,
            self.weight,
            f,
            response.stress.reshape(*points, 6),
            np.ascontiguousarray(response.tangent).reshape(*points, 6, 6),
            charge.reshape(points),
            self.law.coupling,
            self.law.permittivity,
            -1.0 / self.thickness,
            ke,
            re,
        )
        yield Block(0, slice(0, len(ke)), ke, re)

    def advance(self, trial: Trial, history: History) -> History:
        """Memory at the converged state."""
        return self._respond(trial, history)[1]

    def time_error(self, history: History, new: History, time_step: float, after_kink: bool) -> float:
        """Error of the time integration in this step, relative to the largest stress."""
        return time_error(self.inelastic, history, new, time_step, after_kink)

    def _field(self, trial: Trial) -> Floats:
        """Electric field e3 (m, q) of the electrode over each element."""
        voltage = np.append(trial.x, 0.0)[np.append(self.voltage_dofs, -1)[self.electrode]]
        return np.broadcast_to(-voltage[:, None] / self.thickness, self.weight.shape)

    def _strain(self, displacement: Floats) -> Floats:
        """Green-Lagrange strain (m, q, 6) at nodal displacements (n, 3), prestrain included."""
        return green_lagrange(self.gradient, displacement[self.tets]) + self.prestrain

    def _respond(self, trial: Trial, history: History) -> tuple[StressResponse, History]:
        """Response at the quadrature points (m q) in order, and the new memory."""
        elastic = self._strain(trial.displacement).reshape(-1, 6)
        elastic = elastic - self._field(trial).reshape(-1, 1) * self.law.coupling
        tangent = np.broadcast_to(self.law.stiffness, (len(elastic), 6, 6))
        response = StressResponse(elastic @ self.law.stiffness, tangent)
        return respond(self.inelastic, response, history, trial.time_step)

    def strain_and_stress(self, trial: Trial, history: History) -> tuple[Floats, Floats]:
        """Green-Lagrange strain, prestrain included, and second Piola-Kirchhoff stress, (m, q, 6) each.

        history : the memory before the trial's step.
        """
        strain = self._strain(trial.displacement)
        return strain, self._respond(trial, history)[0].stress.reshape(strain.shape)

    def prestress_resultant(self) -> float:
        """Largest membrane force of the prestretch, per width."""
        return float(np.abs(self.law.stiffness @ self.prestrain).max()) * self.thickness

    def charge(self, trial: Trial, history: History) -> Floats:
        """Short-circuit charge of each electrode: integral of d . S over its undeformed area, shape (e,)."""
        density = self.strain_and_stress(trial, history)[1] @ self.law.coupling
        return self.coverage.integral(density) / self.thickness

    def area(self) -> Floats:
        """Undeformed area of each electrode, shape (e,)."""
        return self.coverage.volume() / self.thickness

    def capacitance(self) -> Floats:
        """Capacitance eps A / t (e,) of the undeformed film under each electrode."""
        return self.area() * self.law.permittivity / self.thickness


def film_region(
    law: FilmLaw,
    points: Floats,
    tets: Ints,
    displacement_dofs: Ints,
    voltage_dofs: Ints,
    outlines: Sequence[Floats],
    thickness: float,
    prestretch: tuple[float, float] = (0.0, 0.0),
    inelastic: tuple[Inelastic, ...] = (),
) -> FilmRegion:
    """Prepare the film: points (n, 3), tets (m, 10), outlines of the electrodes, corners (c, 2).

    prestretch : nominal strains in x and y that the film has been given before it was bonded.
    """
    pieces = electrode_pieces(outlines)
    reference, weight = tetrahedron()
    shape, slope = quadratic(reference)
    gradient, volume = physical_gradients(points[tets], slope, weight)
    at_points = np.einsum("qn,mni->mqi", shape, points[tets])
    electrode = electrode_over(points[tets[:, :4]].mean(axis=1), pieces)
    dofs = np.concatenate(
        [displacement_dofs[tets].reshape(-1, 30), np.append(voltage_dofs, -1)[electrode][:, None]], axis=1
    )
    return FilmRegion(
        law,
        tets,
        dofs,
        gradient,
        volume,
        electrode,
        coverage(points[tets[:, :4]], at_points, volume, pieces),
        voltage_dofs,
        thickness,
        prestrain(law, prestretch),
        inelastic,
    )


def prestrain(law: FilmLaw, prestretch: tuple[float, float]) -> Floats:
    """Green-Lagrange strain (6,) of a film stretched in its plane and free to thin: S33 = 0."""
    strain = np.zeros(6)
    strain[:2] = [e + 0.5 * e * e for e in prestretch]
    strain[2] = -float(law.stiffness[2] @ strain) / law.stiffness[2, 2]
    return strain

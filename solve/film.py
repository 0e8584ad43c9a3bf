"""The piezoelectric film: quadratic tetrahedra of its true thickness, charge collected by electrodes."""

from dataclasses import dataclass

import numpy as np

from mesh.types import Floats, Ints
from solve.element_kernels import film_solid
from solve.materials.piezoelectric import FilmLaw
from solve.materials.voigt import to_voigt
from solve.quadrature import tetrahedron
from solve.shape_functions import physical_gradients, quadratic
from solve.solid import deformation_gradient, refuse_inversion


@dataclass(frozen=True)
class FilmRegion:
    """The film in the solver's units.

    tets : (m, 10); dofs : (m, 31) displacements and the voltage (-1 when it does not act back);
    electrode : (m,) index of the electrode over the element, -1 for bare film; electrodes : their number.
    covered : (m, q) the same at each quadrature point, for the charge.
    thickness : undeformed.
    """

    law: FilmLaw
    tets: Ints
    dofs: Ints
    gradient: Floats
    weight: Floats
    electrode: Ints
    covered: Ints
    electrodes: int
    thickness: float

    def elements(self, displacement: Floats, voltage: Floats) -> tuple[Floats, Floats]:
        """Element matrices (m, 31, 31), upper triangle, and residuals (m, 31) at electrode voltages (e,)."""
        field = -np.append(voltage, 0.0)[self.electrode] / self.thickness
        f = deformation_gradient(self.gradient, displacement[self.tets])
        refuse_inversion(f, "film", self.tets)
        ke, re = np.empty((len(f), 31, 31)), np.empty((len(f), 31))
        film_solid(
            self.gradient, self.weight, f, self.law.stiffness, self.law.coupling, self.law.permittivity, field,
            -1.0 / self.thickness, ke, re,
        )
        return ke, re

    def strain_and_stress(self, displacement: Floats, voltage: Floats) -> tuple[Floats, Floats]:
        """Green-Lagrange strain and second Piola-Kirchhoff stress at the quadrature points, (m, q, 6) each."""
        f = deformation_gradient(self.gradient, displacement[self.tets])
        strain = to_voigt(0.5 * (f.swapaxes(-1, -2) @ f - np.eye(3)), 2.0)
        field = -np.append(voltage, 0.0)[self.electrode] / self.thickness
        return strain, (strain - field[:, None, None] * self.law.coupling) @ self.law.stiffness

    def _collect(self, density: Floats) -> Floats:
        """Integral over the undeformed area of each electrode, shape (e,)."""
        part = np.broadcast_to(density * self.weight / self.thickness, self.weight.shape).ravel()
        under, index = self.covered.ravel() >= 0, self.covered.ravel()
        total: Floats = np.bincount(index[under], part[under], self.electrodes).astype(np.float64)
        return total

    def charge(self, displacement: Floats, voltage: Floats) -> Floats:
        """Short-circuit charge of each electrode: integral of d . S over its undeformed area, shape (e,)."""
        return self._collect(self.strain_and_stress(displacement, voltage)[1] @ self.law.coupling)

    def capacitance(self) -> Floats:
        """eps A / t of the undeformed film under each electrode, shape (e,)."""
        return self._collect(np.array(self.law.permittivity / self.thickness))


def film_region(
    law: FilmLaw,
    points: Floats,
    tets: Ints,
    displacement_dofs: Ints,
    voltage_dofs: Ints,
    rectangles: Floats,
    thickness: float,
) -> FilmRegion:
    """Prepare the film: points (n, 3), tets (m, 10), electrodes as rectangles (e, 4) x0, x1, y0, y1."""
    reference, weight = tetrahedron()
    shape, slope = quadratic(reference)
    gradient, volume = physical_gradients(points[tets], slope, weight)
    covered = electrode_over(np.einsum("qn,mni->mqi", shape, points[tets]), rectangles)
    electrode = electrode_over(points[tets[:, :4]].mean(axis=1), rectangles)
    dofs = np.concatenate(
        [displacement_dofs[tets].reshape(-1, 30), np.append(voltage_dofs, -1)[electrode][:, None]], axis=1
    )
    return FilmRegion(law, tets, dofs, gradient, volume, electrode, covered, len(rectangles), thickness)


def electrode_over(points: Floats, rectangles: Floats) -> Ints:
    """Index of the electrode that covers each point (..., 3), -1 for bare film."""
    index = np.full(points.shape[:-1], -1)
    for number, (x0, x1, y0, y1) in enumerate(rectangles):
        x, y = points[..., 0], points[..., 1]
        index[(x >= x0) & (x <= x1) & (y >= y0) & (y <= y1)] = number
    return index

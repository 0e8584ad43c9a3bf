"""The press of a slice in plane strain by NGSolve: force and charge over depth.

Quadratic displacements on quadrilaterals, a linear pressure in each medium, the film as a sheet of solid elements of
its own, the ridge as a rigid cylinder behind a penalty. Lengths in mm, stresses in MPa, forces in N, charges in pC.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import ngsolve as ng
import numpy as np
from netgen.meshing import Element1D, Element2D, FaceDescriptor, Mesh, MeshPoint, Pnt
from numpy.typing import NDArray

from benchmarks.made_elsewhere.rigs import Bench, Sheet

PENALTY = 1e4  # N/mm3: a pressure of 1 MPa sinks in by 0.1 um
ROUNDING = 1e-4  # mm, over which the pressure sets in
FORCE_TOLERANCE = 1e-7
MOST_STEPS = 30
LARGEST_GROWTH = 20.0  # of the residual in one iteration: contact makes it jump
LARGEST_STEP = 0.02  # mm
SMALLEST_STEP = 0.0005
NAMES = ("base", "top", "side", "inner")


@dataclass(frozen=True)
class Fineness:
    """Elements along the slice, and elements per mm of height (at least two a sheet)."""

    columns: int = 40
    per_mm: float = 7.0


@dataclass(frozen=True)
class Band:
    """A row of the slice from bottom to top."""

    name: str
    thickness: float
    rows: int
    held: bool  # whether its sides lean on the frame


def bands(bench: Bench, fineness: Fineness) -> list[Band]:
    """The rows of the slice from the base to its top."""

    def sheet(name: str, one: Sheet, held: bool) -> Band:
        return Band(name, one.thickness, max(2, round(fineness.per_mm * one.thickness)), held)

    between = [sheet("glue", bench.glue, False)] if bench.glue else []
    film = Band("film", bench.film.thickness, 1, True)
    above = [film, sheet("medium1", bench.medium1, True), sheet("effector", bench.effector, True)]
    return [sheet("medium2", bench.medium2, False), *between, *above]


def stations(bench: Bench, columns: int) -> NDArray[np.float64]:
    """Columns of the mesh, closer in the middle."""
    s = np.linspace(-1, 1, columns + 1)
    return bench.length / 2 * (0.6 * s + 0.4 * s**3)


def built(bench: Bench, fineness: Fineness) -> ng.Mesh:
    """The mesh, its regions named as the bands."""
    mesh = Mesh()
    mesh.dim = 2
    x = stations(bench, fineness.columns)
    rows = bands(bench, fineness)
    heights, of_row = [0.0], []
    for band in rows:
        heights += list(heights[-1] + band.thickness * np.arange(1, band.rows + 1) / band.rows)
        of_row += [band] * band.rows
    regions = [band.name for band in rows]
    for number, region in enumerate(regions, 1):
        mesh.Add(FaceDescriptor(surfnr=number, domin=number, bc=number))
        mesh.SetMaterial(number, region)
    point = [[mesh.Add(MeshPoint(Pnt(a, b, 0))) for a in x] for b in heights]
    for j, band in enumerate(of_row):
        for i in range(len(x) - 1):
            corners = [point[j][i], point[j][i + 1], point[j + 1][i + 1], point[j + 1][i]]
            mesh.Add(Element2D(regions.index(band.name) + 1, corners))
        for i in (0, -1):
            mesh.Add(Element1D([point[j][i], point[j + 1][i]], index=3 if band.held else 4))
    for i in range(len(x) - 1):
        mesh.Add(Element1D([point[0][i], point[0][i + 1]], index=1))
        mesh.Add(Element1D([point[-1][i + 1], point[-1][i]], index=2))
    for number, name in enumerate(NAMES):
        mesh.SetBCName(number, name)
    return ng.Mesh(mesh)


class SlicePress:
    """A slice that is pressed, state by state."""

    def __init__(self, bench: Bench, fineness: Fineness | None = None) -> None:
        self.bench = bench
        fineness = fineness or Fineness()
        self.rows = bands(bench, fineness)
        self.height = sum(band.thickness for band in self.rows)
        self.mesh = built(bench, fineness)
        self.media = {band.name: getattr(bench, band.name) for band in self.rows if band.name != "film"}
        spaces = [ng.VectorH1(self.mesh, order=2, dirichlet="base")]
        spaces += [self._pressures(name) for name in self.media]
        self.space = ng.FESpace(spaces)
        self.state = ng.GridFunction(self.space)
        self.depth = ng.Parameter(0.0)
        self.form = self._form()

    def _pressures(self, region: str) -> ng.FESpace:
        """Linear and continuous inside a region, without the sides of the others."""
        space = ng.H1(self.mesh, order=1, definedon=self.mesh.Materials(region))
        inside = ng.BitArray(space.ndof)
        inside.Clear()
        for element in space.Elements(ng.VOL):
            for dof in element.dofs:
                inside.Set(dof)
        return ng.Compress(space, active_dofs=inside)

    def _energy(self, sheet: Sheet, gradient: ng.CoefficientFunction, p: ng.CoefficientFunction):
        """Neo-Hookean or Gent's energy, with the pressure as an unknown."""
        j = ng.Det(gradient)
        first = j ** (-2 / 3) * (ng.InnerProduct(gradient, gradient) + 1) - 3
        if sheet.gent_limit is not None:
            shape = -sheet.shear / 2 * sheet.gent_limit * ng.log(1 - first / sheet.gent_limit)
        else:
            shape = sheet.shear / 2 * first
        return shape + p * (j - 1) - p * p / (2 * sheet.bulk)

    def _film_stress(self, gradient: ng.CoefficientFunction) -> tuple[ng.CoefficientFunction, ...]:
        """S11, S22 (across the slice), S33 and S13 of the film, and its strains, in plane strain."""
        film = self.bench.film
        e = 0.5 * (gradient.trans * gradient - ng.Id(2))
        shear = film.modulus / (2 * (1 + film.poisson))
        lame = film.modulus * film.poisson / ((1 + film.poisson) * (1 - 2 * film.poisson))
        volume = lame * (e[0, 0] + e[1, 1])
        return volume + 2 * shear * e[0, 0], volume, volume + 2 * shear * e[1, 1], 2 * shear * e[0, 1], e

    def _gap(self, u: ng.CoefficientFunction) -> tuple[ng.CoefficientFunction, ng.CoefficientFunction]:
        """Distance from the ridge, and the vertical part of its direction."""
        x, y = ng.x + u[0] - self.bench.aside, self.height + self.bench.radius - self.depth - ng.y - u[1]
        far = ng.sqrt(x * x + y * y)
        return far - self.bench.radius, y / far

    @staticmethod
    def _sunk(gap: ng.CoefficientFunction) -> tuple[ng.CoefficientFunction, ng.CoefficientFunction]:
        """Pressure of the penalty and its energy, a ramp whose corner is a parabola."""
        sunk = ng.IfPos(-gap, -gap, 0.0)
        early = ng.IfPos(sunk - ROUNDING, 0.0, 1.0)
        pressure = early * sunk**2 / (2 * ROUNDING) + (1 - early) * (sunk - ROUNDING / 2)
        energy = early * sunk**3 / (6 * ROUNDING) + (1 - early) * (sunk**2 - sunk * ROUNDING + ROUNDING**2 / 3) / 2
        return PENALTY * pressure, PENALTY * energy

    def _form(self) -> ng.BilinearForm:
        u, *pressures = self.space.TrialFunction()
        gradient = ng.Id(2) + ng.Grad(u)
        form = ng.BilinearForm(self.space, symmetric=True)
        for (name, sheet), p in zip(self.media.items(), pressures, strict=True):
            where = self.mesh.Materials(name)
            form += ng.Variation(self._energy(sheet, gradient, p).Compile() * ng.dx(definedon=where, bonus_intorder=1))
        s11, _, s33, s13, e = self._film_stress(gradient)
        energy = 0.5 * (s11 * e[0, 0] + s33 * e[1, 1]) + s13 * e[0, 1]
        form += ng.Variation(energy.Compile() * ng.dx(definedon=self.mesh.Materials("film"), bonus_intorder=2))
        if self.bench.side_stiffness is not None:
            form += ng.Variation(self.bench.side_stiffness / 2 * ng.InnerProduct(u, u) * ng.ds("side"))
        gap, _ = self._gap(u)
        form += ng.Variation(self._sunk(gap)[1] * ng.ds("top", bonus_intorder=10))
        return form

    def _solve(self) -> bool:
        """Whether Newton's method converged; a step is halved where it makes the residual much larger."""
        free = ng.Projector(self.space.FreeDofs(), True)
        residual, step, start = (self.state.vec.CreateVector() for _ in range(3))

        def size() -> float:
            self.form.Apply(self.state.vec, residual)
            residual.data = free * residual
            return float(ng.Norm(residual))

        now = size()
        for _ in range(MOST_STEPS):
            if now < FORCE_TOLERANCE:
                return True
            self.form.AssembleLinearization(self.state.vec)
            step.data = self.form.mat.Inverse(self.space.FreeDofs(), inverse="sparsecholesky") * residual
            start.data = self.state.vec
            for share in (1.0, 0.5, 0.25, 0.125):
                self.state.vec.data = start - share * step
                new = size()
                if new < LARGEST_GROWTH * max(now, 1e-3):
                    break
            if not np.isfinite(new):
                return False
            now = new
        return False

    def answers(self) -> tuple[float, float]:
        """Force in N and charge in pC of the whole width."""
        u = self.state.components[0]
        gap, vertical = self._gap(u)
        pushed = self._sunk(gap)[0] * vertical
        force = ng.Integrate(pushed * ng.ds("top", bonus_intorder=10), self.mesh)
        s11, s22, s33, _, _ = self._film_stress(ng.Id(2) + ng.Grad(u))
        d31, d32, d33 = self.bench.film.d
        density = (d31 * s11 + d32 * s22 + d33 * s33) / self.bench.film.thickness
        charge = ng.Integrate(density * ng.dx(definedon=self.mesh.Materials("film"), bonus_intorder=2), self.mesh)
        return self.bench.width * force, self.bench.width * charge

    def curve(self, depths: Iterable[float]) -> NDArray[np.float64]:
        """Rows of force and charge at depths that rise from the first touch."""
        return np.array([self.to(depth) for depth in depths])

    def to(self, depth: float) -> tuple[float, float]:
        """Go on to a depth, in smaller steps where Newton's method asks for them."""
        step, last = LARGEST_STEP, None
        while abs(depth - self.depth.Get()) > 1e-12:
            start = self.depth.Get()
            kept = self.state.vec.CreateVector()
            kept.data = self.state.vec
            self.depth.Set(start + np.clip(depth - start, -step, step))
            if last is not None:  # a secant from the last two states
                self.state.vec.data += (self.depth.Get() - start) / last[0] * (kept - last[1])
            if self._solve():
                last = self.depth.Get() - start, kept
                continue
            last = None
            self.state.vec.data = kept
            self.depth.Set(start)
            step /= 2
            if step < SMALLEST_STEP:
                raise RuntimeError(f"no equilibrium beyond {start:.4f} mm")
        return self.answers()

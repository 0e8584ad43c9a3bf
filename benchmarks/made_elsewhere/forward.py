"""The press of a slice in plane strain by NGSolve: force and charge over depth, or over time where a medium relaxes.

Quadratic displacements on quadrilaterals, a linear pressure in each medium, the film as a sheet of solid elements of
its own, the ridge as a rigid cylinder behind a penalty. Lengths in mm, stresses in MPa, forces in N, charges in pC.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import ngsolve as ng
import numpy as np
from netgen.meshing import Element1D, Element2D, FaceDescriptor, Mesh, MeshPoint, Pnt
from numpy.typing import NDArray

from benchmarks.made_elsewhere.rigs import Bench, Sheet

PENALTY = 1e4  # N/mm3: a pressure of 1 MPa sinks in by 0.1 um
ROUNDING = 1e-4  # mm, over which the pressure sets in
GAP_THICKNESS = 0.008  # mm, of the void that stands for parted faces
GAP_BULK = 20.0  # MPa, of the void where it is squeezed: 0.2 MPa close it by a tenth of its thickness
GAP_REST = 1e-4  # MPa, of the void in any case: a slip of 0.05 mm meets 0.0006 MPa
FORCE_TOLERANCE = 1e-7
MOST_STEPS = 30
LARGEST_GROWTH = 20.0  # of the residual in one iteration: contact makes it jump
LARGEST_STEP = 0.02  # mm
SMALLEST_STEP = 0.0005
NAMES = ("base", "top", "side", "inner")


@dataclass(frozen=True)
class Fineness:
    """Elements along the slice, and elements per mm of height (at least two a sheet)."""

    columns: int = 56
    per_mm: float = 10.0


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
    if bench.loose:
        between.append(Band("seam", GAP_THICKNESS, 1, False))
    film = Band("film", bench.film.thickness, 1, True)
    above = [film, sheet("medium1", bench.medium1, True), sheet("effector", bench.effector, True)]
    # the seam is of medium 2 where it holds
    cushion = replace(bench.medium2, thickness=bench.medium2.thickness - (GAP_THICKNESS if bench.loose else 0.0))
    return [sheet("medium2", cushion, False), *between, *above]


def stations(bench: Bench, columns: int) -> NDArray[np.float64]:
    """Columns of the mesh, closer under the dot; the ends of a parted stretch are among them."""
    half = bench.length / 2
    s = np.linspace(-1, 1, columns + 1)
    x = half * (0.6 * s + 0.4 * s**3)
    for end in bench.loose or ():
        if 0 < end < 1:
            for side in (-1, 1):
                x[np.argmin(np.abs(x - side * end * half))] = side * end * half
    return x


def built(bench: Bench, fineness: Fineness) -> ng.Mesh:
    """The mesh, its regions named as the bands; where film and medium 2 are parted the region is "void"."""
    mesh = Mesh()
    mesh.dim = 2
    x = stations(bench, fineness.columns)
    rows = bands(bench, fineness)
    heights, of_row = [0.0], []
    for band in rows:
        heights += list(heights[-1] + band.thickness * np.arange(1, band.rows + 1) / band.rows)
        of_row += [band] * band.rows
    regions = [band.name for band in rows] + ["void"]
    for number, region in enumerate(regions, 1):
        mesh.Add(FaceDescriptor(surfnr=number, domin=number, bc=number))
        mesh.SetMaterial(number, region)
    point = [[mesh.Add(MeshPoint(Pnt(a, b, 0))) for a in x] for b in heights]
    for j, band in enumerate(of_row):
        for i in range(len(x) - 1):
            middle = abs(x[i] + x[i + 1]) / bench.length
            parted = band.name == "seam" and bench.loose and bench.loose[0] < middle < bench.loose[1]
            region = regions.index("void" if parted else band.name) + 1
            corners = [point[j][i], point[j][i + 1], point[j + 1][i + 1], point[j + 1][i]]
            mesh.Add(Element2D(region, corners))
        for i in (0, -1):
            mesh.Add(Element1D([point[j][i], point[j + 1][i]], index=3 if band.held else 4))
    for i in range(len(x) - 1):
        mesh.Add(Element1D([point[0][i], point[0][i + 1]], index=1))
        mesh.Add(Element1D([point[-1][i + 1], point[-1][i]], index=2))
    for number, name in enumerate(NAMES):
        mesh.SetBCName(number, name)
    return ng.Mesh(mesh)


class Memory:
    """Maxwell branches of one medium, each a neo-Hookean spring behind a dashpot: F = Fe Fv.

    The flow of Cv is that of Lion (Acta Mech. 123, 1997), brought forward by the unimodular update of Shutov, Landgraf
    and Ihlemann (Comput. Methods Appl. Mech. Eng. 265, 2013), here with the exponential of the mid-point.
    """

    def __init__(self, mesh: ng.Mesh, region: str, sheet: Sheet, order: int = 5) -> None:
        self.where = mesh.Materials(region)
        self.sheet = sheet
        space = ng.IntegrationRuleSpace(mesh, order=order, definedon=self.where)
        self.rules = space.GetIntegrationRules()
        self.dx = ng.dx(definedon=self.where, intrules=self.rules)
        self.step = ng.Parameter(1.0)
        self.kept = [[ng.GridFunction(space) for _ in range(4)] for _ in sheet.relative_moduli]
        self.before = [ng.GridFunction(space) for _ in range(4)]
        for parts in [*self.kept, self.before]:
            for part, value in zip(parts, (1.0, 0.0, 1.0, 1.0), strict=True):
                part.Interpolate(ng.CoefficientFunction(value))

    @staticmethod
    def isochoric(gradient: ng.CoefficientFunction) -> list[ng.CoefficientFunction]:
        """xx, xy, yy and zz of J^(-2/3) C."""
        c = gradient.trans * gradient
        factor = ng.Det(gradient) ** (-2 / 3)
        return [factor * c[0, 0], factor * c[0, 1], factor * c[1, 1], factor]

    def flowed(self, n: int, gradient: ng.CoefficientFunction) -> list[ng.CoefficientFunction]:
        """Cv of a branch at the end of the step."""
        decay = ng.exp(-self.step / self.sheet.relaxation_times[n])
        now = self.isochoric(gradient)
        mixed = zip(self.kept[n], self.before, now, strict=True)
        a = [decay * old + (1 - decay) * 0.5 * (start + end) for old, start, end in mixed]
        size = ((a[0] * a[2] - a[1] * a[1]) * a[3]) ** (-1 / 3)
        return [size * one for one in a]

    def stress(self, gradient: ng.CoefficientFunction) -> ng.CoefficientFunction:
        """First Piola-Kirchhoff stress of all branches."""
        now, total = self.isochoric(gradient), 0
        for n, share in enumerate(self.sheet.relative_moduli):
            xx, xy, yy, zz = self.flowed(n, gradient)
            area = xx * yy - xy * xy
            inverse = ng.CoefficientFunction((yy / area, -xy / area, -xy / area, xx / area), dims=(2, 2))
            trace = (now[0] * yy - 2 * now[1] * xy + now[2] * xx) / area + now[3] / zz
            scale = share * self.sheet.shear
            back = ng.Inv(gradient).trans
            total += scale * (ng.Det(gradient) ** (-2 / 3) * gradient * inverse - trace / 3 * back)
        return total

    def keep(self, gradient: ng.CoefficientFunction) -> None:
        """Take over the end of a step as the start of the next."""
        ends = [self.flowed(n, gradient) for n in range(len(self.kept))]
        new = [[self.kept[0][0].space for _ in end] for end in ends]
        for n, end in enumerate(ends):
            for k, one in enumerate(end):
                held = ng.GridFunction(new[n][k])
                held.Interpolate(one)
                new[n][k] = held
        for part, one in zip(self.before, self.isochoric(gradient), strict=True):
            part.Interpolate(one)
        for parts, ends_n in zip(self.kept, new, strict=True):
            for part, one in zip(parts, ends_n, strict=True):
                part.vec.data = one.vec


class SlicePress:
    """A slice that is pressed, state by state."""

    def __init__(self, bench: Bench, fineness: Fineness | None = None) -> None:
        self.bench = bench
        fineness = fineness or Fineness()
        self.rows = bands(bench, fineness)
        self.height = sum(band.thickness for band in self.rows)
        self.mesh = built(bench, fineness)
        self.media = {band.name: getattr(bench, band.name) for band in self.rows if band.name not in ("film", "seam")}
        if bench.loose:
            self.media["seam"] = bench.medium2
        spaces = [ng.VectorH1(self.mesh, order=2, dirichlet="base")]
        spaces += [self._pressures(name) for name in self.media]
        self.space = ng.FESpace(spaces)
        self.state = ng.GridFunction(self.space)
        self.depth = ng.Parameter(0.0)
        self.memory = next(
            (Memory(self.mesh, name, one) for name, one in self.media.items() if one.relative_moduli), None
        )
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
            shape = sheet.shear * (1 - sum(sheet.relative_moduli)) / 2 * first
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
        trial, test = self.space.TnT()
        u, pressures = trial[0], trial[1:]
        gradient = ng.Id(2) + ng.Grad(u)
        form = ng.BilinearForm(self.space, symmetric=self.memory is None)
        for (name, sheet), p in zip(self.media.items(), pressures, strict=True):
            where = self.mesh.Materials(name)
            form += ng.Variation(self._energy(sheet, gradient, p).Compile() * ng.dx(definedon=where, bonus_intorder=1))
        s11, _, s33, s13, e = self._film_stress(gradient)
        energy = 0.5 * (s11 * e[0, 0] + s33 * e[1, 1]) + s13 * e[0, 1]
        form += ng.Variation(energy.Compile() * ng.dx(definedon=self.mesh.Materials("film"), bonus_intorder=2))
        if self.bench.loose:
            j = ng.Det(gradient)
            squeezed = GAP_BULK / 3 * ng.IfPos(1 - j, (1 - j) ** 3, 0.0)
            rest = GAP_REST / 2 * ng.InnerProduct(ng.Grad(u), ng.Grad(u))
            form += ng.Variation((squeezed + rest) * ng.dx(definedon=self.mesh.Materials("void")))
        if self.bench.side_stiffness is not None:
            form += ng.Variation(self.bench.side_stiffness / 2 * ng.InnerProduct(u, u) * ng.ds("side"))
        gap, _ = self._gap(u)
        form += ng.Variation(self._sunk(gap)[1] * ng.ds("top", bonus_intorder=10))
        if self.memory is not None:
            form += ng.InnerProduct(self.memory.stress(gradient), ng.Grad(test[0])) * self.memory.dx
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
            solver = "sparsecholesky" if self.memory is None else "umfpack"
            step.data = self.form.mat.Inverse(self.space.FreeDofs(), inverse=solver) * residual
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

    def course(self, times: NDArray[np.float64], depths: NDArray[np.float64]) -> NDArray[np.float64]:
        """Rows of force and charge at times, from rest; the medium remembers."""
        assert self.memory is not None
        found = [(0.0, 0.0)]
        for n in range(1, len(times)):
            self.memory.step.Set(times[n] - times[n - 1])
            self.depth.Set(max(depths[n], 0.0))
            if not self._solve():
                raise RuntimeError(f"no equilibrium at {times[n]:.4f} s")
            self.memory.keep(ng.Id(2) + ng.Grad(self.state.components[0]))
            found.append(self.answers())
        return np.array(found)

"""A press with a flat plate by NGSolve: its own spaces, symbolic energies, quadrature and solver.

While the whole top touches, frictionless contact with a plate is a prescribed vertical displacement of the top.
A program of its own, CASE.npz -> JSON on stdout. It imports nothing of this project, and only the case (corner
mesh, sizes, constants) is shared. It needs its own process too: NGSolve brings an OpenCASCADE that crashes
build123d's. Units: mm, N, MPa, pC, V.
"""

import json
import sys

import netgen.meshing as nm
import ngsolve as ng
import numpy as np

VACUUM_PF_PER_MM, RELATIVE_PERMITTIVITY = 8.8541878128e-3, 12.0
D31, D32, D33 = 23.0, 2.3, -33.0  # pC / N


def to_ngsolve(case) -> ng.Mesh:
    """Straight-sided mesh: a material for each region, a boundary condition for each named outer facet."""
    target = nm.Mesh(dim=3)
    used, corners = np.unique(case["tets"], return_inverse=True)
    ids = [target.Add(nm.MeshPoint(nm.Pnt(*map(float, case["points"][n])))) for n in used]
    for number, name in enumerate(case["region_names"], start=1):
        target.SetMaterial(number, str(name))
    for region, (a, b, c, d) in zip(case["region"], corners.reshape(-1, 4), strict=True):
        target.Add(nm.Element3D(int(region) + 1, [ids[a], ids[c], ids[b], ids[d]]))
    for number, name in enumerate(case["facet_names"], start=1):
        face = target.Add(nm.FaceDescriptor(surfnr=number, domin=1, domout=0, bc=number))
        target.SetBCName(number - 1, str(name))
        for facet in np.searchsorted(used, case[f"facet:{name}"]):
            target.Add(nm.Element2D(face, [ids[n] for n in facet]))
    return ng.Mesh(target)


class PlatePress:
    """A segment whose top is moved down by a depth."""

    def __init__(self, case) -> None:
        rubbers = {str(name): modulus for name, modulus in zip(case["media"], case["moduli"], strict=True)}
        held = [str(name) for name in case["held"]]
        self.domain, self.thickness = to_ngsolve(case), float(case["film_thickness"])
        self.height = float(case["points"][:, 2].max())
        fixed = "|".join(["base", *(f"side-{name}" for name in held)])
        self.clamped = ng.VectorH1(self.domain, order=2, dirichlet=fixed)
        moved = ng.VectorH1(self.domain, order=2, dirichletx=fixed, dirichlety=fixed, dirichletz=f"{fixed}|contact")
        media = [self.domain.Materials(name) for name in rubbers]
        self.space = ng.FESpace([moved, *(ng.Compress(ng.H1(self.domain, order=1, definedon=m)) for m in media)])
        u, *pressures = self.space.TrialFunction()
        self.form = ng.BilinearForm(self.space, symmetric=True)
        for medium, young, p in zip(media, rubbers.values(), pressures, strict=True):
            energy = self._rubber(u, p, float(young)).Compile()
            self.form += ng.Variation(energy * ng.dx(definedon=medium, bonus_intorder=4))
        film = self.domain.Materials("film")
        self.form += ng.Variation(self._film_energy(u).Compile() * ng.dx(definedon=film, bonus_intorder=4))
        self.state = ng.GridFunction(self.space)

    @staticmethod
    def _rubber(u, p, young, nu=0.495):
        mu, bulk = young / (2 * (1 + nu)), young / (3 * (1 - 2 * nu))
        f = ng.Id(3) + ng.Grad(u)
        j = ng.Det(f)
        return mu / 2 * (ng.exp(-2 / 3 * ng.log(j)) * ng.InnerProduct(f, f) - 3) + p * (j - 1) - p * p / (2 * bulk)

    @staticmethod
    def _film_stress(u, young=2000.0, nu=0.29):
        f = ng.Id(3) + ng.Grad(u)
        strain = 0.5 * (f.trans * f - ng.Id(3))
        lame = young * nu / ((1 + nu) * (1 - 2 * nu))
        return lame * ng.Trace(strain) * ng.Id(3) + young / (1 + nu) * strain, strain

    def _film_energy(self, u):
        stress, strain = self._film_stress(u)
        return 0.5 * ng.InnerProduct(stress, strain)

    def solve(self, depth: float) -> tuple[float, float]:
        """Force (N) and open-circuit voltage (V) at a depth (mm)."""
        displacement = self.state.components[0]
        displacement.Set(ng.CF((0.0, 0.0, -depth * ng.z / self.height)))
        displacement.vec.FV().NumPy()[~np.array(list(self.clamped.FreeDofs()))] = 0.0
        residual, step = (self.state.vec.CreateVector() for _ in range(2))
        for _ in range(20):
            self.form.Apply(self.state.vec, residual)
            self.form.AssembleLinearization(self.state.vec)
            step.data = self.form.mat.Inverse(self.space.FreeDofs(), inverse="umfpack") * residual
            self.state.vec.data -= step
            if abs(ng.InnerProduct(step, residual)) < 1e-18:
                return self._force(), self._voltage()
        raise RuntimeError(f"NGSolve did not converge at {depth} mm")

    def _force(self) -> float:
        """The top's reaction: the virtual work of a unit displacement of the top."""
        residual = self.state.vec.CreateVector()
        self.form.Apply(self.state.vec, residual)
        lifted = ng.GridFunction(self.space)
        lifted.components[0].Set(ng.CF((0.0, 0.0, ng.z / self.height)))
        top = ~np.array(list(self.space.components[0].FreeDofs())) & np.array(list(self.clamped.FreeDofs()))
        lifted.components[0].vec.FV().NumPy()[~top] = 0.0
        return -ng.InnerProduct(residual, lifted.vec)

    def _voltage(self) -> float:
        stress, _ = self._film_stress(self.state.components[0])
        density = D31 * stress[0, 0] + D32 * stress[1, 1] + D33 * stress[2, 2]
        film = ng.dx(definedon=self.domain.Materials("film"))
        charge = ng.Integrate(density * film, self.domain) / self.thickness
        area = ng.Integrate(ng.CF(1.0) * film, self.domain) / self.thickness
        return charge / (RELATIVE_PERMITTIVITY * VACUUM_PF_PER_MM * area / self.thickness)


if __name__ == "__main__":
    with np.load(sys.argv[1]) as case:
        print(json.dumps(PlatePress(case).solve(float(case["depth"]))))

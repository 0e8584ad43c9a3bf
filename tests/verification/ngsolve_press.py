"""A press with a round dot by NGSolve: frictionless contact as an augmented Lagrangian on the surface.

A program of its own, CASE.npz -> JSON on stdout (see ngsolve_plate.py, from which media and film come). The contact
is not that of this project: a continuous linear multiplier l at the corners of the contact facets, and the energy
    int 1/(2 r) (min(0, l + r g)^2 - l^2) dA
of the exact signed distance g to the sphere (Alart and Curnier, Comput. Methods Appl. Mech. Eng. 92, 1991; Pietrzak
and Curnier, ibid. 177, 1999). Its stationary point is the same for every r > 0 up to the discretisation: no penalty
is left in it. Units: mm, N, MPa, pC, V.
"""

import json
import sys
from time import perf_counter

import ngsolve as ng
import numpy as np
from ngsolve_plate import PlatePress, to_ngsolve

FACET_DEGREE = 8  # the edge of the contact zone crosses facets: an integrand with a kink
TOLERANCE = 1e-9  # Newton residual, relative to the contact forces


class DotPress(PlatePress):
    """A quarter of a segment under a rigid sphere that touches the middle of its top at depth zero."""

    def __init__(self, case) -> None:
        self.domain, self.thickness = to_ngsolve(case), float(case["film_thickness"])
        self.top, self.radius = float(case["points"][:, 2].max()), float(case["radius"])
        self.augmentation, self.depth = float(case["augmentation"]), ng.Parameter(0.0)
        self.timing: list[dict[str, float]] = []
        media = {str(name): float(e) for name, e in zip(case["media"], case["moduli"], strict=True)}
        fixed = "|".join(["base", *(f"side-{name}" for name in case["held"])])
        skin = self.domain.Boundaries("contact")
        planes = {f"dirichlet{axis}": f"{fixed}|plane-{axis}" for axis in "xy"}
        parts = [ng.VectorH1(self.domain, order=2, **planes, dirichletz=fixed)]
        parts += [ng.Compress(ng.H1(self.domain, order=1, definedon=self.domain.Materials(name))) for name in media]
        self.space = ng.FESpace([*parts, ng.Compress(ng.H1(self.domain, order=1, definedon=skin))])
        self.state = ng.GridFunction(self.space)
        u, *pressures, multiplier = self.space.TrialFunction()
        self.form = ng.BilinearForm(self.space, symmetric=True)
        for (name, young), p in zip(media.items(), pressures, strict=True):
            inside = ng.dx(definedon=self.domain.Materials(name), bonus_intorder=4)
            self.form += ng.Variation(self._rubber(u, p, young).Compile() * inside)
        inside = ng.dx(definedon=self.domain.Materials("film"), bonus_intorder=4)
        self.form += ng.Variation(self._film_energy(u).Compile() * inside)
        self.contact = ng.ds("contact", bonus_intorder=FACET_DEGREE)
        touching = self._traction(u, multiplier)
        energy = (touching * touching - multiplier * multiplier) / (2 * self.augmentation)
        self.form += ng.Variation(energy.Compile() * self.contact)

    def _arm(self, u):
        """From the centre of the sphere to the surface."""
        centre = ng.CF((0.0, 0.0, self.top + self.radius)) - ng.CF((0.0, 0.0, 1.0)) * self.depth
        return ng.CF((ng.x, ng.y, ng.z)) + u - centre

    def _traction(self, u, multiplier):
        """Normal traction of the contact, negative in compression."""
        arm = self._arm(u)
        trial = multiplier + self.augmentation * (ng.sqrt(ng.InnerProduct(arm, arm)) - self.radius)
        return ng.IfPos(trial, 0.0, trial)

    def press(self, depth: float, steps: int) -> dict:
        """History of depth (mm), force (N, of the quarter), open-circuit voltage (V) in equal steps, and its cost."""
        history = []
        for number in range(1, steps + 1):
            self.depth.Set(depth * number / steps)
            self._equilibrate()
            history.append({"depth_mm": self.depth.Get(), "force_N": self._force(), "voltage_V": self._voltage()})
        unknowns = sum(self.space.FreeDofs())
        return {"history": history, "overlap_mm": self._overlap(), "unknowns": unknowns, "newton_steps": self.timing}

    def _equilibrate(self) -> None:
        residual, step = (self.state.vec.CreateVector() for _ in range(2))
        free = self.space.FreeDofs()
        for _ in range(30):
            start = perf_counter()
            self.form.Apply(self.state.vec, residual)
            size = ng.Norm(ng.Projector(free, True) * residual)
            if size < TOLERANCE * self._force():
                return
            self.form.AssembleLinearization(self.state.vec)
            assembled = perf_counter()
            inverse = self.form.mat.Inverse(free, inverse="pardiso")
            factorised = perf_counter()
            step.data = inverse * residual
            self.state.vec.data -= step
            solved = perf_counter()
            self.timing.append(
                {
                    "assembly_s": assembled - start,
                    "factorisation_s": factorised - assembled,
                    "solution_s": solved - factorised,
                    "residual": size,
                }
            )
        raise RuntimeError(f"NGSolve did not converge at {self.depth.Get()} mm")

    def _force(self) -> float:
        """The derivative of the energy by the depth: the contact traction along the sphere's normal."""
        u, *_, multiplier = self.state.components
        arm = self._arm(u)
        along = ng.InnerProduct(arm, ng.CF((0.0, 0.0, 1.0))) / ng.sqrt(ng.InnerProduct(arm, arm))
        return ng.Integrate(self._traction(u, multiplier) * along * self.contact, self.domain)

    def _overlap(self) -> float:
        """Root of the mean squared penetration over the contact zone, mm."""
        u, *_, multiplier = self.state.components
        arm = self._arm(u)
        gap = ng.sqrt(ng.InnerProduct(arm, arm)) - self.radius
        touching = ng.IfPos(-self._traction(u, multiplier), 1.0, 0.0)
        square = ng.Integrate(touching * gap * gap * self.contact, self.domain)
        return float(np.sqrt(square / max(ng.Integrate(touching * self.contact, self.domain), 1e-30)))


if __name__ == "__main__":
    with np.load(sys.argv[1]) as case:
        print(json.dumps(DotPress(case).press(float(case["depth"]), int(case["steps"]))))

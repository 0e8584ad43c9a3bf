"""The press of the true segment by NGSolve in equal load steps: python -m benchmarks.press_ngsolve CASE.npz STEPS.

The program of tests/verification/ngsolve_press.py with what makes it fast: the same quadrature points as ours in the
volume, energies compiled by the C++ compiler, PARDISO symmetric with nested dissection, its analysis kept.
"""

import json
import sys
import time
from pathlib import Path

import ngsolve as ng
import numpy as np

from solve.fem.quadrature import tetrahedron

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "verification"))
from ngsolve_press import TOLERANCE, DotPress

FLAGS = {"ordering": "metis", "symmetric": True, "refinement": 0}
FACET_DEGREE = 4  # added to the elements' own; ours is degree 4 on each quarter of a facet


class FastPress(DotPress):
    """The same discrete problem, quicker."""

    def __init__(self, case) -> None:
        super().__init__(case)
        points, weights = tetrahedron()
        rule = {ng.TET: ng.IntegrationRule(points=points.tolist(), weights=weights.tolist())}
        u, *pressures, multiplier = self.space.TrialFunction()
        self.form = ng.BilinearForm(self.space, symmetric=True)
        constants = zip(case["media"], case["moduli"], case["poisson"], pressures, strict=True)
        for name, young, nu, p in constants:
            energy = self._rubber(u, p, float(young), float(nu)).Compile(realcompile=True, wait=True)
            inside = self.domain.Materials(str(name))
            self.form += ng.Variation(energy * ng.dx(definedon=inside, intrules=rule))
        energy = self._film_energy(u).Compile(realcompile=True, wait=True)
        self.form += ng.Variation(energy * ng.dx(definedon=self.domain.Materials("film"), intrules=rule))
        self.contact = ng.ds("contact", bonus_intorder=FACET_DEGREE)
        touching = self._traction(u, multiplier)
        energy = (touching * touching - multiplier * multiplier) / (2 * self.augmentation)
        self.form += ng.Variation(energy.Compile() * self.contact)
        self.inverse = None

    def _equilibrate(self) -> None:
        residual, step = (self.state.vec.CreateVector() for _ in range(2))
        free = self.space.FreeDofs()
        for _ in range(30):
            self.form.Apply(self.state.vec, residual)
            size = ng.Norm(ng.Projector(free, True) * residual)
            if size < TOLERANCE * self._force():
                return
            self.form.AssembleLinearization(self.state.vec)
            if self.inverse is None:
                self.inverse = self.form.mat.Inverse(free, inverse="pardiso", flags=FLAGS)
            else:
                self.inverse.Update()
            step.data = self.inverse * residual
            self.state.vec.data -= step
            self.timing.append({"residual": size})
        raise RuntimeError(f"NGSolve did not converge at {self.depth.Get()} mm")


def measure(path: str, steps: int) -> dict:
    """Time and answers; the compilation, which depends on no mesh, is not counted."""
    ng.SetNumThreads(2)
    with np.load(path) as case, ng.TaskManager():
        problem = FastPress(case)
        start = time.perf_counter()
        answer = problem.press(float(case["depth"]), steps)
        seconds = time.perf_counter() - start
    last = answer["history"][-1]
    return {
        "unknowns": answer["unknowns"],
        "load_steps": steps,
        "seconds": seconds,
        "newton_iterations": len(answer["newton_steps"]),
        "force_N": 4.0 * last["force_N"],  # its force is that of the quarter
        "voltage_V": last["voltage_V"],
    }


if __name__ == "__main__":
    print(json.dumps(measure(sys.argv[1], int(sys.argv[2]))))

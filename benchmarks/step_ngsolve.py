"""One Newton step of the cube by NGSolve: python -m benchmarks.step_ngsolve CELLS [SETTINGS [REPEATS]].

SETTINGS : "tuned" compiles the energy by the C++ compiler and gives PARDISO what ours gets (symmetric, nested
dissection, no refinement); "default" is what NGSolve does if nothing is said (unsymmetric, minimum degree, up to 16
steps of refinement). Both update the inverse of the step before instead of making a new one.
"""

import json
import sys

import netgen.meshing as nm
import ngsolve as ng
import numpy as np

from benchmarks.cube import BULK, SHEAR, Cube, cube
from benchmarks.timing import REPEATS, Phases
from solve.fem.quadrature import tetrahedron


def to_ngsolve(case: Cube) -> ng.Mesh:
    """The corner mesh with its base as a boundary."""
    target = nm.Mesh(dim=3)
    ids = [target.Add(nm.MeshPoint(nm.Pnt(*map(float, x)))) for x in case.points[case.corners]]
    target.SetMaterial(1, "cube")
    for a, b, c, d in case.tets[:, :4].tolist():
        target.Add(nm.Element3D(1, [ids[a], ids[c], ids[b], ids[d]]))
    face = target.Add(nm.FaceDescriptor(surfnr=1, domin=1, domout=0, bc=1))
    target.SetBCName(0, "base")
    faces = np.sort(case.tets[:, [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]].reshape(-1, 3), axis=1)
    for facet in np.unique(faces[(case.points[faces, 2] < 1e-9).all(axis=1)], axis=0).tolist():
        target.Add(nm.Element2D(face, [ids[n] for n in facet]))
    return ng.Mesh(target)


def energy(u, p):
    """Neo-Hookean, the same density as in solve/materials/laws.py."""
    f = ng.Id(3) + ng.Grad(u)
    j = ng.Det(f)
    return SHEAR / 2 * (j ** (-2 / 3) * ng.InnerProduct(f, f) - 3) + p * (j - 1) - p * p / (2 * BULK)


def measure(cells: int, settings: str, repeats: int) -> dict:
    """Medians of the phases."""
    ng.SetNumThreads(2)
    once, phases = Phases(), Phases()
    with ng.TaskManager():
        domain = to_ngsolve(cube(cells))
        space = ng.VectorH1(domain, order=2, dirichlet="base") * ng.H1(domain, order=1)
        u, p = space.TrialFunction()
        points, weights = tetrahedron()
        rule = {ng.TET: ng.IntegrationRule(points=points.tolist(), weights=weights.tolist())}
        form = ng.BilinearForm(space, symmetric=True)
        compiled = energy(u, p).Compile(realcompile=settings == "tuned", wait=True)
        form += ng.Variation(compiled * ng.dx(intrules=rule))
        state = ng.GridFunction(space)
        x, y, z = ng.x, ng.y, ng.z
        state.components[0].Set(ng.CF((0.08 * z * x, -0.06 * z * y, 0.03 * z * x - 0.05 * z * z)))
        state.components[1].Set(0.1 * x - 0.2 * z)
        residual, step = state.vec.CreateVector(), state.vec.CreateVector()

        def assemble() -> None:
            form.Apply(state.vec, residual)
            form.AssembleLinearization(state.vec)

        once("first assembly", assemble)
        flags = {"ordering": "metis", "symmetric": True, "refinement": 0} if settings == "tuned" else {}
        inverse = once(
            "analyse and factorise",
            lambda: form.mat.Inverse(space.FreeDofs(), inverse="pardiso", flags=flags),
        )
        for _ in range(repeats):
            phases("assemble", assemble)
            phases("factorise", inverse.Update)
            phases("solve", lambda: step.__setattr__("data", -inverse * residual))
        check = state.vec.CreateVector()
        check.data = form.mat * step + residual
        free = np.array(list(space.FreeDofs()))
        error = np.linalg.norm(check.FV().NumPy()[free]) / np.linalg.norm(residual.FV().NumPy()[free])
    vertex = [space.GetDofNrs(ng.NodeId(ng.VERTEX, v)) for v in range(domain.nv)]
    corner, values = np.array(vertex), step.FV().NumPy()
    answer = {
        "corners": float(np.linalg.norm(values[corner[:, :3]])),
        "pressure": float(np.linalg.norm(values[corner[:, 3]])),
    }
    return {
        "unknowns": int(free.sum()),
        "elements": domain.ne,
        "seconds": phases.medians(),
        "once": once.medians(),
        "linear_residual": float(error),
        "step": answer,
    }


if __name__ == "__main__":
    chosen = sys.argv[2] if len(sys.argv) > 2 else "tuned"
    print(json.dumps(measure(int(sys.argv[1]), chosen, int(sys.argv[3]) if len(sys.argv) > 3 else REPEATS)))

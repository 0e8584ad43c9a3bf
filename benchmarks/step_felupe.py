"""Assembly and one Newton step of the cube by FElupe: python -m benchmarks.step_felupe CELLS LAW [REPEATS].

LAW : "displacement" (quadratic displacement alone, W = G/2 (I1 - 3) + K/2 (J - 1)^2 at a nu of 0.3) or "mixed" (its
displacement-pressure-volume form with continuous linear pressure and volume ratio, nu 0.495).
"""

import json
import sys

import felupe as fem
import numpy as np
import scipy.sparse as sp

from benchmarks.cube import BULK, SHEAR, cube, state
from benchmarks.displacement_law import SOFT_BULK
from benchmarks.timing import REPEATS, Phases
from solve.fem.quadrature import tetrahedron
from solve.fem.tangent import Tangent
from solve.solution.factorisation import Pardiso


def upper_triangle(matrix: sp.csr_matrix, free: np.ndarray) -> Tangent:
    """The free part as PARDISO wants it."""
    upper = sp.triu(matrix.tocsr()[free][:, free], format="csr")
    upper.sort_indices()
    return Tangent(upper)


def measure(cells: int, law: str, repeats: int) -> dict:
    """Medians of the phases; FElupe's own threads are on."""
    case = cube(cells)
    points, weights = tetrahedron()
    rule = fem.quadrature.Scheme(points, weights)
    domain = fem.Mesh(case.points, case.tets, "tetra10")
    region = fem.RegionQuadraticTetra(domain, quadrature=rule)
    u, p = state(case.points)
    if law == "mixed":
        linear = fem.Mesh(case.points[case.corners], case.tets[:, :4], "tetra")
        field = fem.FieldsMixed(region, n=3, mesh=linear)
        field[1].values[:, 0] = p[case.corners]
        solid = fem.SolidBody(fem.NearlyIncompressible(fem.NeoHooke(mu=SHEAR, parallel=True), bulk=BULK), field)
    else:
        field = fem.FieldContainer([fem.Field(region, dim=3)])
        solid = fem.SolidBody(fem.NeoHooke(mu=SHEAR, bulk=SOFT_BULK, parallel=True), field)
    field[0].values[:] = u
    base = {"base": fem.Boundary(field[0], fz=0.0)}
    _, free = fem.dof.partition(field, base)

    def assemble() -> tuple[sp.csr_matrix, np.ndarray]:
        return solid.assemble.matrix(field, parallel=True), solid.assemble.vector(field, parallel=True)

    phases, once, direct = Phases(), Phases(), Pardiso()
    matrix, vector = once("first assembly", assemble)
    tangent = upper_triangle(matrix, free)
    once("analyse and factorise", direct.factorise, tangent)
    for _ in range(repeats):
        matrix, vector = phases("assemble", assemble)
        tangent = phases("reduce", upper_triangle, matrix, free)
        phases("factorise", direct.factorise, tangent)
        step = phases("solve", direct.back_substitute, -vector.toarray()[free, 0])
    dofs = np.zeros(matrix.shape[0])
    dofs[free] = step
    residual = float(np.linalg.norm(vector.toarray()[free]))
    answer = {"corners": float(np.linalg.norm(dofs[: 3 * len(case.corners)])), "residual": residual}
    return {
        "unknowns": len(free),
        "elements": len(case.tets),
        "seconds": phases.medians(),
        "once": once.medians(),
        "step": answer,
    }


if __name__ == "__main__":
    count = int(sys.argv[3]) if len(sys.argv) > 3 else REPEATS
    print(json.dumps(measure(int(sys.argv[1]), sys.argv[2], count)))

"""Assembly and one Newton step of the cube by scikit-fem: python -m benchmarks.step_skfem CELLS [REPEATS].

The forms are those of its example 36 (nearly incompressible hyperelasticity, quadratic and linear tetrahedra), written
for the same energy as ours.
"""

import json
import sys

import numpy as np
import scipy.sparse as sp
import skfem as sk
from skfem.helpers import ddot, det, grad, identity, inv, transpose

from benchmarks.cube import BULK, SHEAR, cube
from benchmarks.timing import REPEATS, Phases
from solve.fem.quadrature import tetrahedron
from solve.fem.tangent import Tangent
from solve.solution.factorisation import Pardiso


def _state(w):
    f = grad(w["u"]) + identity(grad(w["u"]))
    return f, det(f), transpose(inv(f)), w["p"]


def stress(w):
    """P = J^(-2/3) G (F - I1/3 F^-t) + p J F^-t."""
    f, j, g, p = _state(w)
    return SHEAR * j ** (-2 / 3) * (f - ddot(f, f) / 3 * g) + p * j * g


def stiffness(h, w):
    """dP along the displacement gradient h."""
    f, j, g, p = _state(w)
    s, trace = SHEAR * j ** (-2 / 3), ddot(g, h)
    turned = np.einsum("ij...,kj...,kl...->il...", g, h, g)  # -d(F^-t)
    deviator = h - 2 / 3 * ddot(f, h) * g + ddot(f, f) / 3 * turned - 2 / 3 * trace * (f - ddot(f, f) / 3 * g)
    return s * deviator + p * j * (trace * g - turned)


FORMS = {
    "uu": sk.BilinearForm(lambda u, v, w: ddot(stiffness(grad(u), w), grad(v))),
    "up": sk.BilinearForm(lambda p, v, w: p * _state(w)[1] * ddot(_state(w)[2], grad(v))),
    "pp": sk.BilinearForm(lambda p, q, w: -p * q / BULK),  # noqa: ARG005
    "u": sk.LinearForm(lambda v, w: ddot(stress(w), grad(v))),
    "p": sk.LinearForm(lambda q, w: q * (_state(w)[1] - 1 - w["p"] / BULK)),
}


def measure(cells: int, repeats: int) -> dict:
    """Medians of the phases."""
    case = cube(cells)
    points, weights = tetrahedron()
    domain = sk.MeshTet(case.points[case.corners].T.copy(), case.tets[:, :4].T.copy())
    rule = (points.T, weights)
    basis = sk.Basis(domain, sk.ElementVector(sk.ElementTetP2()), quadrature=rule)
    scalar = sk.Basis(domain, sk.ElementTetP1(), quadrature=rule)
    x, y, z = basis.doflocs
    component = np.zeros(basis.N, int)
    for i in range(3):
        component[basis.get_dofs(elements=True).all([f"u^{i + 1}"])] = i
    u = np.choose(component, [0.08 * z * x, -0.06 * z * y, 0.03 * z * x - 0.05 * z * z])
    p = 0.1 * scalar.doflocs[0] - 0.2 * scalar.doflocs[2]
    free = np.append(np.flatnonzero(z > 1e-9), basis.N + np.arange(scalar.N))

    def assemble() -> tuple[sp.csr_matrix, np.ndarray]:
        w = {"u": basis.interpolate(u), "p": scalar.interpolate(p)}
        uu, up = FORMS["uu"].assemble(basis, **w), FORMS["up"].assemble(scalar, basis, **w)
        pp = FORMS["pp"].assemble(scalar, **w)
        vector = np.append(FORMS["u"].assemble(basis, **w), FORMS["p"].assemble(scalar, **w))
        return sp.bmat([[uu, up], [up.T, pp]], "csr"), vector

    def reduced(matrix: sp.csr_matrix) -> Tangent:
        upper = sp.triu(matrix[free][:, free], format="csr")
        upper.sort_indices()
        return Tangent(upper)

    phases, once, direct = Phases(), Phases(), Pardiso()
    matrix, vector = once("first assembly", assemble)
    once("analyse and factorise", direct.factorise, reduced(matrix))
    for _ in range(repeats):
        matrix, vector = phases("assemble", assemble)
        tangent = phases("reduce", reduced, matrix)
        phases("factorise", direct.factorise, tangent)
        step = phases("solve", direct.back_substitute, -vector[free])
    whole = np.zeros(basis.N + scalar.N)
    whole[free] = step
    corners = np.linalg.norm(whole[basis.nodal_dofs.ravel()])
    return {
        "unknowns": len(free),
        "elements": domain.nelements,
        "seconds": phases.medians(),
        "once": once.medians(),
        "step": {"corners": float(corners), "pressure": float(np.linalg.norm(whole[basis.N :]))},
    }


if __name__ == "__main__":
    print(json.dumps(measure(int(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else REPEATS)))

"""Patch test: an affine field is an equilibrium, however distorted the mesh."""

import numpy as np

from softdot.verify.body import solid_body
from softdot.verify.lattice import grid
from softdot.verify.problem import Problem
from solve.materials.parameters import NeoHookean

DISPLACEMENT_GRADIENT = np.array([[0.2, 0.1, 0.0], [0.05, -0.1, 0.1], [0.0, -0.1, -0.05]])
"""Displacement gradient."""
RUBBER = NeoHookean(youngs_modulus_MPa=3.0, poisson_ratio=0.4999)


def pressure_over_exact() -> float:
    """Nodal pressure over the exact one at the node where it is farthest off; inner nodes are free to move."""
    shape = grid([np.linspace(0.0, 1.0, 4)] * 3, jitter=0.2)
    body, affine = solid_body(shape.points, RUBBER.law, shape.tets), shape.points @ DISPLACEMENT_GRADIENT.T
    prescribed, outside = body.free_displacements(), np.unique(shape.skin)
    prescribed[outside] = affine[outside]
    body.solve(prescribed, steps=2)
    ratio = body.x[body.pressure[0]].ravel() / _pressure()
    displaced = 1.0 + float(np.abs(body.u - affine).max() / np.abs(affine).max())
    return max(float(ratio[np.abs(ratio - 1.0).argmax()]), displaced, key=lambda value: abs(value - 1.0))


def _pressure() -> float:
    """The exact pressure, K (det F - 1) with K = E / (3 (1 - 2 nu)), MPa."""
    bulk = RUBBER.youngs_modulus_MPa / (3.0 * (1.0 - 2.0 * RUBBER.poisson_ratio))
    return float(bulk * (np.linalg.det(np.eye(3) + DISPLACEMENT_GRADIENT) - 1.0))


PROBLEMS = (
    Problem(
        name="patch",
        title="Patch test: quadratic displacement with linear pressure on a distorted mesh, ν = 0.4999, 20 % strain",
        source="Irons and Razzaque, 1972; T. J. R. Hughes, The Finite Element Method, 1987, sec. 3.4",
        unit="1",
        bound_percent=1e-5,
        basis="the exact field lies in the finite-element space: round-off over 1 - 2ν",
        reference=lambda: 1.0,
        solve=pressure_over_exact,
    ),
)

"""Inflation of a thick incompressible cylinder on curved quadratic elements."""

import numpy as np

from softdot.verify.body import solid_body
from softdot.verify.lattice import disc
from softdot.verify.problem import Problem
from solve.materials.laws import InvariantLaw

MU = 1.0
"""Shear modulus of the wall."""
LAW = InvariantLaw(MU / 2.0, 0.0, 0.0, 0.0, 1e8)
STRETCH = 1.5
"""Stretch of the inner radius, 1; the outer radius is 2."""


def inner_radius(n: int) -> float:
    """Mean inner radius at the pressure of the closed form, with n elements through the wall."""
    height = 0.5 / n
    shape = disc(np.linspace(1.0, 2.0, n + 1), np.linspace(0.0, np.pi / 2, 2 * n + 1), [0.0, height])
    body = solid_body(shape.points, LAW, shape.tets)
    facets = shape.facets(lambda x: np.hypot(x[:, 0], x[:, 1]) < 1.0 + 1e-6)
    outer = np.sqrt(1.0 + (STRETCH**2 - 1.0) / 4.0)
    load = body.add_pressure(facets)
    load.value = MU * (np.log(STRETCH / outer) + (outer**-2 - STRETCH**-2) / 2.0)
    prescribed = body.free_displacements()
    prescribed[(shape.points[:, 2] == 0.0) | (shape.points[:, 2] == height), 2] = 0.0
    for axis in range(2):
        prescribed[np.abs(shape.points[:, axis]) < 1e-9, axis] = 0.0
    body.solve(prescribed, steps=4)
    nodes = np.unique(facets)
    return float(np.hypot(*(shape.points + body.u)[nodes, :2].T).mean())


PROBLEMS = (
    Problem(
        name="inflation",
        title="Inner radius of a thick neo-Hookean cylinder inflated by a follower pressure",
        source="p = μ [ln(a/b) + (b⁻² - a⁻²) / 2] of the stretches a, b (Holzapfel, Nonlinear Solid Mechanics, 2000)",
        unit="1",
        bound_percent=0.2,
        basis="third order: a fourth of the wall over the mean diameter, cubed, is 0.06 %",
        reference=lambda: STRETCH,
        solve=inner_radius,
        meshes=(2, 4),
        limit=True,
    ),
)

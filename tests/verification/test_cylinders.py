"""Inflation and torsion of incompressible neo-Hookean cylinders on curved quadratic meshes."""

import numpy as np

from softdot.verify.body import solid_body
from softdot.verify.lattice import disc
from solve.materials.laws import InvariantLaw
from tests.verification.row import agrees

MU = 1.0
LAW = InvariantLaw(MU / 2.0, 0.0, 0.0, 0.0, 1e5)


def radial_errors(n: int, inner_stretch: float) -> float:
    """Root mean square error of the inner radius relative to its growth, at the pressure of the closed form."""
    height = 0.5 / n
    shape = disc(np.linspace(1.0, 2.0, n + 1), np.linspace(0.0, np.pi / 2, 2 * n + 1), [0.0, height])
    body = solid_body(shape.points, LAW, shape.tets)
    facets = shape.facets(lambda x: np.hypot(x[:, 0], x[:, 1]) < 1.0 + 1e-6)
    outer_stretch = np.sqrt(1.0 + (inner_stretch**2 - 1.0) / 4.0)
    load = body.add_pressure(facets)
    load.value = MU * (np.log(inner_stretch / outer_stretch) + (outer_stretch**-2 - inner_stretch**-2) / 2.0)
    prescribed = body.free_displacements()
    prescribed[(shape.points[:, 2] == 0.0) | (shape.points[:, 2] == height), 2] = 0.0
    for axis in range(2):
        prescribed[np.abs(shape.points[:, axis]) < 1e-9, axis] = 0.0
    body.solve(prescribed, steps=4)
    nodes = np.unique(facets)
    radius = np.hypot(*(shape.points + body.u)[nodes, :2].T)
    return float(np.sqrt(np.mean((radius - inner_stretch) ** 2)) / (inner_stretch - 1.0))


def test_inflation_of_a_thick_cylinder_converges_to_the_closed_form():
    """p = mu [ln(la / lb) + (lb^-2 - la^-2) / 2] (Holzapfel, Nonlinear Solid Mechanics, 2000), follower pressure."""
    errors = [radial_errors(n, 1.5) for n in (2, 4, 8)]
    order = np.log2(errors[1] / errors[2])
    print(f"ROW | inflation, inner radius | 1.5 | errors {errors} | order {order:.2f} | 1 % |")
    assert errors[-1] < 0.01
    assert order > 2.5


def test_torsion_gives_the_moment_and_the_axial_force_of_the_closed_form():
    """M = pi mu psi a^4 / 2 and N = -pi mu psi^2 a^4 / 4 (Poynting) (Rivlin, Phil. Trans. R. Soc. A 242, 1949)."""
    twist, height, angle = 0.5, 0.5, np.linspace(0.0, 2.0 * np.pi, 17)
    shape = disc(np.linspace(0.0, 1.0, 5), angle, np.linspace(0.0, height, 5))
    body = solid_body(shape.points, LAW, shape.tets)
    bottom, top = shape.points[:, 2] == 0.0, shape.points[:, 2] == height
    prescribed = body.free_displacements()
    prescribed[bottom] = 0.0
    for step in np.arange(1, 5) / 4:
        c, s = np.cos(step * twist * height), np.sin(step * twist * height)
        prescribed[top] = shape.points[top] @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]) - shape.points[top]
        body.solve(prescribed)
    force, position = body.reactions()[top], (shape.points + body.u)[top]
    moment = np.sum(position[:, 0] * force[:, 1] - position[:, 1] * force[:, 0])
    agrees("torsion, moment", moment, np.pi * MU * twist / 2, 0.01)
    agrees("torsion, axial force", force[:, 2].sum(), -np.pi * MU * twist**2 / 4, 0.01)

"""Homogeneous states of a neo-Hookean block on a distorted mesh, driven at one face, against the closed forms."""

import numpy as np
import pytest

from softdot.verify.body import solid_body
from softdot.verify.lattice import grid
from solve.materials.laws import InvariantLaw
from tests.cases import for_each

INCOMPRESSIBLE = InvariantLaw(0.5, 0.0, 0.0, 0.0, 1e6)  # mu = 1
ROUNDING = 5.01e-5  # of the four decimals in the table


def nominal_stress(stretch: float, driven: tuple[int, ...], held: tuple[int, ...] = ()) -> float:
    """Reaction per undeformed area on x = 1 with the faces of some axes driven, others held."""
    shape = grid([np.linspace(0.0, 1.0, 4)] * 3, jitter=0.2)
    body = solid_body(shape.points, INCOMPRESSIBLE, shape.tets)
    prescribed = body.free_displacements()
    for axis in range(3):
        prescribed[shape.points[:, axis] == 0.0, axis] = 0.0
        if axis in driven + held:
            prescribed[shape.points[:, axis] == 1.0, axis] = stretch - 1.0 if axis in driven else 0.0
    body.solve(prescribed, steps=5)
    return body.reaction(np.flatnonzero(shape.points[:, 0] == 1.0))[0]


@pytest.mark.press
@for_each("stretch", [0.7, 0.8, 1.5, 2.0])
@for_each(
    ("power", "driven", "held"),
    [(2, (0,), ()), (5, (0, 1), ()), (3, (0,), (1,))],
    ids=["uniaxial", "equibiaxial", "plane strain"],
)
def test_nominal_stress_over_mu_is_a_difference_of_powers(stretch, power, driven, held):
    """L - L^-2, L - L^-5, L - L^-3 (Treloar, The Physics of Rubber Elasticity, 1975, ch. 5), to four decimals."""
    ours, reference = nominal_stress(stretch, driven, held), stretch - stretch**-power
    print(f"ROW | L - L^-{power}, L = {stretch} | {reference:.6f} | {ours:.6f} | {ours - reference:+.1e} | 5e-5")
    assert ours == pytest.approx(reference, abs=5e-5)

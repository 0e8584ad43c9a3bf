"""Coulomb's law: a sheared column sticks to a plate, and then slips.

A column whose levels keep plane is in one homogeneous state, compressed to a and sheared by g. With
W = G/2 (J^(-2/3) I1 - 3) + K/2 (J - 1)^2, I1 = 2 + g^2 + a^2 and J = a, its forces per area are closed forms.
"""

import numpy as np
from scipy.optimize import brentq

from softdot.verify.dragged_block import DraggedBlock
from softdot.verify.lattice import grid
from softdot.verify.problem import Problem
from solve.materials.laws import InvariantLaw, bulk_modulus

DEPTH, SHEAR, POISSON, COEFFICIENT = 0.04, 1.0, 0.45, 0.3
"""Compression of a column of height 1, shear modulus, Poisson's ratio and coefficient of friction."""
COMPRESSED_HEIGHT = 1.0 - DEPTH
"""Height of the compressed column."""


def shear_force(g: float) -> float:
    """Force per area along the plate at a shear g."""
    return float(SHEAR * COMPRESSED_HEIGHT ** (-2.0 / 3.0) * g)


def normal_force(g: float) -> float:
    """Force per area across the plate, which presses, at a shear g."""
    bulk = 2.0 * SHEAR * (1.0 + POISSON) / (3.0 * (1.0 - 2.0 * POISSON))
    isochoric = COMPRESSED_HEIGHT ** (-5.0 / 3.0) * (2.0 + g**2 + COMPRESSED_HEIGHT**2) / 3.0 - COMPRESSED_HEIGHT ** (
        1.0 / 3.0
    )
    return float(SHEAR * isochoric + bulk * (1.0 - COMPRESSED_HEIGHT))


def slip_limit() -> float:
    """Displacement of the plate at which it slips: the shear force is the coefficient times the normal one."""
    return float(brentq(lambda g: shear_force(g) - COEFFICIENT * normal_force(g), 0.0, 2.0, xtol=1e-15))


def tangential_force(*shares: float) -> float:
    """Force per area along the plate, pressed and then dragged in turn to these shares of the slip limit."""
    block = grid([np.linspace(0.0, 1.0, 3)] * 3)
    law = InvariantLaw(SHEAR / 2.0, 0.0, 0.0, 0.0, bulk_modulus(SHEAR, POISSON))
    column = DraggedBlock(block, law, None, COEFFICIENT, level=True)
    column.drag(0.0, -DEPTH)
    for share in shares:
        column.drag(share * slip_limit(), -DEPTH)
    return float(column.force[0])


BASIS = "homogeneous, and Coulomb's law is solved without a penalty: the tolerance of the equilibrium"
SOURCE = "Coulomb's law on a neo-Hookean column in plane strain, closed form"
PROBLEMS = (
    Problem(
        name="stick",
        title="Rubber column under a plate that drags it to nine tenths of its slip, shear force over area and G",
        source=SOURCE,
        unit="1",
        bound_percent=1e-4,
        basis=BASIS,
        reference=lambda: shear_force(0.9 * slip_limit()),
        solve=lambda: tangential_force(0.5, 0.9),
    ),
    Problem(
        name="slip",
        title="The same dragged on to three times its slip: friction coefficient times normal force",
        source=SOURCE,
        unit="1",
        bound_percent=1e-4,
        basis=BASIS,
        reference=lambda: COEFFICIENT * normal_force(slip_limit()),
        solve=lambda: tangential_force(0.9, 1.5, 3.0),
    ),
)

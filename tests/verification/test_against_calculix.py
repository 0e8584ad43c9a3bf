"""Contact of a rigid cylinder, without and with Coulomb friction, against CalculiX on the same mesh of a rubber block.

CalculiX has no pressure unknown, hence nu = 0.45. Its penalties let the bodies overlap by p / (1000 MPa/mm), less than
0.3 % of the depth, and slip elastically by tau / (200 MPa/mm); the normals of its increments lag (see ccx_slide), by
0.8 % of the tangential force in full sliding. So 1 % is allowed of the normal force, 2 % of the tangential one.
"""

import pytest

from softdot.verify.dragged_block import DraggedBlock
from softdot.verify.lattice import graded_coordinates, grid
from solve.materials.laws import InvariantLaw, bulk_modulus
from tests.verification.ccx_slide import CCX, Slide, forces
from tests.verification.row import agrees

pytestmark = [pytest.mark.evidence, pytest.mark.skipif(CCX is None, reason="CalculiX (ccx) is not installed")]
CELL_MM = 0.1
PRESS = Slide(
    radius_mm=1.0,
    depth_mm=0.1,
    slide_mm=0.0,
    youngs_modulus_MPa=1.0,
    poisson_ratio=0.45,
    friction=0.0,
    normal_penalty=1000.0,
    slip_penalty=0.0,
    press_increments=5,
    slide_increments=0,
)
DRAG = Slide(
    radius_mm=1.0,
    depth_mm=0.1,
    slide_mm=0.1,
    youngs_modulus_MPa=1.0,
    poisson_ratio=0.45,
    friction=0.3,
    normal_penalty=1000.0,
    slip_penalty=200.0,
    press_increments=5,
    slide_increments=40,
)


def block():
    """3 x 1 mm in the plane, fine under the cylinder, one cell across."""
    outside = graded_coordinates(0.5, 1.5, CELL_MM, 0.25)
    inside = [CELL_MM * i for i in range(-4, 5)]
    x = [*-outside[::-1], *inside, *outside]
    return grid((x, [-CELL_MM / 2, CELL_MM / 2], 1.0 - graded_coordinates(0.0, 1.0, CELL_MM, 0.25)[::-1]))


def dragged(case):
    shear = case.youngs_modulus_MPa / (2 * (1 + case.poisson_ratio))
    law = InvariantLaw(shear / 2, 0.0, 0.0, 0.0, bulk_modulus(shear, case.poisson_ratio))
    return DraggedBlock(block(), law, case.radius_mm, case.friction)


def test_frictionless_press(tmp_path):
    theirs, ours = forces(block(), PRESS, tmp_path), dragged(PRESS)
    for number in (1, 2, 3, 4, 5):
        depth = 0.02 * number
        force = -ours.drag(0.0, -depth)[2] / CELL_MM
        if number in (2, 5):
            agrees(f"cylinder, {depth:g} mm deep, force (N/mm)", force, -theirs[number - 1, 2] / CELL_MM, 0.01)


def test_press_and_drag_with_friction(tmp_path):
    """Stick under the press, growing slip at the edges of the contact, then full sliding."""
    theirs, ours = forces(block(), DRAG, tmp_path), dragged(DRAG)
    for number in range(1, 6):
        ours.drag(0.0, -0.02 * number)
    agrees("rough cylinder, pressed, normal force (N/mm)", -ours.force[2] / CELL_MM, -theirs[4, 2] / CELL_MM, 0.01)
    for number in range(1, 11):
        tangential, _, normal = ours.drag(0.01 * number, -0.1) / CELL_MM
        if number in (2, 4, 6, 10):
            reference = theirs[4 + 4 * number] / CELL_MM
            name = f"rough cylinder, dragged {0.01 * number:g} mm,"
            agrees(f"{name} tangential force (N/mm)", tangential, reference[0], 0.02)
            agrees(f"{name} normal force (N/mm)", -normal, -reference[2], 0.01)
    assert tangential > 0.3 * -normal  # it slides, and climbs the dent besides

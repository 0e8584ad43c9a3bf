"""The rim of a delaminated strip lies where it is said to, whatever the elements of the mesh."""

import numpy as np
import pytest

from solve.delaminations import with_rims_of_patches
from solve.model import Press
from solve.physics import Delamination, Physics
from tests.pressing import press_segment
from tests.solve.segments import materials, ridge
from tests.verification.slices import STACK, force, mesh_of

WIDTHS_MM = np.linspace(1.6, 2.3, 8)  # the elements at the base are 0.35 to 0.45 mm wide there


def loss(width_mm: float) -> float:
    """Share of the force that is lost where the base is bonded over this width only, both on the same mesh."""
    rim = Delamination("bond-base", (0.0, 0.0), width_mm, outside=True)
    tet_mesh = with_rims_of_patches(mesh_of(False), STACK, (rim,))
    bonded, loose = (
        force(
            press_segment(
                STACK, materials(), ridge(STACK), Press(indentation_mm=0.15, load_steps=1), tet_mesh, None, physics
            )
        )[-1]
        for physics in (Physics(), Physics(delaminations=(rim,)))
    )
    return 1.0 - float(loose / bonded)


@pytest.mark.press
def test_a_loose_rim_that_grows_by_less_than_an_element_costs_a_little_more_force():
    """Not in steps of whole elements: with a bonded width that shrinks by tenths of a millimetre, each costs some."""
    more = -np.diff([loss(width) for width in WIDTHS_MM])
    assert more.min() > 0.0
    assert more.max() < 5.0 * more.min()

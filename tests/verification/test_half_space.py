"""A sphere and a flat punch, frictionless, on a half-space: two finite cylinders, extrapolated in 1 / size."""

import numpy as np
import pytest

from softdot.verify.lattice import graded_coordinates
from softdot.verify.problems.contact import (
    DEPTH,
    PLANE_MODULUS,
    RADIUS,
    body_on_smooth_base,
    cylinder,
    hertz_on_half_space,
)
from tests.verification.row import agrees


@pytest.mark.press
def test_the_radius_of_contact_is_that_of_hertz():
    """a = sqrt(R d) (Johnson, Contact Mechanics, 1985, eqs. 4.22 to 4.24)."""
    _, by_area, by_moment = hertz_on_half_space()
    agrees("Hertz, radius by area in contact", by_area, np.sqrt(RADIUS * DEPTH), 0.02)
    agrees("Hertz, radius by moment of pressure", by_moment, np.sqrt(RADIUS * DEPTH), 0.02)


def punch(size: float) -> float:
    """Force of a unit disc that pushes without shear, per depth."""
    inner = np.concatenate(
        [1.0 - graded_coordinates(0.0, 1.0, 0.02, 0.25)[::-1], 1.0 + graded_coordinates(0.0, 0.2, 0.02, 0.1)[1:]]
    )
    shape = cylinder(size, inner, 0.02)
    body, prescribed = body_on_smooth_base(shape, size)
    under = (shape.points[:, 2] == 0.0) & (np.hypot(shape.points[:, 0], shape.points[:, 1]) < 1.0 + 1e-9)
    depth = 1e-4
    prescribed[under, 2] = -depth
    body.solve(prescribed, tolerance=1e-8)
    return -4.0 * body.reactions()[under, 2].sum() / depth


@pytest.mark.press
def test_flat_punch():
    """F = 2 a E* d (Johnson, Contact Mechanics, 1985, eq. 3.36)."""
    near, far = punch(12.0), punch(24.0)
    agrees("flat punch", 2.0 * far - near, 2.0 * PLANE_MODULUS, 0.01)

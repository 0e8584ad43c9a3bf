"""A sphere and a flat punch, frictionless, on a half-space: two finite cylinders, extrapolated in 1 / size."""

import numpy as np
import pytest

from geometry.dot import DotShape
from solve.materials.laws import InvariantLaw, bulk_modulus
from solve.terms.contact import HATS, SHAPES, RigidDot
from tests.verification.body import Body, solid_body
from tests.verification.lattice import Grid, disc, graded
from tests.verification.row import agrees

RADIUS, DEPTH = 40.0, 0.025  # of the sphere and its approach, so a = 1; depth / radius = 0.0006
POISSON = 0.3
PLANE_MODULUS = 1.0 / (1.0 - POISSON**2)  # E* for E = 1
SHEAR = 0.5 / (1.0 + POISSON)
LAW = InvariantLaw(SHEAR / 2.0, 0.0, 0.0, 0.0, bulk_modulus(SHEAR, POISSON))


def cylinder(size: float, inner: np.ndarray, step: float) -> Grid:
    """A quarter of a cylinder below z = 0, as deep as its radius, with elements that grow away from r = 1."""
    outer = graded(inner[-1], size, inner[-1] - inner[-2], 0.4 * size)
    depth = -graded(0.0, size, step, 0.4 * size)[::-1]
    return disc(np.concatenate([inner, outer[1:]]), np.linspace(0.0, np.pi / 2, 4), depth)


def body_on_smooth_base(shape: Grid, size: float) -> tuple[Body, np.ndarray]:
    body = solid_body(shape.points, LAW, shape.tets)
    prescribed = body.free()
    prescribed[shape.points[:, 2] == -size, 2] = 0.0
    for axis in range(2):
        prescribed[np.abs(shape.points[:, axis]) < 1e-9, axis] = 0.0
    return body, prescribed


def hertz(size: float) -> np.ndarray:
    """Force, radius of the area in contact, and radius by the second moment of the pressure, a^2 = 5/2 <r^2>."""
    edge = np.linspace(0.955, 1.06, 8)
    inner = np.concatenate([np.linspace(0.0, 0.8, 6), [0.86, 0.9, 0.94], edge, [1.1, 1.16]])
    shape = cylinder(size, inner, 0.1)
    body, prescribed = body_on_smooth_base(shape, size)
    sphere = DotShape("cap", RADIUS, RADIUS, np.zeros((1, 3)), np.zeros(3), np.eye(3))
    facets = shape.facets(lambda x: (x[:, 2] == 0.0) & (np.hypot(x[:, 0], x[:, 1]) < 1.3))
    contact = body.add_contact(facets, RigidDot(sphere, 1.0))
    body.solve(prescribed, move=[0.0, 0.0, -DEPTH])
    pressure = body.x[contact.pressure_dofs]
    force = -4.0 * contact.force(body.u, body.move, pressure)[2]
    area = 4.0 * contact.nodal_area[pressure > 1e-6 * pressure.max()].sum()
    weight = contact.area * np.einsum("qi,ki->kq", HATS, pressure[contact.index])
    position = np.einsum("qn,kni->kqi", SHAPES, (shape.points + body.u)[facets])
    moment = np.vdot(weight, position[..., 0] ** 2 + position[..., 1] ** 2) / weight.sum()
    return np.array([force, np.sqrt(area / np.pi), np.sqrt(2.5 * moment)])


@pytest.mark.press
def test_hertz():
    """F = 4/3 E* R^(1/2) d^(3/2), a = sqrt(R d) (Johnson, Contact Mechanics, 1985, eqs. 4.22 to 4.24)."""
    force, by_area, by_moment = 2.0 * hertz(32.0) - hertz(16.0)
    agrees("Hertz, force", force, 4.0 / 3.0 * PLANE_MODULUS * RADIUS**0.5 * DEPTH**1.5, 0.01)
    agrees("Hertz, radius by area in contact", by_area, np.sqrt(RADIUS * DEPTH), 0.02)
    agrees("Hertz, radius by moment of pressure", by_moment, np.sqrt(RADIUS * DEPTH), 0.02)


def punch(size: float) -> float:
    """Force of a unit disc that pushes without shear, per depth."""
    inner = np.concatenate([1.0 - graded(0.0, 1.0, 0.02, 0.25)[::-1], 1.0 + graded(0.0, 0.2, 0.02, 0.1)[1:]])
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

"""Hertz: a sphere of large radius on a half-space, as two finite cylinders extrapolated in one over their size."""

import numpy as np

from foundation.arrays import Floats
from geometry.dot import DotShape
from softdot.verify.body import ElasticBody, solid_body
from softdot.verify.lattice import Grid, disc, graded_coordinates
from softdot.verify.problem import Problem
from solve.materials.laws import InvariantLaw, bulk_modulus
from solve.terms.contact import HATS, SHAPES
from solve.terms.rigid_dot import RigidDot

RADIUS, DEPTH = 40.0, 0.025
"""Radius of the sphere and its approach: the radius of contact is 1, and depth over radius 0.0006, where Hertz is a
limit.
"""
SIZES = (12.0, 24.0)
"""Radius and height of the two cylinders, in radii of contact."""
POISSON = 0.3
PLANE_MODULUS = 1.0 / (1.0 - POISSON**2)  # E* for E = 1
SHEAR = 0.5 / (1.0 + POISSON)
"""Shear modulus for a Young's modulus of 1."""
LAW = InvariantLaw(SHEAR / 2.0, 0.0, 0.0, 0.0, bulk_modulus(SHEAR, POISSON))


def cylinder(size: float, inner: Floats, step: float) -> Grid:
    """A quarter of a cylinder below z = 0, as deep as its radius, with elements that grow away from r = 1."""
    outer = graded_coordinates(inner[-1], size, inner[-1] - inner[-2], 0.4 * size)
    depth = -graded_coordinates(0.0, size, step, 0.4 * size)[::-1]
    return disc(np.concatenate([inner, outer[1:]]), np.linspace(0.0, np.pi / 2, 4), depth)


def body_on_smooth_base(shape: Grid, size: float) -> tuple[ElasticBody, Floats]:
    """The body, and its prescribed displacements (n, 3) at the base and the planes of symmetry."""
    body = solid_body(shape.points, LAW, shape.tets)
    prescribed = body.free_displacements()
    prescribed[shape.points[:, 2] == -size, 2] = 0.0
    for axis in range(2):
        prescribed[np.abs(shape.points[:, axis]) < 1e-9, axis] = 0.0
    return body, prescribed


def hertz(size: float) -> Floats:
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


def hertz_on_half_space() -> Floats:
    """The results of hertz, without their error of the first order in one over the size."""
    near, far = hertz(SIZES[0]), hertz(SIZES[1])
    return np.asarray(2.0 * far - near)


PROBLEMS = (
    Problem(
        name="hertz",
        title="Rigid sphere on a half-space, radius of contact a fortieth of its own, force over E",
        source="Hertz, J. reine angew. Math. 92, 1882: F = 4/3 E* √R d^(3/2) (Johnson, 1985, eq. 4.23)",
        unit="1",
        bound_percent=1.5,
        basis="the half-space is extrapolated from cylinders of 12 and 24 radii of contact: (1/12)² is left, 0.7 %",
        reference=lambda: 4.0 / 3.0 * PLANE_MODULUS * RADIUS**0.5 * DEPTH**1.5,
        solve=lambda: float(hertz_on_half_space()[0]),
    ),
)

"""Patch tests: an affine field is an equilibrium, whatever the element, the law or the distortion of the mesh."""

import numpy as np

from geometry.dot import DotShape
from geometry.electrode_outlines import EVERYWHERE
from softdot.verify.body import ElasticBody, solid_body
from softdot.verify.lattice import grid
from solve.materials.film import FilmLaw, film_law
from solve.materials.parameters import (
    Hyperfoam,
    Knowles,
    Linear,
    MooneyRivlin,
    NeoHookean,
    Ogden,
    PiezoelectricFilm,
    Yeoh,
)
from solve.terms.film import film_region
from solve.terms.rigid_dot import RigidDot
from tests.cases import for_each

MEDIA = {
    "neo-hookean 0.3": NeoHookean(youngs_modulus_MPa=1.0, poisson_ratio=0.3),
    "neo-hookean 0.4999": NeoHookean(youngs_modulus_MPa=1.0, poisson_ratio=0.4999),
    "mooney-rivlin": MooneyRivlin(c10_MPa=0.3, c01_MPa=0.1, poisson_ratio=0.4995),
    "yeoh": Yeoh(c10_MPa=0.3, c20_MPa=0.03, c30_MPa=0.002, poisson_ratio=0.495),
    "knowles": Knowles(c10_MPa=0.3, b=1.0, n=3.0, poisson_ratio=0.495),
    "fung": Knowles(c10_MPa=0.3, b=1.0, poisson_ratio=0.495),
    "ogden": Ogden(mu_MPa=(0.63, 0.0012, -0.01), alpha=(1.3, 5.0, -2.0), poisson_ratio=0.495),
    "hyperfoam": Hyperfoam(mu_MPa=(0.02, 0.01), alpha=(8.0, -2.0), poisson_ratio=(0.1, 0.0)),
    "linear": Linear(youngs_modulus_MPa=1.0, poisson_ratio=0.29),
}
STRAIN = np.array([[0.2, 0.1, 0.0], [0.05, -0.1, 0.1], [0.0, -0.1, -0.05]])  # displacement gradient


def distorted():
    return grid([np.linspace(0.0, 1.0, 4)] * 3, jitter=0.2)


def surface_held(body: ElasticBody, shape, field):
    """Displacement prescribed on the whole surface, free inside."""
    prescribed = body.free_displacements()
    outside = np.unique(shape.skin)
    prescribed[outside] = field[outside]
    return prescribed


@for_each("name", MEDIA)
def test_an_affine_displacement_of_the_surface_is_affine_inside(name):
    shape = distorted()
    law = MEDIA[name].law.scale_moduli(1e6)
    law = law.scale_moduli(1.0 / law.shear_modulus)
    body, affine = solid_body(shape.points, law, shape.tets), shape.points @ STRAIN.T
    body.solve(surface_held(body, shape, affine), steps=2)
    np.testing.assert_allclose(body.u, affine, atol=1e-10)
    if not law.compressible:
        expected = law.bulk_modulus * (np.linalg.det(np.eye(3) + STRAIN) - 1.0)
        np.testing.assert_allclose(body.x[body.pressure[0]], expected, atol=1e-10 * law.bulk_modulus)


def test_an_affine_displacement_of_the_film_under_voltage_is_affine_inside():
    shape = distorted()
    si = film_law(PiezoelectricFilm(youngs_modulus_MPa=2000.0, poisson_ratio=0.29), 30.0)
    unit = 1e9  # Pa and V: stress and field of order one
    law = FilmLaw(si.stiffness / unit, si.coupling * unit, si.permittivity * unit, si.to_film_axes)
    numbers = np.arange(shape.points.size).reshape(-1, 3)
    body, affine = ElasticBody(shape.points, numbers, numbers.size), shape.points @ STRAIN.T
    voltage = body.add_unknowns(1)
    everywhere = [np.array(EVERYWHERE)]
    body.terms.append(film_region(law, shape.points, shape.tets, numbers, voltage, everywhere, 1.0))
    body.solve(surface_held(body, shape, affine), held={voltage[0]: 0.05}, steps=2)
    np.testing.assert_allclose(body.u, affine, atol=1e-10)


@for_each("name", ["neo-hookean 0.3", "neo-hookean 0.4999"])
def test_a_plate_presses_uniformly_on_a_distorted_block(name):
    """Contact patch test: the nominal contact pressure is the same at every node, the block stays a block."""
    shape = distorted()
    law = MEDIA[name].law
    body = solid_body(shape.points, law, shape.tets)
    plate = DotShape("plate", 0.0, 0.0, np.zeros((1, 3)), np.array([0.0, 0.0, 1.0]), np.eye(3))
    contact = body.add_contact(shape.facets(lambda x: x[:, 2] == 1.0), RigidDot(plate, 1.0))
    prescribed = body.free_displacements()
    for axis in range(3):
        prescribed[shape.points[:, axis] == 0.0, axis] = 0.0
    body.solve(prescribed, move=[0.0, 0.0, -0.2], steps=2)
    pressure = body.x[contact.pressure_dofs]
    np.testing.assert_allclose(pressure, pressure.mean(), rtol=1e-9)
    end = body.u[shape.points[:, 0] == 1.0, 0]
    np.testing.assert_allclose(end, end.mean(), atol=1e-10)
    np.testing.assert_allclose(body.u[:, 2], -0.2 * shape.points[:, 2], atol=1e-10)

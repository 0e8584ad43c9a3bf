"""The film as a solid: voltage of a unimorph, stiffness in short and open circuit."""

import numpy as np

from geometry.electrode_outlines import EVERYWHERE
from softdot.verify.body import ElasticBody
from softdot.verify.lattice import grid
from solve.materials.film import FilmLaw, film_law
from solve.materials.laws import LinearLaw, bulk_modulus
from solve.materials.parameters import VACUUM_PERMITTIVITY, PiezoelectricFilm
from solve.terms.film import film_region
from tests.cases import for_each
from tests.verification.row import agrees

YOUNG, POISSON, D31, EPSILON = 2e9, 0.29, 23e-12, 12.0 * VACUUM_PERMITTIVITY
OVER_ALL = [np.array(EVERYWHERE)]
VOLT = 1e9  # the unit of voltage and Pa of stress that make all entries of the tangent alike
STRESS = 1e9


def scaled_law(d31: float) -> FilmLaw:
    """The film in units of 1 m, STRESS and VOLT; only d31 couples."""
    material = PiezoelectricFilm(
        youngs_modulus_MPa=1e-6 * YOUNG,
        poisson_ratio=POISSON,
        relative_permittivity=12.0,
        d31_pC_per_N=1e12 * d31,
        d32_pC_per_N=0.0,
        d33_pC_per_N=0.0,
    )
    law = film_law(material, 0.0)
    return FilmLaw(law.stiffness / STRESS, law.coupling * VOLT, law.permittivity * VOLT**2 / STRESS, law.to_film_axes)


def stiffness(open_circuit: bool, d31: float) -> float:
    """Stress per strain in direction 1 of a free block of film, electroded on its faces 3."""
    shape = grid([np.linspace(0.0, 1.0, 4)] * 3, jitter=0.2)
    numbers = np.arange(shape.points.size).reshape(-1, 3)
    body = ElasticBody(shape.points, numbers, numbers.size)
    voltage = body.add_unknowns(1)
    body.terms.append(film_region(scaled_law(d31), shape.points, shape.tets, numbers, voltage, OVER_ALL, 1.0))
    prescribed, strain = body.free_displacements(), 1e-6
    for axis in range(3):
        prescribed[shape.points[:, axis] == 0.0, axis] = 0.0
    end = np.flatnonzero(shape.points[:, 0] == 1.0)
    prescribed[end, 0] = strain
    body.solve(prescribed, held={} if open_circuit else {voltage[0]: 0.0}, tolerance=1e-8)
    return body.reaction(end)[0] / strain * STRESS


@for_each("d31", [23e-12, 115e-12], ids=["PVDF", "five times"])
def test_open_circuit_stiffens_the_film(d31):
    """Y in short circuit, Y / (1 - k31^2) in open circuit, k31^2 = d31^2 Y / eps (IEEE Std 176-1987)."""
    short, opened = stiffness(False, d31), stiffness(True, d31)
    agrees(f"film in short circuit, d31 {d31:g}", short, YOUNG, 1e-4)
    agrees(f"film, open over short circuit, d31 {d31:g}", opened / short, 1 / (1 - d31**2 * YOUNG / EPSILON), 1e-4)


def test_unimorph_voltage_is_the_curvature_times_the_distance_from_the_neutral_axis():
    """V = d31 Y z t kappa / eps with z from the neutral axis of the two layers to the middle of the film.

    With one Poisson's ratio for both layers a uniform bend with free sides is the exact solution of elasticity.
    """
    film, substrate, soft = 28e-6, 500e-6, 0.05 * YOUNG
    bottom, curvature, length = -substrate, 0.05, 2e-3
    shape = grid((np.linspace(0.0, length, 4), np.linspace(0.0, 1e-3, 3), np.append(np.linspace(bottom, 0.0, 4), film)))
    numbers = np.arange(shape.points.size).reshape(-1, 3)
    body = ElasticBody(shape.points, numbers, numbers.size)
    above = shape.centres[:, 2] > 0.0
    shear = soft / STRESS / (2.0 * (1.0 + POISSON))
    body.add_region("substrate", LinearLaw(shear, bulk_modulus(shear, POISSON)), shape.tets[~above])
    voltage = body.add_unknowns(1)
    piezo = film_region(scaled_law(D31), shape.points, shape.tets[above], numbers, np.array([-1]), OVER_ALL, film)
    body.terms.append(piezo)
    stretch = YOUNG * film, soft * substrate
    axis = (stretch[0] * film / 2 - stretch[1] * substrate / 2) / sum(stretch)
    prescribed = body.free_displacements()
    prescribed[shape.points[:, 0] == 0.0, 0] = 0.0
    end = shape.points[:, 0] == length
    prescribed[end, 0] = curvature * length * (shape.points[end, 2] - axis)
    corner = shape.nodes(lambda x: (x[:, 0] == 0.0) & (x[:, 2] == bottom) & (x[:, 1] == 0.0))
    prescribed[corner, 1:] = 0.0
    prescribed[shape.nodes(lambda x: (x[:, 0] == 0.0) & (x[:, 2] == bottom) & (x[:, 1] == 1e-3)), 2] = 0.0
    body.solve(prescribed, held={voltage[0]: 0.0}, tolerance=1e-8)
    ours = piezo.charge(body.trial, piezo.start())[0] / piezo.capacitance()[0] * VOLT
    agrees("unimorph voltage", ours, D31 * YOUNG * (film / 2 - axis) * curvature * film / EPSILON, 0.01)

"""The film as a solid: charge when stretched, stiffness in open circuit, voltage when bent, bending under voltage."""

from functools import partial

import numpy as np

from foundation.arrays import Bools
from geometry.electrode_outlines import EVERYWHERE
from softdot.verify.body import ElasticBody
from softdot.verify.lattice import Grid, grid
from softdot.verify.problem import Problem
from solve.materials.film import FilmLaw, film_law
from solve.materials.laws import LinearLaw, bulk_modulus
from solve.materials.parameters import VACUUM_PERMITTIVITY, PiezoelectricFilm
from solve.terms.film import FilmRegion, film_region

YOUNG, POISSON, D31, EPSILON = 2e9, 0.29, 23e-12, 12.0 * VACUUM_PERMITTIVITY
"""Young's modulus (Pa), Poisson's ratio, d31 (C/N) and permittivity (F/m) of the film."""
OVER_ALL = [np.array(EVERYWHERE)]
"""An electrode over the whole film."""
VOLTAGE_UNIT = 1e9  # the unit of voltage and Pa of stress that make all entries of the tangent alike
STRESS_UNIT = 1e9
STRAIN = 1e-6
"""Strain of the stretched film."""
STRONG_D31 = 115e-12  # C/N, five times that of PVDF: a quarter of the energy couples


def scaled_law(d31: float) -> FilmLaw:
    """The law of the film in units of 1 m, STRESS_UNIT and VOLTAGE_UNIT; only d31 couples, in C/N."""
    material = PiezoelectricFilm(
        youngs_modulus_MPa=1e-6 * YOUNG,
        poisson_ratio=POISSON,
        relative_permittivity=12.0,
        d31_pC_per_N=1e12 * d31,
        d32_pC_per_N=0.0,
        d33_pC_per_N=0.0,
    )
    law = film_law(material, 0.0)
    return FilmLaw(
        law.stiffness / STRESS_UNIT,
        law.coupling * VOLTAGE_UNIT,
        law.permittivity * VOLTAGE_UNIT**2 / STRESS_UNIT,
        law.to_film_axes,
    )


def stretch_film(open_circuit: bool, d31: float) -> tuple[float, float]:
    """Stress (Pa) per strain in direction 1, and charge (C), of a free film of 1 m in all directions."""
    shape = grid([np.linspace(0.0, 1.0, 4)] * 3, jitter=0.2)
    numbers = np.arange(shape.points.size).reshape(-1, 3)
    body = ElasticBody(shape.points, numbers, numbers.size)
    voltage = body.add_unknowns(1)
    film = film_region(scaled_law(d31), shape.points, shape.tets, numbers, voltage, OVER_ALL, 1.0)
    body.terms.append(film)
    prescribed = body.free_displacements()
    for axis in range(3):
        prescribed[shape.points[:, axis] == 0.0, axis] = 0.0
    end = np.flatnonzero(shape.points[:, 0] == 1.0)
    prescribed[end, 0] = STRAIN
    body.solve(prescribed, held={} if open_circuit else {voltage[0]: 0.0}, tolerance=1e-8)
    charge = film.charge(body.trial, film.start())[0] * STRESS_UNIT / VOLTAGE_UNIT
    return float(body.reaction(end)[0]) / STRAIN * STRESS_UNIT, float(charge)


def open_over_short() -> float:
    """Stiffness of an open film over that of a short-circuited one."""
    return stretch_film(True, STRONG_D31)[0] / stretch_film(False, STRONG_D31)[0]


FILM, SUBSTRATE, SOFT, CURVATURE, LENGTH = 28e-6, 500e-6, 0.05 * YOUNG, 0.05, 2e-3
"""Thickness of film and substrate (m), modulus of the substrate (Pa), curvature (1/m) and length (m)."""


def unimorph_voltage() -> float:
    """Open-circuit voltage of a film on a soft substrate, both bent to one curvature with free sides, V."""
    bottom = -SUBSTRATE
    shape = grid((np.linspace(0.0, LENGTH, 4), np.linspace(0.0, 1e-3, 3), np.append(np.linspace(bottom, 0.0, 4), FILM)))
    numbers = np.arange(shape.points.size).reshape(-1, 3)
    body = ElasticBody(shape.points, numbers, numbers.size)
    above = shape.centres[:, 2] > 0.0
    shear = SOFT / STRESS_UNIT / (2.0 * (1.0 + POISSON))
    body.add_region("substrate", LinearLaw(shear, bulk_modulus(shear, POISSON)), shape.tets[~above])
    voltage = body.add_unknowns(1)
    film = film_region(scaled_law(D31), shape.points, shape.tets[above], numbers, np.array([-1]), OVER_ALL, FILM)
    body.terms.append(film)
    prescribed = body.free_displacements()
    prescribed[shape.points[:, 0] == 0.0, 0] = 0.0
    end = shape.points[:, 0] == LENGTH
    prescribed[end, 0] = CURVATURE * LENGTH * (shape.points[end, 2] - _neutral_axis())
    corner = shape.nodes(lambda x: (x[:, 0] == 0.0) & (x[:, 2] == bottom) & (x[:, 1] == 0.0))
    prescribed[corner, 1:] = 0.0
    prescribed[shape.nodes(lambda x: (x[:, 0] == 0.0) & (x[:, 2] == bottom) & (x[:, 1] == 1e-3)), 2] = 0.0
    body.solve(prescribed, held={voltage[0]: 0.0}, tolerance=1e-8)
    return float(film.charge(body.trial, film.start())[0] / film.capacitance()[0] * VOLTAGE_UNIT)


def _neutral_axis() -> float:
    """Height of the neutral axis above the interface of film and substrate, m."""
    stretch = YOUNG * FILM, SOFT * SUBSTRATE
    return (stretch[0] * FILM / 2 - stretch[1] * SUBSTRATE / 2) / sum(stretch)


BIMORPH_LENGTH, BIMORPH_WIDTH, LAYER = 0.1, 5e-3, 0.5e-3
"""Length, width and thickness of one layer of the bimorph, m."""
BIMORPH_D31 = 23e-12
"""Coefficient of the bimorph, C/N, with d31 Y = 0.046 C/m2."""


def bimorph_tip() -> float:
    """Deflection (m) of the end of a cantilever of two films of opposite polarity under 1 V across both."""
    axes = np.linspace(0.0, BIMORPH_LENGTH, 21), [0.0, BIMORPH_WIDTH], [-LAYER, 0.0, LAYER]
    shape = grid([np.asarray(axis) for axis in axes])
    numbers = np.arange(shape.points.size).reshape(-1, 3)
    body = ElasticBody(shape.points, numbers, numbers.size)
    voltage = body.add_unknowns(2)
    for index, (sign, own) in enumerate(((1.0, shape.centres[:, 2] > 0.0), (-1.0, shape.centres[:, 2] < 0.0))):
        body.terms.append(_poled_film(sign, shape, own, numbers, voltage[index : index + 1]))
    prescribed = body.free_displacements()
    fixed = shape.points[:, 0] == 0.0
    prescribed[fixed, 0] = 0.0
    prescribed[fixed & (shape.points[:, 2] == 0.0), 2] = 0.0
    prescribed[fixed & (shape.points[:, 2] == 0.0) & (shape.points[:, 1] == 0.0), 1] = 0.0
    body.solve(prescribed, held=dict.fromkeys(voltage, 0.5 / VOLTAGE_UNIT), tolerance=1e-6)
    end = (shape.points[:, 0] == BIMORPH_LENGTH) & (shape.points[:, 2] == 0.0)
    return abs(float(body.u[end, 2].mean()))


def _poled_film(sign: float, shape: Grid, own: Bools, numbers: np.ndarray, voltage: np.ndarray) -> FilmRegion:
    """A layer of film with its poling along +z or -z, by the sign."""
    law = scaled_law(sign * BIMORPH_D31)
    return film_region(law, shape.points, shape.tets[own], numbers, voltage, OVER_ALL, LAYER)


PROBLEMS = (
    Problem(
        name="film-stretch",
        title="Charge of a film, 1 m in all directions, stretched by 1e-6 along its draw direction",
        source="D₃ = d₃₁ σ (IEEE Std 176-1987)",
        unit="C",
        bound_percent=1e-3,
        basis="homogeneous, on a distorted mesh: the strain squared and the tolerance of the equilibrium",
        reference=lambda: D31 * YOUNG * STRAIN,
        solve=lambda: stretch_film(False, D31)[1],
    ),
    Problem(
        name="film-open-circuit",
        title="Stiffness of a film in open over short circuit, d₃₁ five times that of PVDF",
        source="1 / (1 - k²), k² = d₃₁² Y / ε (IEEE Std 176-1987)",
        unit="1",
        bound_percent=1e-3,
        basis="homogeneous, on a distorted mesh: the strain squared and the tolerance of the equilibrium",
        reference=lambda: 1.0 / (1.0 - STRONG_D31**2 * YOUNG / EPSILON),
        solve=open_over_short,
    ),
    Problem(
        name="unimorph",
        title="Film on a soft substrate, bent: open-circuit voltage",
        source="V = d₃₁ Y z κ t / ε, z from the neutral axis to the middle of the film (composite beam)",
        unit="V",
        bound_percent=0.2,
        basis="a uniform bend is exact for one Poisson's ratio; curvature times thickness, 3e-5, and 1e-3 of its end",
        reference=lambda: D31 * YOUNG * (FILM / 2 - _neutral_axis()) * CURVATURE * FILM / EPSILON,
        solve=unimorph_voltage,
    ),
    Problem(
        name="bimorph",
        title="Cantilever of two films of opposite polarity under 1 V, deflection of its end",
        source="Tzou and Tseng, J. Sound Vib. 138, 1990; Hwang and Park, AIAA J. 31, 1993, p. 930: 3.45e-7 m",
        unit="m",
        bound_percent=1.0,
        basis="the reference has three digits, 0.15 %; beam theory leaves out the clamped end, width over length 5 %",
        reference=lambda: 3.0 / 2.0 * BIMORPH_D31 * (BIMORPH_LENGTH / (2.0 * LAYER)) ** 2,
        solve=partial(bimorph_tip),
    ),
)

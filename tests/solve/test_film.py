"""The film alone: charge and voltage of uniform strains against the vendor's formulas."""

import numpy as np
import pytest

from geometry.electrode_outlines import EVERYWHERE, rectangle_corners
from solve.materials.film import film_law
from solve.materials.parameters import VACUUM_PERMITTIVITY, PiezoelectricFilm
from solve.terms.film import film_region
from tests.cases import for_each
from tests.solve.box import box
from tests.solve.trial import trial

THICKNESS = 28e-6
SIZE = (2.5e-3, 2.5e-3, THICKNESS)
AREA = SIZE[0] * SIZE[1]


def film(material, angle_deg=0.0, outlines=(EVERYWHERE,)):
    points, tets = box(2, SIZE)
    dofs = np.arange(points.size).reshape(-1, 3)
    voltage = np.full(len(outlines), -1)
    return points, film_region(
        film_law(material, angle_deg), points, tets, dofs, voltage, [np.array(one) for one in outlines], THICKNESS
    )


def charge_of(region, displacement):
    """Short-circuit charge of each electrode."""
    return region.charge(trial(displacement), region.start())


def stretched(points, material, stress):
    """Displacement under a uniform small stress (11, 22, 33) by Hooke's law."""
    e, nu = 1e6 * material.youngs_modulus_MPa, material.poisson_ratio
    s = np.array(stress)
    return points * ((1 + nu) * s - nu * s.sum()) / e


PVDF = PiezoelectricFilm(youngs_modulus_MPa=2500.0, poisson_ratio=0.29)


@for_each(("stress", "d"), [((1e4, 0, 0), 23.0), ((0, 1e4, 0), 2.3), ((0, 0, 1e4), -33.0)])
def test_charge_of_a_uniform_stress_is_d_times_stress_times_area(stress, d):
    points, region = film(PVDF)
    charge = charge_of(region, stretched(points, PVDF, stress))[0]
    assert charge == pytest.approx(1e-12 * d * 1e4 * AREA, rel=1e-4)  # 1e-4: the strain is not infinitesimal


def test_vendor_voltage_per_stress():
    """V = g31 s t: 6.05 V per MPa for 28 um with g31 = 0.216 (the datasheet's constants give 6.06)."""
    points, region = film(PVDF)
    charge = charge_of(region, stretched(points, PVDF, (1e4, 0, 0)))[0]
    assert 100 * charge / region.capacitance()[0] == pytest.approx(6.06, rel=2e-3)


def test_capacitance_of_a_segment():
    """eps A / t = 23.7 pF for 2.5 x 2.5 mm, 28 um and a relative permittivity of 12."""
    assert film(PVDF)[1].capacitance()[0] == pytest.approx(12 * VACUUM_PERMITTIVITY * AREA / THICKNESS)


@for_each(("angle", "d"), [(90.0, 2.3), (45.0, (23.0 + 2.3) / 2), (180.0, 23.0)])
def test_draw_angle_turns_the_coupling(angle, d):
    """d(angle) along x = d31 cos^2 + d32 sin^2."""
    points, region = film(PVDF, angle)
    charge = charge_of(region, stretched(points, PVDF, (1e4, 0, 0)))[0]
    assert charge == pytest.approx(1e-12 * d * 1e4 * AREA, rel=1e-4)


def test_half_an_electrode_collects_half_the_charge_at_the_same_voltage():
    points, region = film(
        PVDF, outlines=(rectangle_corners(0.0, 1.25e-3, -1, 1), rectangle_corners(1.25e-3, 2.5e-3, -1, 1))
    )
    charge = charge_of(region, stretched(points, PVDF, (1e4, 0, 0)))
    assert charge[0] == pytest.approx(charge[1])
    assert charge.sum() == pytest.approx(23e-12 * 1e4 * AREA, rel=1e-4)
    voltage = 23e-12 * 1e4 * THICKNESS / (12 * VACUUM_PERMITTIVITY)
    assert charge / region.capacitance() == pytest.approx([voltage, voltage], rel=1e-4)


def test_stiffness_across_the_draw_direction():
    """A pull across sees the other modulus: E22 = s / E2."""
    material = PiezoelectricFilm(youngs_modulus_MPa=2500.0, youngs_modulus_2_MPa=2000.0, poisson_ratio=0.29)
    compliance = np.linalg.inv(film_law(material, 0.0).stiffness)
    assert compliance[0, 0] == pytest.approx(1 / 2.5e9)
    assert compliance[1, 1] == pytest.approx(1 / 2.0e9)
    turned = np.linalg.inv(film_law(material, 90.0).stiffness)
    assert turned[0, 0] == pytest.approx(1 / 2.0e9)


def test_large_rotation_gives_no_charge():
    points, region = film(PVDF)
    c, s = np.cos(0.7), np.sin(0.7)
    turned = points @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]).T - points
    reference = charge_of(region, stretched(points, PVDF, (1e4, 0, 0)))[0]
    assert abs(charge_of(region, turned)[0]) < 1e-9 * reference

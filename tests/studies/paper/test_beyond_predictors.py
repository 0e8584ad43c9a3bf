"""The corrected design parameters against limits that mechanics demands, the paper's against its tables."""

from dataclasses import replace

import numpy as np
import pytest

from softdot.studies.paper.beyond.designs import PAPERS
from softdot.studies.paper.beyond.predictors import (
    CONTACT_MM,
    clamped_deflection,
    clamped_voltage_V,
    columns,
    film,
    free_force_N_per_mm,
    free_voltage_V,
    papers_parameters,
    shape_factor,
    spread_softness,
)
from softdot.studies.paper.segment import INDENTATION_MM, LENGTH_MM
from solve.materials.parameters import VACUUM_PERMITTIVITY
from tests.cases import for_each

GIVE, REST = 0.5, 0.3


def of(**changes):
    return columns([replace(PAPERS, **changes)])


def test_the_paper_s_parameters_have_its_printed_values():
    found = papers_parameters([replace(PAPERS, h1_mm=0.8, e2_MPa=5.0), replace(PAPERS, h1_mm=2.0, e2_MPa=0.05)])
    assert found["f"] == pytest.approx([0.4, 1.0])
    assert found["e"] == pytest.approx([1.0, 100.0])
    assert found["S₁"] == pytest.approx([0.064, 0.16])  # 1/MPa, as 1e-6/Pa
    assert found["S₂/S₁"] == pytest.approx([2.5, 100.0])
    assert found["S₁b"][1] == pytest.approx(0.39, rel=5e-3)


def test_a_load_over_the_whole_length_gives_the_paper_s_softness():
    depth = (LENGTH_MM - CONTACT_MM) / 2.0
    spreading, loaded = np.array([depth]), np.array([1.7])
    both = spread_softness([(spreading, np.array([1e12])), (loaded, np.array([2.0]))], 1.0)
    assert both == pytest.approx(1.7 / (LENGTH_MM * 2.0))


def test_a_spreading_load_meets_the_integral_of_its_width():
    depths = np.linspace(0.0, 0.4, 2001)
    integral = np.trapezoid(1.0 / (3.0 * (CONTACT_MM + 2.0 * depths)), depths)
    assert spread_softness([(np.array([0.4]), np.array([3.0]))], 1.0) == pytest.approx(integral, rel=1e-6)


def test_a_layer_cut_in_two_is_as_soft():
    one = spread_softness([(np.array([1.6]), np.array([2.0]))], REST)
    two = spread_softness([(np.array([0.3]), np.array([2.0])), (np.array([1.3]), np.array([2.0]))], REST)
    assert two == pytest.approx(one)


def test_a_bonded_square_strip_is_twice_as_stiff():
    assert shape_factor(np.array([LENGTH_MM / 2.0])) == pytest.approx(2.0)


def test_a_hard_backing_leaves_the_held_film_where_it_is():
    deflection, force = clamped_deflection(of(e2_MPa=1e9), GIVE, REST)
    assert deflection == pytest.approx(0.0, abs=1e-6)
    assert force > clamped_deflection(of(), GIVE, REST)[1]


def test_a_film_between_nothing_follows_a_hard_effector():
    nothing_below = of(e1_MPa=1e-3, e2_MPa=1e-9, film_um=1e-6, effector_height_mm=1e-3, h1_mm=1e-6)
    assert clamped_deflection(nothing_below, GIVE, REST)[0] == pytest.approx(INDENTATION_MM, rel=0.01)


def test_a_thicker_held_film_deflects_less_and_pushes_back_more():
    thin, thick = (clamped_deflection(of(film_um=um), GIVE, REST) for um in (9.0, 110.0))
    assert thick[0] < thin[0]
    assert thick[1] > thin[1]


def test_without_its_membrane_stiffness_the_film_changes_no_deflection():
    thin, thick = (clamped_deflection(of(film_um=um), GIVE, REST, 0.0)[0] for um in (9.0, 110.0))
    assert thick == pytest.approx(thin, rel=1e-9)


def test_held_sides_give_the_voltage_of_the_strain_they_force():
    deflection, _ = clamped_deflection(of(), GIVE, REST)
    pvdf = film()
    modulus = 1e6 * pvdf.youngs_modulus_MPa / (1 - pvdf.poisson_ratio**2)
    charge = 1e-12 * (pvdf.d31_pC_per_N + pvdf.poisson_ratio * pvdf.d32_pC_per_N) * modulus
    strain = 8.0 / 3.0 * (deflection / LENGTH_MM) ** 2
    alone = charge * strain * 28e-6 / (VACUUM_PERMITTIVITY * pvdf.relative_permittivity)
    assert clamped_voltage_V(of(), GIVE, REST) == pytest.approx(alone, rel=0.05)  # the rest is pressure on d33


def test_a_thicker_free_film_adds_only_what_the_pressure_gives():
    """Its tension is that of the media, so by stretch it gives the same voltage."""
    thin, thick = (free_voltage_V(of(film_um=um), 0.2) for um in (9.0, 52.0))
    pressure_Pa = 1e6 * free_force_N_per_mm(of()) / LENGTH_MM
    charge = -1e-12 * film().d33_pC_per_N * pressure_Pa
    added = charge * (52e-6 - 9e-6) / (VACUUM_PERMITTIVITY * film().relative_permittivity)
    assert thick - thin == pytest.approx(added)


@for_each("softer", [{"e1_MPa": 1.0}, {"e2_MPa": 0.2}, {"effector_MPa": 0.2}, {"h2_mm": 4.0}])
def test_a_softer_free_stack_pushes_back_less(softer):
    assert free_force_N_per_mm(of(**softer)) < free_force_N_per_mm(of())

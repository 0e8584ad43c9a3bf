"""The paper's formulas and the composite beam against hand calculations and the paper's own tables."""

import math

import pytest

from softdot.studies.paper.analytical.beam import (
    beam_deflection_m,
    bending_softness,
    second_moment_m4,
    shear_deflection_m,
)
from softdot.studies.paper.analytical.composite import (
    Lamina,
    bending_stiffness_Nm,
    middle_curvature_per_m,
    neutral_axis_m,
    plane_strain_modulus_Pa,
    stretch_of_deflected_strip,
)
from softdot.studies.paper.analytical.softness import (
    deflections_m,
    index_of_modulus,
    index_of_thickness,
    output_m,
    regime,
    shares,
    softness,
    softness_of_jiang,
)
from softdot.studies.paper.analytical.tables import formula_values, is_misprint
from softdot.studies.paper.published import published_numbers, table_rows
from tests.cases import for_each

L = 2.5e-3
FILM = Lamina(28e-6, 2e9)


def test_every_cell_of_tables_3_and_4_follows_from_the_formulas_but_the_bending_softness_of_0_8_and_4_mm():
    slips = [
        f"{table}.{case}.{column}"
        for table in ("table3", "table4")
        for case in table_rows(table)
        for column, ours in formula_values(table)[case].items()
        if is_misprint(published_numbers()[f"{table}.{case}.{column}"], ours)
    ]
    assert slips == ["table4.C1.S1b", "table4.C2.S1b", "table4.C5.S1b", "table4.C6.S1b"]


def test_bending_softness_of_0_8_mm_is_six_and_the_one_of_the_film_as_printed():
    assert bending_softness(L, 5e6, 0.8e-3) == pytest.approx(6.1035e-6, rel=1e-4)
    assert bending_softness(L, 2e9, 28e-6) == pytest.approx(355.9e-6, rel=1e-4)


def test_softness_in_both_definitions():
    assert softness_of_jiang(2e-3, 5e6) == pytest.approx(4e-10)  # m/Pa
    assert softness(2e-3, L, 5e6) == pytest.approx(0.16e-6)  # 1/Pa


def test_indices():
    assert index_of_thickness(0.8, 2.0) == pytest.approx(0.4)
    assert index_of_modulus(5.0, 0.05) == pytest.approx(100)


def test_the_two_media_share_the_depth_like_springs_in_series():
    delta1, delta2 = deflections_m(0.3e-3, 0.064e-6, 0.16e-6)
    assert delta1 + delta2 == pytest.approx(0.3e-3)
    assert delta1 / delta2 == pytest.approx(0.4)  # the same force through both
    assert sum(shares(1.0, 7.0)) == pytest.approx(1.0)


@for_each(
    ("s1", "s2", "line", "output"),
    [(1.0, 250.0, "medium1", 1 / 251), (1.0, 2.5, "both", 1.0), (50.0, 1.0, "medium2", 1 / 51)],
)
def test_the_three_lines_of_equation_8(s1, s2, line, output):
    assert regime(s1, s2) == line
    assert output_m(1.0, s1, s2) == pytest.approx(output)


def test_clamped_ends_are_four_times_stiffer_than_supported_ends():
    inertia = second_moment_m4(16e-3, 0.8e-3)
    supported = beam_deflection_m(1.0, L, 5e6, inertia, "supported")
    assert supported == pytest.approx(L**3 / (48 * 5e6 * 16e-3 * 0.8e-3**3 / 12))
    assert supported / beam_deflection_m(1.0, L, 5e6, inertia, "clamped") == pytest.approx(4.0)


def test_shear_of_a_beam_a_third_as_thick_as_long_outweighs_its_bending():
    bending = beam_deflection_m(1.0, L, 5e6, second_moment_m4(16e-3, 0.8e-3), "clamped")  # F l³ / (16 E b h³)
    shear = shear_deflection_m(1.0, L, 16e-3, 0.8e-3, 5e6, 0.495)  # 0.6 (1 + nu) F l / (E b h)
    assert shear / bending == pytest.approx(9.6 * 1.495 * (0.8 / 2.5) ** 2)


def test_neutral_axis_of_equal_layers_is_their_interface_and_a_lone_layer_bends_about_its_middle():
    layer = Lamina(1e-3, 5e6)
    assert neutral_axis_m([layer, layer]) == pytest.approx(1e-3)
    assert bending_stiffness_Nm([layer, layer]) == pytest.approx(Lamina(2e-3, 5e6).own_bending_stiffness_Nm)
    assert neutral_axis_m([layer]) == pytest.approx(0.5e-3)


def test_the_film_pulls_the_neutral_axis_to_28_micrometres_from_its_middle():
    axis = neutral_axis_m([FILM, Lamina(0.8e-3, 5e6)])
    assert axis - 14e-6 == pytest.approx(27.6e-6, rel=1e-3)  # 414 µm · 4 / 60


def test_an_inextensible_skin_makes_a_beam_four_times_stiffer_in_bending():
    skin, core = Lamina(1e-9, 1e20), Lamina(1e-3, 5e6)
    ratio = (bending_stiffness_Nm([skin, core]) - skin.own_bending_stiffness_Nm) / core.own_bending_stiffness_Nm
    assert ratio == pytest.approx(4.0, rel=1e-4)  # bends about its face: E h³ / 3 against E h³ / 12


def test_stretch_of_a_strip_that_is_deflected_to_a_triangle():
    u = 0.3e-3
    exact = math.hypot(L / 2, u) / (L / 2) - 1
    assert stretch_of_deflected_strip(u, L) == pytest.approx(exact, rel=0.02)
    assert stretch_of_deflected_strip(u, L) == pytest.approx(0.0288)


@for_each("ends", ["supported", "clamped"])
def test_curvature_under_the_force_is_the_moment_over_the_stiffness(ends):
    inertia, modulus = 1e-12, 5e6
    moment = {"supported": 1 / 4, "clamped": 1 / 8}[ends] * L  # of 1 N at the middle
    deflection = beam_deflection_m(1.0, L, modulus, inertia, ends)
    assert middle_curvature_per_m(deflection, L, ends) == pytest.approx(moment / (modulus * inertia))


def test_a_wide_beam_is_stiffer():
    assert plane_strain_modulus_Pa(1.0, 0.5) == pytest.approx(4 / 3)

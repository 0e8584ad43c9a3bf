"""Volumes and masses to pour, against closed forms."""

from math import pi

import pytest

from geometry.fabrication.casting import casting_kit
from geometry.fabrication.device import lone_device
from geometry.fabrication.parameters import CastingNumbers, Fabrication, castable_materials, recipe_for
from geometry.parameters import Effector, Medium

pytestmark = pytest.mark.press

SHRINKAGE = {"own": 0.04, "vnr": 0.001}
RADIUS = (1.0 + 0.64) / 1.6  # of a cap of 2 mm across and 0.8 mm high
VOLUMES = {
    ("effector", "layer"): 6.25,
    ("effector", "dome"): pi * 0.64 * (3 * RADIUS - 0.8) / 3,
    ("effector", "cylinder"): pi * 0.64 * 0.7,
    "medium1": 6.25 * 0.5,
    "medium2": 6.25 * 2.0,
}


def test_cavity_volumes_of_three_designs(design):
    for pour in design.kit.pours:
        key = pour.component if pour.component != "effector" else ("effector", design.segment.effector.shape)
        count = design.fabrication.cavities[0] * design.fabrication.cavities[1]
        expected = count * VOLUMES[key] / (1.0 - SHRINKAGE[pour.material]) ** 3
        assert pour.cavities == count
        # draft at unchanged mid-height section adds (h tan 1 degree)^2 h / 3, under a ten-thousandth here
        assert pour.cavity_volume_mm3 == pytest.approx(expected, rel=2e-4)
        assert pour.poured_volume_mm3 == pytest.approx(1.3 * pour.cavity_volume_mm3)


def test_masses_follow_volume_density_and_mix(design):
    pour = next(pour for pour in design.kit.pours if pour.component == "effector")
    assert pour.poured_mass_g == pytest.approx(pour.poured_volume_mm3 * 1.2e-3)
    # far below what can be weighed: 10 g are mixed, three parts to one
    assert pour.mixed_mass_g == 10.0
    assert dict(pour.mixed_masses_g) == pytest.approx({"A": 7.5, "B": 2.5})


def test_a_large_pour_is_mixed_as_poured(make_kit_segment):
    own = CastingNumbers(shrinkage_percent=0.0, density_g_cm3=1.1)
    segment = make_kit_segment(effector=None, medium1=Medium(thickness_mm=1.0, material="own"), length_mm=20.0)
    fabrication = Fabrication(
        casting={"own": own}, cavities=(1, 1), routes={"medium2": "sheet"}, smallest_batch_g=0.05, overfill_percent=0.0
    )
    (pour,) = casting_kit(lone_device(segment), fabrication).pours
    assert pour.mixed_mass_g == pytest.approx(20.0 * 2.5 * 1.0 * 1.1e-3, rel=2e-4)


def test_shares_by_volume_weigh_as_their_densities():
    own = CastingNumbers(
        shrinkage_percent=0.0,
        density_g_cm3=1.0,
        parts_A=2.0,
        parts_B=1.0,
        ratio_by="volume",
        density_A_g_cm3=1.0,
        density_B_g_cm3=1.5,
    )
    recipe = recipe_for("own", Fabrication(casting={"own": own}))
    assert dict(recipe.masses_g(7.0)) == pytest.approx({"A": 4.0, "B": 3.0})


def test_one_component_has_no_second_cup():
    own = CastingNumbers(shrinkage_percent=0.0, density_g_cm3=1.0, parts_B=0.0)
    assert recipe_for("own", Fabrication(casting={"own": own})).masses_g(5.0) == (("A", 5.0),)


def test_every_built_in_recipe_is_plausible_and_has_a_source():
    for material in castable_materials(Fabrication()):
        recipe = recipe_for(material, Fabrication())
        assert 0.0 < recipe.shrinkage <= 0.02
        assert 0.9 < recipe.density_g_cm3 < 1.3
        assert recipe.source
        assert recipe.release


def test_a_stand_in_is_said(make_kit_segment):
    fabrication = Fabrication(cavities=(1, 1), routes={"medium1": "sheet", "medium2": "sheet"})
    (pour,) = casting_kit(lone_device(make_kit_segment(effector=Effector())), fabrication).pours
    assert (pour.material, pour.recipe) == ("rubber", "rtv615")
    assert "stands in" in pour.note

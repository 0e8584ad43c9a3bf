"""Mechanisms as changes of a model."""

from dataclasses import replace

import numpy as np
import pytest

from geometry.parameters import Dot
from solve.materials.parameters import Hyperfoam, Knowles, MooneyRivlin, Ogden, Yeoh
from solve.mechanisms import Mechanism, with_mechanisms
from solve.model import Model, Press, Readout
from solve.readout.amplifier import amplify
from solve.terms.guide import GuideFriction
from tests.cases import for_each
from tests.solve.segments import materials, segment


@pytest.fixture
def model():
    return Model(segment(), materials(), Dot(standard="marburg-medium"))


def switched(model, name, component, **parameters):
    return with_mechanisms(model, [Mechanism(name=name, component=component, parameters=parameters)])


@for_each(
    ("name", "component", "parameters"),
    [
        ("viscoelasticity", "medium2", {"relative_moduli": [0.0], "relaxation_times_s": [0.5]}),
        ("stress-softening", "medium2", {"loss_ratio": 0.0}),
        ("delamination", "bond-film-medium2", {"diameter_mm": 0.0}),
        ("friction", "dot", {"coefficient": 0.0}),
        ("dot-offset", "dot", {"offset_mm": [0.0, 0.0]}),
        ("contact-gap", "dot", {"gap_mm": 0.0}),
        ("rig-compliance", "rig", {"compliance_mm_per_N": 0.0}),
        ("film-prestretch", "film", {}),
        ("inertia", "rig", {"moving_mass_g": 0.0}),
        ("guide-friction", "rig", {"friction_force_N": [0.0], "presliding_mm": [0.01]}),
        ("viscous-guide", "rig", {"viscous_N_s_per_mm": 0.0}),
        ("hysteresis", "film", {"play_shares": [0.0], "play_pC": [1.0]}),
        ("pyroelectric-drift", "film", {"temperature_step_K": 0.0}),
        ("contact-electrification", "film", {"charge_pC": 0.0}),
        ("property-error", "medium2", {}),
        ("property-error", "dot", {}),
    ],
)
def test_an_off_value_leaves_the_model_as_it_is(model, name, component, parameters):
    assert replace(switched(model, name, component, **parameters), mechanisms=()) == model


def test_leakage_is_parallel_to_the_resistance_that_is_there(model):
    """3 and 6 MOhm are 2 MOhm; alone it is itself."""
    assert switched(model, "charge-leakage", "readout", resistance_MOhm=6.0).readout.input_resistance_MOhm == 6.0
    with_three = Model(model.segment, model.materials, model.dot, readout=Readout(input_resistance_MOhm=3.0))
    both = switched(with_three, "charge-leakage", "readout", resistance_MOhm=6.0)
    assert both.readout.input_resistance_MOhm == pytest.approx(2.0)


def test_capacitances_add_and_the_lower_limit_counts(model):
    start = Model(model.segment, model.materials, model.dot, readout=Readout(input_capacitance_pF=20.0, limit_V=2.0))
    assert switched(start, "parasitic-capacitance", "readout", capacitance_pF=5.0).readout.input_capacitance_pF == 25.0
    for limit_V, shown_V in ((3.0, 2.0), (1.0, 1.0)):
        on = switched(start, "saturation", "readout", limit_V=limit_V)
        charge = np.array([0.0, 1e-6])  # some kV on 100 pF
        assert amplify(np.array([0.0, 1e-3]), charge, 100e-12, on.readout, on.physics)[-1] == shown_V


def test_a_guide_does_not_rub_where_a_force_drives(model):
    """Nobody knows what of the force a guide takes: it is refused."""
    driven = replace(model, press=Press(force_N=1.0))
    with pytest.raises(ValueError, match=r"press\.indentation_mm"):
        switched(driven, "guide-friction", "rig", friction_force_N=[0.3], presliding_mm=[0.02])


def test_sliders_of_two_guides_rub_side_by_side(model):
    once = switched(model, "guide-friction", "rig", friction_force_N=[0.3], presliding_mm=[0.02])
    twice = switched(once, "guide-friction", "rig", friction_force_N=[0.1], presliding_mm=[0.2])
    assert twice.physics.added == (GuideFriction((0.3,), (0.02,)), GuideFriction((0.1,), (0.2,)))


def test_offsets_and_gaps_add(model):
    once = switched(model, "dot-offset", "dot", offset_mm=[0.1, 0.2])
    twice = switched(switched(once, "dot-offset", "dot", offset_mm=[0.1, 0.0]), "contact-gap", "dot", gap_mm=0.03)
    assert twice.dot.offset_mm == pytest.approx((0.2, 0.2))
    assert twice.dot.gap_mm == 0.03


@for_each(
    ("parameters", "kind"),
    [
        ({"c20_MPa": 0.1}, Yeoh),
        ({"b": 0.5, "n": 3.0}, Knowles),
        ({"b": 0.5}, Knowles),
        ({"c10_MPa": 0.1, "c01_MPa": 0.05}, MooneyRivlin),
        ({"mu_MPa": [0.3], "alpha": [2.0]}, Ogden),
    ],
)
def test_stiffening_takes_the_law_whose_constants_are_given(model, parameters, kind):
    changed = switched(model, "hyperelastic-stiffening", "medium2", **parameters).materials["medium2"]
    assert isinstance(changed, kind)
    assert changed.poisson_ratio == model.materials["medium2"].poisson_ratio


def test_a_yeoh_law_without_c10_keeps_the_modulus_of_the_layer(model):
    changed = switched(model, "hyperelastic-stiffening", "medium2", c20_MPa=0.1).materials["medium2"]
    assert changed.shear_modulus_MPa == pytest.approx(model.materials["medium2"].shear_modulus_MPa)


def test_foam_and_property_error_change_one_layer_only(model):
    foam = switched(model, "foam-densification", "medium2", mu_MPa=[0.1], alpha=[10.0], poisson_ratio=[0.05])
    assert isinstance(foam.materials["medium2"], Hyperfoam)
    assert foam.materials["medium1"] == model.materials["medium1"]
    stiff = switched(model, "property-error", "medium1", modulus_factor=2.0, thickness_factor=1.5)
    assert stiff.materials["medium1"].youngs_modulus_MPa == 10.0
    assert stiff.segment.medium1.thickness_mm == 0.75
    film = switched(model, "property-error", "film", d31_factor=0.5).materials["film"]
    assert film.d31_pC_per_N == 0.5 * model.materials["film"].d31_pC_per_N


def test_a_layer_of_glue_is_its_moduli_over_its_thickness(model):
    """E 0.5 MPa, nu 0.45, 50 um: M = E (1 - nu) / ((1 + nu)(1 - 2 nu)) = 1.897 MPa, G = 0.1724 MPa."""
    glue = {"thickness_um": 50.0, "youngs_modulus_MPa": 0.5, "poisson_ratio": 0.45}
    line = switched(model, "adhesive-compliance", "bond-base", **glue).physics.bonds["bond-base"]
    assert line.normal_stiffness_N_per_mm3 == pytest.approx(37.93, rel=1e-3)
    assert line.shear_stiffness_N_per_mm3 == pytest.approx(3.448, rel=1e-3)


def test_a_ridge_stands_for_a_cap_and_the_reverse(model):
    flat = switched(model, "dimension-reduction", "dot")
    assert (flat.dot.shape, flat.segment.section) == ("ridge", "plane-strain")
    back = switched(flat, "dimension-reduction", "dot")
    assert (back.dot.shape, back.segment.section) == ("cap", "solid")


def test_a_missing_layer_is_refused_in_a_sentence():
    without = Model(segment(effector=None), {k: v for k, v in materials().items() if k != "effector"}, Dot())
    with pytest.raises(ValueError, match="component = 'effector': this segment has none"):
        switched(without, "property-error", "effector", modulus_factor=2.0)

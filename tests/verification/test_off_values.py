"""Every mechanism's off value restores force and charge to round-off; switched on, it acts in the known direction."""

import numpy as np
import pytest

from geometry.dot_at_rest import resolve_dot
from geometry.parameters import Dot
from solve.mechanisms import Mechanism, with_mechanisms
from solve.model import Model, Press, Readout
from solve.readout.course import course
from tests.cases import for_each
from tests.pressing import press_segment
from tests.solve.segments import coarse_mesh, materials
from tests.verification.slices import OF_SLICES, STACK, mesh_of, waved

PRESS = Press(indentation_mm=0.2, load_steps=2)
TRAPEZOID = waved("trapezoid", 3, rise_s=0.1, hold_s=0.1, fall_s=0.1)
DOT = Dot(shape="ridge", radius_mm=1.15, height_mm=1.15)
ROUND_OFF = 1e-9


def solve(name=None, component="medium2", press=PRESS, readout=None, **parameters):
    """Result and model of a press with one mechanism."""
    model = Model(STACK, materials(), DOT, press, readout)
    if name is not None:
        model = with_mechanisms(model, [Mechanism(name=name, component=component, parameters=parameters)])
    dot = resolve_dot(model.dot, model.segment)
    same = model.segment.model_copy(update={"boundary": STACK.boundary}) == STACK
    tet_mesh = mesh_of(False) if same else coarse_mesh(model.segment, dot, OF_SLICES)
    result = press_segment(model.segment, model.materials, dot, press, tet_mesh, None, model.physics, model.readout)
    assert result.converged, result.failure
    return result, model


def numbers(solved):
    """Largest force (N), its charge (C), and voltage behind the amplifier."""
    result, model = solved
    force, charge = result.trace.reaction_force_N, result.trace.film_charge_C[:, 0]
    behind = course(result, model.press, model.readout or Readout(), model.physics)
    return force.max(), charge[np.argmax(force)], behind.together_V[behind.solved[-1]]


@pytest.fixture(scope="module")
def baseline():
    return numbers(solve())


OFF = [
    ("charge-leakage", "readout", {"resistance_MOhm": 1e14}),
    ("parasitic-capacitance", "readout", {"capacitance_pF": 0.0}),
    ("saturation", "readout", {"limit_V": 1e6}),
    ("saturation", "readout", {"limit_V": 1e6, "sharpness": 4.0}),
    ("saturation", "readout", {"limit_V": 1e9, "sharpness": 2.0}),
    ("mains-hum", "readout", {"amplitude_V": 0.0}),
    ("pyroelectric-drift", "film", {"temperature_step_K": 0.0}),
    ("contact-electrification", "film", {"charge_pC": 0.0}),
    ("viscoelasticity", "medium2", {"relative_moduli": [0.0], "relaxation_times_s": [0.5]}),
    ("hyperelastic-stiffening", "medium2", {"c20_MPa": 0.0}),
    ("stress-softening", "medium2", {"loss_ratio": 0.0}),
    ("film-yield", "film", {"yield_stress_MPa": 1e9}),
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
    ("property-error", "medium2", {}),
]


@pytest.mark.press
@for_each(("name", "component", "parameters"), OFF)
def test_the_off_value_restores_the_baseline(name, component, parameters, baseline):
    np.testing.assert_allclose(numbers(solve(name, component, **parameters)), baseline, rtol=ROUND_OFF)


def test_a_stiff_bond_tends_to_the_perfect_one(baseline):
    """The defect is the bond's compliance: a tenth of it for ten times the stiffness."""
    defects = []
    for stiffness in (1e4, 1e5):
        parameters = {"normal_stiffness_N_per_mm3": stiffness, "shear_stiffness_N_per_mm3": stiffness}
        ours = numbers(solve("adhesive-compliance", "bond-film-medium2", **parameters))
        defects.append(abs(ours[1] / baseline[1] - 1.0))
    assert defects[1] < 1e-3
    assert defects[0] / defects[1] == pytest.approx(10.0, rel=0.1)


def test_stiff_sides_tend_to_the_clamped_ones(baseline):
    """Slower than their compliance: the corners of a clamped layer concentrate stress on ever shorter lengths."""
    forces = [numbers(solve("elastic-sides", "sides", stiffness_N_per_mm3=k))[0] for k in (1e5, 1e6, 1e7)]
    defects = 1.0 - np.array(forces) / baseline[0]
    assert defects[-1] < 1e-3
    assert (defects[:-1] / defects[1:] > 3.0).all()


FORCE_ON = [
    ("hyperelastic-stiffening", "medium2", {"c20_MPa": 0.5}, 1),
    ("property-error", "medium2", {"modulus_factor": 1.5}, 1),
    ("property-error", "dot", {"radius_factor": 1.2}, 1),
    ("adhesive-compliance", "bond-film-medium2", {"thickness_um": 50.0, "youngs_modulus_MPa": 0.5}, -1),
    ("elastic-sides", "sides", {"stiffness_N_per_mm3": 5.0}, -1),
    ("contact-gap", "dot", {"gap_mm": 0.05}, -1),
    ("rig-compliance", "rig", {"compliance_mm_per_N": 0.2}, -1),
    ("delamination", "bond-film-medium2", {"diameter_mm": 1.5}, -1),
]


@pytest.mark.press
@for_each(("name", "component", "parameters", "sign"), FORCE_ON)
def test_what_stiffens_raises_the_force_and_what_yields_lowers_it(name, component, parameters, sign, baseline):
    assert sign * (numbers(solve(name, component, **parameters))[0] / baseline[0] - 1.0) > 1e-6


def test_an_elastic_press_returns_to_nothing():
    """Through a friction that is too small to matter in anything but the order of the steps."""
    result = solve("friction", "dot", TRAPEZOID, coefficient=1e-12)[0]
    force, charge = np.abs(result.trace.reaction_force_N), np.abs(result.trace.film_charge_C[:, 0])
    assert force[-1] <= ROUND_OFF * force.max()
    assert charge[-1] <= ROUND_OFF * charge.max()


@pytest.mark.press
@for_each(
    ("name", "component", "parameters"),
    [
        ("viscoelasticity", "medium2", {"relative_moduli": [0.3], "relaxation_times_s": [0.2]}),
        ("film-yield", "film", {"yield_stress_MPa": 3.0}),
    ],
)
def test_what_creeps_or_yields_leaves_a_charge_when_the_dot_has_gone(name, component, parameters):
    result = solve(name, component, TRAPEZOID, **parameters)[0]
    force, charge = np.abs(result.trace.reaction_force_N), np.abs(result.trace.film_charge_C[:, 0])
    assert force[-1] <= ROUND_OFF * force.max()
    assert charge[-1] > 1e-3 * charge.max()


@pytest.mark.press
def test_a_creeping_segment_recovers_and_a_yielded_one_does_not(tmp_path):
    """Ten relaxation times after the release."""
    table = tmp_path / "rest.csv"
    table.write_text("time_s,fraction\n0,0\n0.1,1\n0.2,1\n0.3,0\n1.3,0\n2.3,0\n", "utf-8")
    press = waved("file", 1, file=str(table))
    left = []
    for name, component, parameters in (
        ("viscoelasticity", "medium2", {"relative_moduli": [0.3], "relaxation_times_s": [0.1]}),
        ("film-yield", "film", {"yield_stress_MPa": 3.0}),
    ):
        charge = np.abs(solve(name, component, press, **parameters)[0].trace.film_charge_C[:, 0])
        left.append(charge[-1] / charge.max())
    assert left[0] < 1e-4
    assert left[1] > 1e-2

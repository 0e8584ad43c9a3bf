"""The reduced model against presses of the 3D model that had no part in its making: within 1 % of the peak.

Their series, relaxation times, depths and speeds are others than those of the samples and of the built-in check.
"""

from dataclasses import replace

import numpy as np
import pytest

from mesh.options import MeshOptions
from solve.materials.prony import Prony
from solve.model import Press, Readout
from solve.physics import BondLine, Physics
from solve.readout.amplifier import amplify
from solve.reduced.accuracy import SAMPLES_A_STEP, relative_error, with_samples_between
from solve.reduced.build import build_reduced
from solve.terms.rig import RigSpring
from solve.waveform import Waveform
from tests.cases import for_each
from tests.pressing import press_segment
from tests.solve.segments import cap, coarse_mesh, materials, segment

STACK = segment()
DOT = cap(STACK)
HOLD = Waveform(shape="trapezoid", rise_s=0.1, hold_s=0.3, fall_s=0.1)
SLOW = Waveform(shape="half-sine", rise_s=0.6)
CABLE = Readout(input_resistance_MOhm=1000.0, input_capacitance_pF=100.0, low_pass_Hz=60.0)
SERIES = {"medium2": (Prony((0.1, 0.2), (0.03, 0.2)),), "medium1": (Prony((0.2,), (0.5,)),)}
DEPTH_MM, PEAK = 0.3, 0.01
MESH = MeshOptions(element_size_mm=0.9, contact_element_size_mm=0.45, mesher="layered")


@pytest.fixture(scope="module")
def mesh_3d():
    return coarse_mesh(STACK, DOT, MESH)


@pytest.fixture(scope="module")
def reduced(mesh_3d):
    return build_reduced(STACK, materials(), DOT, mesh_3d, DEPTH_MM, {"medium2": 0.3, "medium1": 0.2}, cache=False)


def errors(model, mesh_3d, waveform, depth_mm, physics, gap_mm=0.0):
    """Largest errors of force, charge and voltage over a press, as shares of the 3D model's largest; and the bounds.

    The reduced model gets the 3D model's depth in steps twenty times finer for force and charge; for the voltage in
    the same steps, so that both circuits see a charge that is linear between the same instants.
    """
    press = Press(indentation_mm=depth_mm, load_steps=12, waveform=waveform)
    dot = replace(DOT, origin_mm=DOT.origin_mm + np.array([0.0, 0.0, gap_mm]))
    result = press_segment(STACK, materials(), dot, press, mesh_3d, physics=physics)
    assert result.converged
    trace, depth = result.trace, 1e3 * result.trace.indentation_m
    time = with_samples_between(trace.time_s)
    fine = model.respond(time, np.interp(time, trace.time_s, depth), physics, CABLE, gap_mm=gap_mm)
    same = model.respond(trace.time_s, depth, physics, CABLE, gap_mm=gap_mm)
    charge = trace.film_charge_C[:, 0]
    voltage = amplify(trace.time_s, charge, float(result.capacitance_F[0]), CABLE, physics)
    pairs = {
        "force": (fine.force_N[::SAMPLES_A_STEP], trace.reaction_force_N, fine.error_bound.force_N),
        "charge": (fine.charge_C[::SAMPLES_A_STEP], charge, fine.error_bound.charge_C),
        "voltage": (same.voltage_V, voltage, same.error_bound.voltage_V),
    }
    found = {name: relative_error(ours, wanted) for name, (ours, wanted, _) in pairs.items()}
    bounds = {name: bound / np.abs(wanted).max() for name, (_, wanted, bound) in pairs.items()}
    return found, bounds


CASES = {
    "rate-independent": (HOLD, 0.27, Physics(inelastic={"medium2": (Prony((0.0,), (1.0,)),)}), 0.0),
    "hold and release": (HOLD, 0.3, Physics(inelastic=SERIES), 0.0),
    "slow and shallower": (SLOW, 0.2, Physics(inelastic=SERIES), 0.0),
    "less relaxation": (HOLD, 0.25, Physics(inelastic={"medium2": (Prony((0.15,), (1.0,)),)}), 0.0),
    "compliant rig": (HOLD, 0.3, Physics(inelastic=SERIES, terms=(RigSpring(0.2),)), 0.0),
    "gap": (HOLD, 0.3, Physics(inelastic=SERIES), 0.03),
}


@pytest.mark.evidence
@for_each("case", CASES)
def test_the_reduced_model_answers_as_the_3d_model_does(case, reduced, mesh_3d):
    waveform, depth_mm, physics, gap_mm = CASES[case]
    found, bounds = errors(reduced, mesh_3d, waveform, depth_mm, physics, gap_mm)
    assert max(found.values()) <= PEAK
    assert all(found[name] <= bounds[name] for name in found)


@pytest.mark.evidence
def test_a_viscous_bond_and_film_answer_as_in_the_3d_model(mesh_3d):
    name, bonds = "bond-film-medium2", {"bond-film-medium2": BondLine(20.0, 5.0)}
    relaxing = {name: 0.4, "film": 0.1}
    model = build_reduced(
        STACK, materials(), DOT, mesh_3d, DEPTH_MM, relaxing, Physics(bonds=bonds), check=False, cache=False
    )
    inelastic = {name: (Prony((0.4,), (0.1,)),), "film": (Prony((0.1,), (0.3,)),)}
    found, _ = errors(model, mesh_3d, HOLD, DEPTH_MM, Physics(bonds=bonds, inelastic=inelastic))
    assert max(found.values()) <= PEAK

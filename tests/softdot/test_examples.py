"""Every example runs, and gives a number that is known from elsewhere.

The plane-strain ones are held against an independent finite-element code (forces to 0.01 N, voltages to 1 mV of
volts over the paper's factor of 337). The solid ones are held against the other mesher, against Hertz and against
each other, on coarse meshes. The short ones of mechanisms and laws all pass the checks of a run; what a few of them
must show exactly is known in closed form.
"""

import functools
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mesh.options import MeshOptions
from softdot.case import Case
from softdot.config.hashes import config_hash
from softdot.config.loading import load_config
from softdot.config.model import model_of
from softdot.config.schema import Config
from softdot.pressed import Pressed
from softdot.run_folder import run_case
from softdot.summary import history
from solve.mechanisms import MECHANISMS
from solve.readout.course import course
from solve.result import PressResult
from tests.cases import for_each
from tests.softdot.stand_ins import AtOnce

FOLDER = Path(__file__).parents[2] / "examples"
SHORT = FOLDER / "mechanisms"
NOT_RUN = ("sweep", "array-cell", "array-designs", "rig")  # spaces, several segments, a recording
SPACES = FOLDER / "families"
RUNS = sorted(path for path in FOLDER.rglob("*.toml") if path.stem not in NOT_RUN and path.parent != SPACES)
LAWS = ("mooney-rivlin", "yeoh", "knowles", "ogden", "hyperfoam")
FACTOR = 337  # the paper's ratio of simulated to measured voltage
SOLID_MESH = {"element_size_mm": 0.4, "contact_element_size_mm": 0.15}
CELL_MESH = {"element_size_mm": 0.8, "contact_element_size_mm": 0.3}


def run_of(case: Case) -> dict[str, Any]:
    """What softdot run finds, whose parts and pictures this process makes: loading their libraries takes seconds."""
    with tempfile.TemporaryDirectory() as folder:
        summary = run_case(case, Path(folder) / "out", ask=AtOnce())
    assert summary["solver"]["converged"], summary["solver"]
    return summary


@functools.cache
def summary_of(name: str, boundary: str | None = None) -> dict[str, Any]:
    """What a run of an example finds, or of it with another boundary."""
    config = load_config(FOLDER / f"{name}.toml")
    if boundary is not None:
        config = config.model_copy(update={"segment": config.segment.model_copy(update={"boundary": boundary})})
    return run_of(Case(config))


def layered(config: Config, steps: int, **sizes_mm: float) -> Config:
    """A copy with a coarse mesh of extruded layers and fewer load steps."""
    press = config.press.model_copy(update={"load_steps": steps})
    return config.model_copy(update={"mesh": MeshOptions(**sizes_mm, mesher="layered"), "press": press})


@functools.cache
def true_segment_by(mesher: str) -> Pressed:
    """The press of the true segment as it is, or on extruded layers; softdot run of it is in tests/studio."""
    config = load_config(FOLDER / "true-segment.toml")
    pressed = Case(layered(config, 3, **SOLID_MESH) if mesher == "layered" else config).press()
    assert pressed.converged, pressed.failure
    return pressed


def force_N(name: str, boundary: str | None = None) -> float:
    return summary_of(name, boundary)["reaction_force_N"][-1]


def voltage_V(name: str, boundary: str | None = None) -> float:
    return summary_of(name, boundary)["open_circuit_voltage_V"][-1]


@pytest.mark.press
def test_final_clamped_design():
    assert force_N("paper-final-clamped") == pytest.approx(14.44, rel=0.03)
    assert voltage_V("paper-final-clamped") == pytest.approx(FACTOR * 0.419, rel=0.04)


@pytest.mark.press
def test_final_free_design():
    assert force_N("paper-final-free") == pytest.approx(5.05, rel=0.03)
    assert voltage_V("paper-final-free") == pytest.approx(FACTOR * 0.058, rel=0.04)


@pytest.mark.press
def test_plane_strain_case_c1():
    """The voltage of the other code is that of C1 and F4 together; F4 differs by its free sides."""
    name = "paper-plane-strain"
    assert force_N(name) == pytest.approx(14.06, rel=0.03)
    total = voltage_V(name) + voltage_V(name, boundary="free")
    assert total == pytest.approx(FACTOR * 0.433, rel=0.04)


@pytest.mark.press
def test_readout_obeys_kirchhoff():
    """What flowed through R is what the film freed less what is left on the capacitors, through both filters.

    (C_f + C_in) V' = Q' - V / R and T U' = V - U, integrated over the press of 0.5 s:
    integral of U = R (Q - (C_f + C_in) V) - T U at its end. U is known at the load steps only, V at the end is
    R Q' within the delay. The trapezoidal rule over 12 steps of a signal that grows as t^1.7 errs by 0.5 %.
    """
    found = summary_of("readout")
    voltage = np.array(found["readout_voltage_V"])
    charge = 1e-12 * found["film_charge_pC"][-1]
    resistance, low_pass_s = 1e6, 1.0 / (2.0 * np.pi * 60.0)
    left = (1e-12 * found["film"]["capacitance_pF"] + 100e-12) * voltage[-1]
    flown = float(np.trapezoid(voltage, np.linspace(0.0, 0.5, len(voltage))))
    assert flown == pytest.approx(resistance * (charge - left) - low_pass_s * voltage[-1], rel=0.01)


def test_true_segment_is_the_default():
    assert config_hash(load_config(FOLDER / "true-segment.toml")) == config_hash(load_config())


@pytest.mark.press
def test_true_segment_agrees_with_the_other_mesher():
    """As it is, against extruded layers of other sizes."""
    own, other = true_segment_by("pytetwild"), true_segment_by("layered")
    assert own.reaction_force_N[-1] == pytest.approx(other.reaction_force_N[-1], rel=0.01)
    assert own.open_circuit_voltage_V[-1] == pytest.approx(other.open_circuit_voltage_V[-1], rel=0.02)


@pytest.mark.press
def test_dome_is_between_hertz_and_a_bonded_layer():
    """A shallow press: the dome is stiffer than a half-space of its rubber, softer than a layer on a rigid base.

    Hertz for two spheres, and Dimitriadis' factor for a bonded incompressible layer as high as the dome.
    """
    config = load_config(FOLDER / "dome.toml")
    depth, height, nu = 0.05, 0.6, 0.495
    dome_radius = (0.8**2 + height**2) / (2.0 * height)
    radius = 1.0 / (1.0 / 0.8125 + 1.0 / dome_radius)
    press = config.press.model_copy(update={"indentation_mm": depth, "load_steps": 1})
    sizes = MeshOptions(element_size_mm=0.5, contact_element_size_mm=0.15)
    shallow = config.model_copy(update={"press": press, "mesh": sizes})
    force_N = Case(shallow).press().reaction_force_N[-1]
    half_space = 4.0 / 3.0 / (1.0 - nu**2) * radius**0.5 * depth**1.5
    x = (radius * depth) ** 0.5 / height
    layer = 16.0 / 9.0 * radius**0.5 * depth**1.5 * (1 + 1.133 * x + 1.283 * x**2 + 0.769 * x**3 + 0.0975 * x**4)
    assert half_space < force_N < layer


@pytest.mark.press
def test_true_segment_is_between_half_spaces_of_its_rubbers():
    """Hertz for the softest (1 MPa) and the hardest (5 MPa) rubber: F = 4/3 E / (1 - nu^2) R^0.5 d^1.5."""
    radius, depth, nu = 0.8125, 0.3, 0.495
    per_modulus = 4.0 / 3.0 / (1.0 - nu**2) * radius**0.5 * depth**1.5
    assert 1.0 * per_modulus < true_segment_by("layered").reaction_force_N[-1] < 5.0 * per_modulus


@pytest.mark.press
def test_neighbours_never_reach_a_segment_as_wide_as_the_pitch():
    """On one mesh the whole cell gives what the pressed dot gives alone."""
    config = layered(load_config(FOLDER / "braille-cell.toml"), 2, **CELL_MESH)
    dot = config.dot.model_copy(update={"cell": None, "cell_dot": 1})
    cell, lone = Case(config), Case(config.model_copy(update={"dot": dot}))
    found, alone = run_of(cell), history(lone.solve(tet_mesh=cell.mesh))
    assert found["reaction_force_N"] == pytest.approx(alone.reaction_force_N, rel=1e-6)
    assert found["open_circuit_voltage_V"] == pytest.approx(alone.open_circuit_voltage_V, rel=1e-6)


@pytest.mark.press
def test_a_wider_segment_feels_all_six_dots():
    """Six times Hertz for the softest and the hardest rubber, in a shallow press; a lone dot is far below."""
    config = load_config(FOLDER / "braille-cell-wide.toml")
    depth, radius, nu = 0.1, 0.8125, 0.495
    press = config.press.model_copy(update={"indentation_mm": depth, "load_steps": 1})
    result = Case(config.model_copy(update={"press": press})).solve()
    per_modulus = 6.0 * 4.0 / 3.0 / (1.0 - nu**2) * radius**0.5 * depth**1.5
    assert result.converged
    assert 1.0 * per_modulus < result.steps[-1].reaction_force_N < 5.0 * per_modulus


def test_no_example_is_left_out():
    tested = {
        "paper-final-clamped", "paper-final-free", "paper-plane-strain", "readout", "true-segment", "dome",
        "braille-cell", "braille-cell-wide",
    }  # fmt: skip
    assert {path.stem for path in RUNS if path.parent == FOLDER} == tested


@for_each("path", RUNS, ids=lambda path: path.stem)
def test_every_example_passes_the_checks_of_a_run(path):
    _ = Case.load(path).checked_design


@for_each("name", MECHANISMS)
def test_every_mechanism_has_its_example(name):
    config = load_config(SHORT / f"{name}.toml")
    assert [mechanism.name for mechanism in config.mechanisms] == [name]


@for_each("name", LAWS)
def test_every_law_has_its_example(name):
    config = load_config(SHORT / f"{name}.toml")
    assert name in {material.model for material in config.materials.values()}
    assert config.mechanisms == ()


def test_every_short_example_has_its_line_and_its_picture():
    names = {path.stem for path in SHORT.glob("*.toml")}
    assert names == {*MECHANISMS, *LAWS}
    shown = (FOLDER.parent / "docs" / "mechanisms.md").read_text("utf-8")
    listed = (FOLDER / "README.md").read_text("utf-8")
    for name in names:
        assert f"(mechanisms/{name}.toml)" in listed
        assert f"(../examples/mechanisms/{name}.toml)" in shown
        pictured = "foam-densification" if name == "hyperfoam" else name  # the same law, the same picture
        assert f"(pictures/mechanisms/{pictured}.png)" in shown


@functools.cache
def press_of(name: str) -> PressResult:
    """The press of a short example, as softdot run does it."""
    case = Case.load(SHORT / f"{name}.toml")
    run_of(case)
    return case.press().result


@pytest.mark.press
def test_a_leaking_film_decays_with_its_time_constant():
    """At depth V = V0 exp(-t / (R C)), with C the film's alone."""
    told = model_of(load_config(SHORT / "charge-leakage.toml"))
    result = press_of("charge-leakage")
    recording = course(result, told.press, told.amplifier, told.physics)
    v = np.interp([0.25, 0.55], recording.time_s, recording.together_V)
    tau = 1e9 * float(result.capacitance_F[0])
    assert v[1] / v[0] == pytest.approx(np.exp(-0.3 / tau), rel=1e-4)


@pytest.mark.press
def test_a_cable_divides_the_voltage_of_the_open_film():
    """Q / (C_f + C) at every depth."""
    told = model_of(load_config(SHORT / "parasitic-capacitance.toml"))
    result = press_of("parasitic-capacitance")
    recording = course(result, told.press, told.amplifier, told.physics)
    expected = result.steps[-1].film_charge_C[0] / (result.capacitance_F[0] + 100e-12)
    assert recording.together_V[-1] == pytest.approx(expected, rel=1e-6)


@pytest.mark.press
def test_lost_motion_shifts_the_press_along_its_depth():
    """0.3 mm with a gap of 0.05 mm is 0.25 mm without: the fifth of six steps."""
    late = press_of("contact-gap")
    plain = Case(load_config(SHORT / "contact-gap.toml").model_copy(update={"mechanisms": ()})).press().result
    assert late.steps[1].reaction_force_N == pytest.approx(0.0, abs=1e-9)
    assert late.steps[-1].reaction_force_N == pytest.approx(plain.steps[5].reaction_force_N, rel=1e-6)


@pytest.mark.press
def test_the_rig_bends_by_its_compliance_times_the_force():
    trace = press_of("rig-compliance").trace
    assert 1e3 * (trace.indentation_m - trace.dot_path_m) == pytest.approx(0.005 * trace.reaction_force_N, abs=1e-9)


@pytest.mark.press
def test_a_softened_segment_gives_back_less_work_than_it_took():
    trace = press_of("stress-softening").trace
    deepest = int(np.argmax(trace.indentation_m))
    path, force = trace.indentation_m, trace.reaction_force_N
    taken = np.trapezoid(force[: deepest + 1], path[: deepest + 1])
    given_back = -np.trapezoid(force[deepest:], path[deepest:])
    assert 0.6 * taken < given_back < 0.95 * taken  # at most loss_ratio = 0.4 of it is lost


@pytest.mark.press
def test_a_film_that_flowed_is_left_with_a_charge_of_the_other_sign():
    charge = press_of("film-yield").trace.film_charge_C[:, 0]
    assert charge.max() > 0.0
    assert charge[-1] < -0.01 * charge.max()


@pytest.mark.press
def test_a_dragged_dot_is_held_back_by_friction():
    """Coulomb bounds the sideways force; the walls of the dent, up to acos(1 - 0.2 / 1.15) steep, add to it."""
    trace = press_of("friction").trace
    sideways, down = trace.contact_force_N[-1, 0], trace.contact_force_N[-1, 2]
    steepest = np.arccos(1.0 - 0.2 / 1.15)
    assert sideways < 0.0 < down
    assert 0.25 * down < -sideways < np.tan(np.arctan(0.5) + steepest) * down


@pytest.mark.press
@pytest.mark.parametrize("name", [*MECHANISMS, *LAWS])
def test_every_short_example_runs_to_its_end(name):
    assert press_of(name).converged

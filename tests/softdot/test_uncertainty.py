"""What is stated of materials, carried to force and voltage, against presses with those materials."""

import pytest

from softdot.case import Case
from softdot.config.loading import config_from
from softdot.summary import press_part
from softdot.tolerances.questions import Question
from softdot.tolerances.uncertainty import uncertainty
from solve.solution.full_load import StoppedShortError
from tests.cases import for_each

SLICE = {
    "segment": {
        "section": "plane-strain", "effector": {"height_mm": 0.5, "material": "rubber"},
        "medium1": {"thickness_mm": 0.5, "material": "dragon-skin-30"}, "film": {"thickness_um": 100.0},
        "medium2": {"thickness_mm": 0.5, "material": "ecoflex-00-30"},
    },
    "dot": {"shape": "ridge"},
    "press": {"indentation_mm": 0.05, "load_steps": 1},
    "mesh": {"element_size_mm": 0.35, "contact_element_size_mm": 0.35, "mesher": "layered"},
}  # fmt: skip


def summary(config):
    case = Case(config)
    return press_part(case.model, case.press().result, case.press().course)


def pressed(*mechanisms, mesh=None):
    """Final force and open-circuit voltage."""
    config = config_from({**SLICE, "mechanisms": list(mechanisms), "mesh": {**SLICE["mesh"], **(mesh or {})}})
    found = summary(config)
    return found["reaction_force_N"][-1], found["open_circuit_voltage_V"][-1]


def told(force_N=1.0, voltage_V=1.0):
    """What a summary says of a press of one step."""
    voltages = [0.0, voltage_V]
    electrodes = [{"name": "film", "open_circuit_voltage_V": voltages}]
    return {"reaction_force_N": [0.0, force_N], "open_circuit_voltage_V": voltages, "electrodes": electrodes}


@pytest.fixture(scope="module")
def stated():
    config = config_from(SLICE)
    return uncertainty(config, summary(config))


def part(stated, name):
    return next(one for one in stated["uncertainty"]["parts"] if one["name"].startswith(name))


def test_d31_moves_the_voltage_in_proportion_and_the_force_not_at_all(stated):
    d31 = part(stated, "piezoelectric constants of the film")
    assert (d31["voltage_percent"], d31["force_percent"]) == pytest.approx((20.0, 0.0), abs=1e-4)
    assert part(stated, "permittivity")["voltage_percent"] == pytest.approx(5.0, abs=1e-4)


@pytest.mark.parametrize(("layer", "name", "share"), [("medium1", "medium 1", 0.3), ("medium2", "medium 2", 0.5)])
def test_a_modulus_moves_force_and_voltage_as_two_presses_do(stated, layer, name, share, monkeypatch, tmp_path):
    """Central differences of presses at 1 % more and less, on the mesh on which the derivatives are taken."""
    monkeypatch.setenv("SOFTDOT_CACHE", str(tmp_path))
    coarse = {"element_size_mm": 0.7, "contact_element_size_mm": 0.7, "mesher": "layered"}
    ends = [
        pressed({"name": "property-error", "component": layer, "parameters": {"modulus_factor": f}}, mesh=coarse)
        for f in (0.99, 1.01)
    ]
    force, voltage = (100 * share * abs(up - down) / (up + down) / 0.01 for down, up in zip(*ends, strict=True))
    found = part(stated, f"modulus of {name}")
    assert (found["force_percent"], found["voltage_percent"]) == pytest.approx((force, voltage), rel=2e-3, abs=1e-4)


def test_the_whole_is_the_root_of_the_sum_of_squares(stated):
    parts = stated["uncertainty"]["parts"]
    total = sum(one["voltage_percent"] ** 2 for one in parts) ** 0.5
    assert stated["uncertainty"]["voltage_percent"] == pytest.approx(total)
    assert stated["discretisation_error"]["force_percent"] == part(stated, "mesh")["force_percent"] > 0.0


RELAXING = {
    "name": "viscoelasticity", "component": "medium2",
    "parameters": {"relative_moduli": [0.3], "relaxation_times_s": [0.2]},
}  # fmt: skip
SLIDING = {"indentation_mm": 0.05, "load_steps": 1, "path_xy_mm": [[0.4, 0.0]]}


@pytest.mark.press
@for_each(
    ("change", "reason"),
    [({"mechanisms": [RELAXING]}, "depends on its path"), ({"press": SLIDING}, "slides after it is pressed in")],
    ids=["memory", "slide"],
)
def test_what_is_not_estimated_is_said_and_nothing_is_summed(change, reason):
    """The mesh alone would promise an accuracy that nobody has; its own error is known all the same."""
    config = config_from({**SLICE, **change})
    found = uncertainty(config, summary(config))
    assert reason in found["uncertainty"]["note"]
    assert [one["name"] for one in found["uncertainty"]["parts"]] == ["mesh"]
    assert "voltage_percent" not in found["uncertainty"]
    assert found["discretisation_error"]["voltage_percent"] > 0.0


def test_an_amplifier_changes_nothing_of_force_and_open_circuit_voltage(stated):
    amplified = config_from({**SLICE, "readout": {"input_resistance_MOhm": 1.0}})
    found = uncertainty(amplified, summary(amplified))
    assert found["uncertainty"]["voltage_percent"] == pytest.approx(stated["uncertainty"]["voltage_percent"], rel=1e-6)
    assert found["uncertainty"]["note"] is None


@pytest.mark.press
@for_each("slide", [[], [[0.4, 0.0]]], ids=["press", "slide"])
def test_a_force_that_is_given_is_not_in_doubt(slide):
    config = config_from({**SLICE, "press": {"force_N": 0.1, "load_steps": 1, "path_xy_mm": slide}})
    found = uncertainty(config, summary(config))
    assert {one["force_percent"] for one in found["uncertainty"]["parts"]} == {0.0}
    assert found["discretisation_error"]["force_percent"] == 0.0 < found["discretisation_error"]["voltage_percent"]


def test_no_derivative_is_taken_that_no_part_needs(monkeypatch):
    asked = []
    monkeypatch.setattr(Question, "kept_answer", lambda question: asked.extend(question.keys) or stop())
    found = uncertainty(config_from(SLICE), told())
    assert len(asked) == 6  # four moduli, d31 and permittivity
    assert not any("thickness" in key for key in asked)
    assert "failed" in found["uncertainty"]["note"]
    assert "discretisation_error" not in found


def stop():
    raise StoppedShortError("as asked")

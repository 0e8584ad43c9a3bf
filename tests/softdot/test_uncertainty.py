"""What is stated of materials, carried to force and voltage, against presses with those materials."""

import pytest

from softdot import stages
from softdot.actual import actual
from softdot.config import config_from
from softdot.uncertainty import uncertainty

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


def pressed(*mechanisms, mesh=None):
    """Final force and open-circuit voltage."""
    config = config_from({**SLICE, "mechanisms": list(mechanisms), "mesh": {**SLICE["mesh"], **(mesh or {})}})
    changed, physics = actual(config)
    dot, _ = stages.check(changed)
    result = stages.press(changed, physics, dot, stages.build_mesh(changed, dot), lambda *_: None)
    step = result.steps[-1]
    return step.reaction_force_N, float(step.open_circuit_voltage_V[0])


@pytest.fixture(scope="module")
def stated():
    return uncertainty(config_from(SLICE), *pressed())


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


def test_a_press_whose_path_matters_says_what_is_missing():
    relaxing = {
        "name": "viscoelasticity", "component": "medium2",
        "parameters": {"relative_moduli": [0.3], "relaxation_times_s": [0.2]},
    }  # fmt: skip
    found = uncertainty(config_from({**SLICE, "mechanisms": [relaxing]}), 1.0, 1.0)["uncertainty"]
    assert "depends on its path" in found["note"]
    assert [one["name"] for one in found["parts"]] == ["mesh"]

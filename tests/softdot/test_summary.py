"""The summary of a press with a circuit and with several electrodes."""

import dataclasses
import json
from types import SimpleNamespace

import numpy as np
import pytest

from softdot.json_files import json_text
from softdot.summary import history, press_part
from solve.model import Press, Readout
from solve.physics import Physics
from solve.readout.course import course
from tests.cases import for_each
from tests.softdot.stand_ins import result_of

LAYERS = {"medium1": {"thickness_mm": 0.5}, "film": {"thickness_um": 28}, "medium2": {"thickness_mm": 2}}


def model_with(readout=None):
    """What a summary asks of a model: a ramp of half a second."""
    return SimpleNamespace(readout=readout, press=Press(), physics=Physics())


def part_of(result, readout=None):
    model = model_with(readout)
    return press_part(model, result, course(result, model.press, readout, model.physics))


def two_electrodes():
    """10 pF carrying 20 pC and 30 pF carrying 30 pC at the last of two steps."""
    charge, capacitance = np.array([20e-12, 30e-12]), np.array([10e-12, 30e-12])
    steps = [
        dataclasses.replace(step, film_charge_C=share * charge, open_circuit_voltage_V=share * charge / capacitance)
        for step, share in zip(result_of([0.0, 0.3]).steps, [0.0, 1.0], strict=True)
    ]
    whole = result_of([0.0, 0.3])
    trace = dataclasses.replace(whole.trace, film_charge_C=np.array([0.0 * charge, charge]))
    names = ("left", "right")
    return dataclasses.replace(whole, trace=trace, steps=tuple(steps), capacitance_F=capacitance, electrode_names=names)


def test_electrodes_are_read_in_parallel():
    past = history(two_electrodes())
    assert past.film_charge_pC == pytest.approx([0.0, 50.0])
    assert past.open_circuit_voltage_V == pytest.approx([0.0, 50.0 / 40.0])


def test_each_electrode_is_also_listed_by_itself():
    part = part_of(two_electrodes())
    assert [electrode["name"] for electrode in part["electrodes"]] == ["left", "right"]
    assert [electrode["capacitance_pF"] for electrode in part["electrodes"]] == pytest.approx([10.0, 30.0])
    assert part["electrodes"][1]["open_circuit_voltage_V"] == pytest.approx([0.0, 1.0])


def test_sensitivity_is_that_of_the_amplifier_and_its_noise():
    """20 pC per mm into 10 pF of film and 10 of cable: 1 V per mm."""
    part = part_of(result_of([0.0, 0.15, 0.3]), Readout(noise_V=0.01, input_capacitance_pF=10.0))
    assert part["readout_voltage_V"] == pytest.approx([0.0, 0.15, 0.3])
    assert part["sensitivity"]["at_time_s"] == pytest.approx(0.5)
    assert part["sensitivity"]["least_detectable_at_time_s"] == pytest.approx(0.5 * 0.01 / 0.3, rel=1e-3)
    assert part["sensitivity"]["voltage_per_mm"] == pytest.approx(1.0)
    assert part["sensitivity"]["least_detectable_indentation_um"] == pytest.approx(10.0)
    assert part["sensitivity"]["noise_V"] == 0.01


def test_json_has_no_nan():
    text = json_text({"a": float("nan"), "b": [np.inf, np.float64(1.0)], "c": np.arange(2), "d": np.bool_(True)})
    assert json.loads(text) == {"a": None, "b": [None, 1.0], "c": [0, 1], "d": True}


@for_each("nonsense", [np.nan, np.inf, -np.inf])
def test_a_number_that_is_none_is_no_converged_result(nonsense):
    model, result = model_with(Readout()), two_electrodes()
    along = course(result, model.press, model.readout, model.physics)
    along.together_V[-1] = nonsense
    solver = press_part(model, result, along)["solver"]
    assert not solver["converged"]
    assert solver["failure"] == "readout_voltage_V[1] is not a finite number"

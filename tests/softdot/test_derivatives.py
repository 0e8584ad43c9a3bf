"""Derivatives by the keys of a configuration."""

import numpy as np
import pytest

import softdot
from foundation.errors import InputError
from softdot import derivatives
from softdot.config.loading import config_from
from softdot.differentiation import value_of
from tests.cases import for_each

TABLES = {
    "segment": {
        "effector": {},
        "medium1": {"thickness_mm": 0.5},
        "film": {"thickness_um": 28.0},
        "medium2": {"thickness_mm": 2.0},
    },
    "press": {"indentation_mm": 0.1, "load_steps": 2},
    "readout": {"input_resistance_MOhm": 1000.0, "input_capacitance_pF": 100.0},
    "mesh": {"element_size_mm": 1.2, "contact_element_size_mm": 0.8, "mesher": "layered"},
}


def test_voltage_follows_d_and_the_circuit():
    """Q is linear in (d31, d32, d33): their derivatives times values add up to V. dV/dC < 0, dV/dR > 0."""
    film = [f"materials.pvdf.d3{i}_pC_per_N" for i in (1, 2, 3)]
    keys = [*film, "readout.input_capacitance_pF", "readout.input_resistance_MOhm"]
    config = config_from(TABLES)
    found = {one.key: one for one in derivatives(config, keys)}
    total = sum(found[key].value * found[key].readout_voltage_V for key in film)
    scaled = config_from({**TABLES, "readout": {**TABLES["readout"], "input_capacitance_pF": 100.001}})
    assert value_of(scaled, "readout.input_capacitance_pF") == 100.001
    assert total[-1] > 0.0
    assert found[keys[3]].readout_voltage_V[-1] < 0.0 < found[keys[4]].readout_voltage_V[-1]
    assert found[keys[3]].units["readout_voltage_V"] == "V/pF"
    assert "film_charge_pC" in repr(found[keys[4]])
    assert "pC/MOhm" in repr(found[keys[4]])
    open_circuit = sum(found[key].value * found[key].open_circuit_voltage_V for key in film)
    charge = sum(found[key].value * found[key].film_charge_pC for key in film)
    np.testing.assert_allclose(open_circuit[1:], charge[1:] / 23.716, rtol=1e-3)  # eps A / t in pF
    assert not found[film[0]].reaction_force_N.any()


@for_each(
    ("key", "sentence"),
    [
        ("segment.film.colour", "segment.film.colour: the configuration has no such key"),
        ("segment.section", "segment.section = 'solid': must be a number that is not zero"),
        ("segment.film.draw_angle_deg", "segment.film.draw_angle_deg = 0.0: must be a number that is not zero"),
    ],
)
def test_a_key_that_is_no_number_is_refused(key, sentence):
    with pytest.raises(InputError, match=sentence.replace("[", r"\[").replace(".", r"\.")):
        softdot.derivatives(config_from(TABLES), [key])


SLICE = {
    "segment": {
        "section": "plane-strain",
        "medium1": {"thickness_mm": 0.5},
        "film": {"thickness_um": 28.0},
        "medium2": {"thickness_mm": 2.0},
    },
    "dot": {"shape": "ridge"},
    "press": {"indentation_mm": 0.1, "load_steps": 2},
    "mesh": {"element_size_mm": 2.0, "contact_element_size_mm": 0.8, "mesher": "layered"},
    "mechanisms": [{"name": "saturation", "component": "readout", "parameters": {"limit_V": 3.0, "sharpness": 2.0}}],
}


def test_an_amplifier_that_only_saturates_is_differentiated_as_it_is_run():
    """V is of first degree in (d31, d32, d33, limit) together, so their values times derivatives add up to it."""
    keys = [*(f"materials.pvdf.d3{i}_pC_per_N" for i in (1, 2, 3)), "mechanisms[0].parameters.limit_V"]
    config = config_from(SLICE)
    found = derivatives(config, keys)
    total = sum(one.value * one.readout_voltage_V for one in found)
    with pytest.warns(softdot.ResultWarning, match="load_steps = 2 is too few"):
        ran = softdot.Case(config).press()
    assert total[-1] == pytest.approx(ran.readout_voltage_V[-1], rel=2e-3)
    assert abs(found[-1].readout_voltage_V[-1]) > 0.05  # it saturates

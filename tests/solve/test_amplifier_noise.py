"""Noise of an amplifier as it is bought against closed forms, and what its table does to the signal."""

import numpy as np
import pytest
from pydantic import ValidationError
from scipy.constants import Boltzmann, elementary_charge

from solve.model import Readout
from solve.physics import Physics
from solve.readout.amplifier import amplify
from solve.readout.noise import noise_budget
from solve.readout.part import ABOUT, Amplifier, amplifier_parts
from tests.cases import for_each

FILM_F, KELVIN = 24e-12, 296.15
LOW = {"noise_from_Hz": 1e-4}
FIRST_ORDER = np.pi / 2.0
"""Noise bandwidth of a first-order low-pass over its corner."""
CHARGE = {"mode": "charge", "feedback_pF": 100.0}


def noise(**keys):
    return noise_budget(Readout(**keys), Physics(), FILM_F, duration_s=1.0)


@for_each(
    ("part", "expected_V", "keys"),
    [
        ("resistor", np.sqrt(Boltzmann * KELVIN / 124e-12), {
            "input_resistance_MOhm": 1000.0, "input_capacitance_pF": 90.0,
            "amplifier": {"input_capacitance_pF": 10.0, **LOW},
        }),
        ("resistor", np.sqrt(Boltzmann * KELVIN / 100e-12), {**CHARGE, "feedback_MOhm": 1000.0, "amplifier": LOW}),
        ("resistor", 5.0 * np.sqrt(4.0 * Boltzmann * KELVIN * 1e3 * FIRST_ORDER * 500.0), {
            "input_resistance_MOhm": 1e-3, "amplifier": {"gain": 5.0, "bandwidth_Hz": 500.0, **LOW},
        }),
        ("voltage noise", 3e-9 * np.sqrt(FIRST_ORDER * 2000.0), {
            "low_pass_Hz": 2000.0, "amplifier": {"voltage_noise_nV_per_rtHz": 3.0, **LOW},
        }),
        ("voltage noise", 3e-9 * np.sqrt(FIRST_ORDER * 1e6 / 4.0) * 4.0, {
            "amplifier": {"voltage_noise_nV_per_rtHz": 3.0, "gain": 4.0, "gain_bandwidth_MHz": 1.0, **LOW},
        }),
        ("voltage noise", 3e-9 * 1.5 * np.sqrt(FIRST_ORDER * 2000.0), {  # noise gain 1 + 50 / 100
            **CHARGE, "low_pass_Hz": 2000.0, "input_capacitance_pF": 26.0,
            "amplifier": {"voltage_noise_nV_per_rtHz": 3.0, **LOW},
        }),
        ("current noise", np.sqrt(2.0 * elementary_charge * 1e-12 * 1e9 / (4.0 * 100e-12)), {  # over 1 / 4 R C
            **CHARGE, "feedback_MOhm": 1000.0, "amplifier": {"bias_current_pA": 1.0, **LOW},
        }),
        ("converter", 10.0 / 2**12 / np.sqrt(12.0), {"amplifier": {"adc_bits": 12, "adc_range_V": 5.0}}),
        ("hum", 2e-3 / np.sqrt(2.0) / np.sqrt(1.0 + 25.0), {"low_pass_Hz": 10.0, "amplifier": {"hum_mV": 2.0}}),
    ],
)  # fmt: skip
def test_noise_is_its_closed_form(part, expected_V, keys):
    found = noise(**keys)
    assert found.parts_V[part] == pytest.approx(expected_V, rel=0.01)
    assert found.rms_V == pytest.approx(np.sqrt(sum(value**2 for value in found.parts_V.values())))


def test_noise_above_half_the_sample_rate_is_what_folds():
    """White noise behind a first order at 1 kHz: 1 - 2/pi atan(f / 1 kHz) of its power is above f."""
    found = noise(low_pass_Hz=1e3, amplifier={"voltage_noise_nV_per_rtHz": 5.0, "sample_rate_Hz": 1e3, **LOW})
    share = 1.0 - 2.0 / np.pi * np.arctan(0.5)
    assert found.above_half_rate_V == pytest.approx(np.sqrt(share) * found.rms_V, rel=0.01)


def test_slower_noise_than_the_press_is_drift_and_a_bias_current_an_offset():
    keys = {**CHARGE, "feedback_MOhm": 1e6, "low_pass_Hz": 1e3}
    slow, fast = (noise_budget(Readout(**keys, amplifier={"part": "TL072"}), Physics(), FILM_F, t) for t in (10.0, 0.1))
    assert slow.parts_V["current noise"] > 5.0 * fast.parts_V["current noise"]  # an integrator: as sqrt(t)
    assert fast.offset_V == pytest.approx(65e-12 * 0.1 / 100e-12)


def test_gain_and_range_of_the_converter_act_on_the_signal():
    time = np.linspace(0.0, 1.0, 501)
    charge = 1e-9 * np.sin(9.0 * time) ** 2
    plain = Readout(input_resistance_MOhm=100.0, input_capacitance_pF=20.0, polarity=-1)
    bought = {"gain": 3.0, "input_capacitance_pF": 8.0, "adc_bits": 16, "adc_range_V": 2.0}
    less = plain.model_copy(update={"input_capacitance_pF": 12.0, "amplifier": Amplifier(**bought)})
    expected = np.clip(3.0 * amplify(time, charge, FILM_F, plain, Physics()), -2.0, 2.0)
    assert np.abs(expected).max() == 2.0
    np.testing.assert_allclose(amplify(time, charge, FILM_F, less, Physics()), expected, atol=1e-12)


def test_every_built_in_part_is_a_table_of_the_configuration_and_may_be_overridden():
    for name, values in amplifier_parts().items():
        part = Amplifier(part=name, voltage_noise_nV_per_rtHz=1.0)
        known = {key: value for key, value in values.items() if key not in ABOUT}
        assert {**part.model_dump(), **known} == {**part.model_dump(), "voltage_noise_nV_per_rtHz": known[
            "voltage_noise_nV_per_rtHz"]}  # fmt: skip
        assert part.voltage_noise_nV_per_rtHz == 1.0


@for_each(
    ("keys", "sentence"),
    [
        ({"noise_V": 1e-3, "amplifier": {}}, "noise_V = 0.001: acts only without amplifier"),
        ({"amplifier": {"part": "LMP772"}}, "did you mean 'LMP7721'"),
        ({"amplifier": {"voltage_noise_nV_per_rtHz": 5.0}}, "amplifier.bandwidth_Hz is missing"),
        ({"amplifier": {"adc_bits": 16}}, "adc_range_V is missing"),
        ({"amplifier": {"gain": 0.0}}, "greater than 0"),
    ],
)
def test_what_no_amplifier_has_is_refused(keys, sentence):
    with pytest.raises(ValidationError, match=sentence):
        Readout(**keys)

"""From charges to voltages and back."""

from dataclasses import replace

import numpy as np
import pytest

from foundation.errors import InputError
from geometry.braille_standards import standard
from softdot.reading.decoders.templates import Posture, templates
from softdot.reading.kernels import electronics_of
from softdot.reading.recorded_file import read_voltages
from softdot.reading.voltages import Reader, Voltages, readout_voltages, restored_charge_pC
from solve.model import Readout
from tests.cases import for_each
from tests.softdot.reading.lines import NOMINAL, READOUT, simulated


def reader(kernel, readout):
    return Reader(kernel, standard("marburg-medium"), readout)


def test_a_charge_that_rises_evenly_leaves_by_the_resistor(kernel):
    """V = R Q' (1 - exp(-t / RC)); 20 pF of film and 180 pF of cable with 1 GOhm: 0.2 s."""
    own = reader(kernel, Readout(input_resistance_MOhm=1000.0, input_capacitance_pF=180.0))
    time = np.linspace(0.0, 1.0, 11)
    at = np.linspace(0.0, 1.0, 501)
    voltage = readout_voltages(own, time, np.outer(time, np.full(6, 50.0)), at)
    closed = 1e9 * 50e-12 * -np.expm1(-at / 0.2)
    np.testing.assert_allclose(voltage, np.repeat(closed[:, None], 6, axis=1), rtol=1e-9, atol=1e-15)


def with_mechanisms(kernel, *mechanisms):
    """A kernel whose design states these mechanisms."""
    stated = [{"name": name, "component": where, "parameters": values} for name, where, values in mechanisms]
    return replace(kernel, about={**kernel.about, "config": {**kernel.about["config"], "mechanisms": stated}})


def test_what_the_design_states_of_the_circuit_acts(kernel):
    """A leak beside the input, a capacitance beside the film, and a low-pass behind it: that of first order."""
    leak, farads = (
        ("charge-leakage", "readout", {"resistance_MOhm": 1000.0}),
        ("parasitic-capacitance", "readout", {"capacitance_pF": 180.0}),
    )
    low = ("low-pass", "readout", {"cutoff_Hz": 0.5})
    readout, physics = electronics_of(with_mechanisms(kernel, leak, farads), Readout())
    assert readout.input_resistance_MOhm == pytest.approx(1000.0)
    assert readout.input_capacitance_pF == pytest.approx(180.0)
    assert physics.stages == ()
    _, physics = electronics_of(with_mechanisms(kernel, low), Readout())
    own = replace(reader(kernel, Readout()), physics=physics)
    time = np.linspace(0.0, 2.0, 2001)
    step = np.minimum(time[:, None] / 1e-3, 1.0) * np.full(6, 20.0)  # 1 V on 20 pF
    voltage = readout_voltages(own, time, step, time)[:, 0]
    np.testing.assert_allclose(voltage, -np.expm1(-2.0 * np.pi * 0.5 * np.maximum(time - 5e-4, 0.0)), atol=2e-3)


def test_what_a_reading_does_not_know_of_the_circuit_is_refused(kernel):
    own = with_mechanisms(kernel, ("charge-leakage", "channel-1", {"resistance_MOhm": 1000.0}))
    with pytest.raises(InputError, match="mechanisms: a leak of 'channel-1': a reading has one amplifier"):
        electronics_of(own, Readout())


@for_each(
    "readout",
    [READOUT, Readout(), Readout(input_resistance_MOhm=500.0), Readout(mode="charge", feedback_pF=100.0, polarity=-1)],
)
def test_the_charge_is_found_again(kernel, readout):
    own = reader(kernel, readout)
    at = np.linspace(0.0, 2.0, 4001)
    charge = 100.0 * np.exp(-(((at[:, None] - np.linspace(0.8, 1.2, 6)) / 0.2) ** 2))
    again = restored_charge_pC(own, Voltages(at, readout_voltages(own, at, charge, at)))
    np.testing.assert_allclose(again, charge, atol=0.5)


def test_noise_and_hum_are_as_large_as_stated(kernel):
    cells = np.array([1])
    quiet = simulated(kernel, cells, **NOMINAL)[1].voltage_V
    loud = simulated(kernel, cells, **{**NOMINAL, "noise_mV": 2.0})[1].voltage_V
    assert (loud - quiet).std() == pytest.approx(2e-3, rel=0.05)
    humming = simulated(kernel, cells, **{**NOMINAL, "hum_mV": 3.0})[1].voltage_V
    assert np.abs(humming - quiet).max() == pytest.approx(3e-3, rel=0.02)


def test_channels_are_wired_as_stated(kernel):
    """A dead channel gives noise alone, two are exchanged, one or all are turned."""
    cells, quiet = np.array([63]), {**NOMINAL, "noise_mV": 0.0}
    right = simulated(kernel, cells, **quiet)[1].voltage_V

    def wired(**changed):
        return simulated(kernel, cells, **quiet, **changed)[1].voltage_V

    assert not wired(dead_channel=2.0)[:, 1].any()
    np.testing.assert_array_equal(wired(swapped_channel=6.0)[:, [5, 1, 2, 3, 4, 0]], right)
    np.testing.assert_array_equal(wired(reversed_channel=4.0), right * np.array([1, 1, 1, -1, 1, 1]))
    np.testing.assert_array_equal(wired(reversed_all=True), -right)
    scattered = wired(gain_scatter=0.3)
    gain = scattered[np.argmax(np.abs(right), axis=0), np.arange(6)] / np.abs(right).max(axis=0)
    assert (np.abs(np.abs(gain) - 1.0) <= 0.3).all()
    assert np.abs(gain).std() > 0.05


def test_a_dot_that_passes_twice_as_fast_gives_twice_the_voltage(kernel):
    """Behind a resistor that lets the charge go at once: V = R dQ/dt."""
    quick = Readout(input_resistance_MOhm=0.01)
    slow, fast = (
        simulated(kernel, np.array([1]), readout=quick, speed_mm_per_s=speed, sampling_Hz=50.0 * speed, **NOMINAL)[1]
        for speed in (10.0, 20.0)
    )
    assert np.abs(fast.voltage_V).max() == pytest.approx(2.0 * np.abs(slow.voltage_V).max(), rel=0.01)


def test_voltages_are_the_sum_of_templates_where_dots_are_far_apart(kernel):
    """One dot in each cell, four cells apart: what a decoder expects is what is heard."""
    own, heard = simulated(kernel, np.array([1, 0, 0, 0, 4]), **NOMINAL)
    known = templates(own, Posture(10.0), heard.step_s)
    assert np.abs(heard.voltage_V).max() == pytest.approx(np.abs(known.voltage_V).max(), rel=0.05)
    energy = float((heard.voltage_V**2).sum())
    assert energy == pytest.approx(float((known.voltage_V[:, [0, 2]] ** 2).sum()), rel=0.02)


@for_each("beside", ["voltage_3_V", "voltage_1_V", "voltage_2_mV"])
def test_a_recording_of_more_channels_than_segments_is_refused(beside, tmp_path):
    """Of another array, of one column twice, or in two units."""
    rows = "".join(f"{n},0,0,0\n" for n in range(60))
    (tmp_path / "a.csv").write_text(f"time_s,voltage_1_V,voltage_2_V,{beside}\n{rows}", "utf-8")
    with pytest.raises(InputError, match="has 3 channels, the kernel has 2 segments"):
        read_voltages(tmp_path / "a.csv", 2)

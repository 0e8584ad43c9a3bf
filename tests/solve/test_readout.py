"""The circuit against closed forms."""

from types import SimpleNamespace

import numpy as np
import pytest
from pydantic import ValidationError

from foundation.errors import InputError
from solve.model import Press, Readout
from solve.physics import Physics
from solve.readout.amplifier import leaky_integral
from solve.readout.course import course
from solve.readout.stages import Saturation
from solve.solution.schedule import fraction
from solve.waveform import Waveform
from tests.cases import for_each

FILM_F = 971e-12  # 16 x 16 mm, 28 um


def press_with(charge_C, capacitance_F=FILM_F, times_s=None):
    """A result that carries only what the circuit needs; times_s : where it followed time."""
    charge, progress = np.array(charge_C)[:, None], np.linspace(0.0, 1.0, len(charge_C))
    times = progress if times_s is None else np.array(times_s)
    trace = SimpleNamespace(time_s=times, indentation_m=progress, reaction_force_N=progress, film_charge_C=charge)
    steps = tuple(SimpleNamespace(time_s=time) for time in times)
    return SimpleNamespace(
        steps=steps, trace=trace, progress=progress, follows_time=times_s is not None,
        capacitance_F=np.array([capacitance_F]),
    )  # fmt: skip


def readout_voltage(result, press, readout, physics=None):
    """At the steps."""
    along = course(result, press, readout, physics or Physics())
    return along.together_V[along.solved]


LINEAR = press_with(np.linspace(0.0, 1e-9, 7))


def test_open_circuit_is_charge_over_capacitance():
    voltage = readout_voltage(LINEAR, Press(), Readout())
    np.testing.assert_allclose(voltage, np.linspace(0, 1e-9, 7) / FILM_F, rtol=1e-9)


def test_cable_capacitance_divides_the_voltage():
    """gain C_f / (C_f + C_in): one 2.5 x 2.5 mm segment (23.8 pF) into 100 pF keeps 1 / 5.2."""
    voltage = readout_voltage(press_with([0.0, 1e-9], 23.8e-12), Press(load_steps=1), Readout(input_capacitance_pF=100))
    assert 1e-9 / 23.8e-12 / voltage[-1] == pytest.approx(5.2, abs=0.005)


@for_each(("rise_s", "ratio"), [(0.1, 103), (0.2, 206), (0.3, 308), (0.5, 514), (1.0, 1028)])
def test_ramp_into_one_megohm(rise_s, ratio):
    """V(T) = V_oc (tau / T)(1 - exp(-T / tau)), tau = 0.973 ms."""
    result = press_with(np.linspace(0.0, 1e-9, 7), 973e-12)
    press = Press(waveform=Waveform(rise_s=rise_s))
    voltage = readout_voltage(result, press, Readout(input_resistance_MOhm=1.0))
    assert 1e-9 / 973e-12 / voltage[-1] == pytest.approx(ratio, abs=0.6)


def test_charge_amplifier_turns_the_charge_into_a_voltage():
    readout = Readout(mode="charge", feedback_pF=1000.0)
    assert readout_voltage(LINEAR, Press(), readout)[-1] == pytest.approx(-1.0, rel=1e-9)


def test_saturation_and_polarity():
    readout = Readout(mode="charge", feedback_pF=1000.0, limit_V=0.3, polarity=-1)
    assert readout_voltage(LINEAR, Press(), readout)[-1] == pytest.approx(0.3)


@for_each(("limit_V", "shown_V"), [(0.5, 0.3), (0.2, 0.2)])
def test_of_two_limits_in_a_row_the_lower_one_counts(limit_V, shown_V):
    readout = Readout(mode="charge", feedback_pF=1000.0, limit_V=0.3)
    physics = Physics(stages=(Saturation(limit_V),))
    assert readout_voltage(LINEAR, Press(), readout, physics)[-1] == pytest.approx(-shown_V)


def test_low_pass_lags_a_ramp_by_its_time_constant():
    """First order, ramp of slope s: V = s (t - tau (1 - exp(-t / tau)))."""
    tau = 1.0 / (2 * np.pi * 5.0)
    voltage = readout_voltage(LINEAR, Press(waveform=Waveform(rise_s=1.0)), Readout(low_pass_Hz=5.0))
    slope = 1e-9 / FILM_F
    assert voltage[-1] == pytest.approx(slope * (1.0 - tau * (1.0 - np.exp(-1.0 / tau))), rel=1e-5)


def test_sine_through_the_high_pass_of_the_input():
    """Gain w tau / sqrt(1 + (w tau)^2), lead atan(1 / (w tau))."""
    time, tau, w = np.linspace(0, 5, 200_001), 0.02, 2 * np.pi * 3.0
    voltage = leaky_integral(time, np.sin(w * time), 1.0, tau)
    expected = w * tau / np.hypot(1, w * tau) * np.sin(w * time + np.arctan(1 / (w * tau)))
    np.testing.assert_allclose(voltage[-50_000:], expected[-50_000:], atol=1e-5)


@for_each(
    ("waveform", "at_rise"),
    [("ramp", 1.0), ("half-sine", 1.0), ("raised-cosine", 1.0), ("trapezoid", 1.0)],
)
def test_waveforms_start_at_rest_and_reach_full_depth(waveform, at_rise):
    shape = Waveform(shape=waveform, rise_s=0.2)
    assert fraction(shape, np.array([0.0, 0.2])) == pytest.approx([0.0, at_rise])


def test_trapezoid_and_half_sine_return_to_rest():
    assert fraction(Waveform(shape="trapezoid", hold_s=0.1), np.array([1.1, 1.2])) == pytest.approx([0.0, 0.0])
    assert fraction(Waveform(shape="half-sine"), np.array([1.0])) == pytest.approx([0.0])


def test_waveform_file(tmp_path):
    table = tmp_path / "w.csv"
    table.write_text("time_s,fraction\n0,0\n1,0.5\n2,1\n", "utf-8")
    assert fraction(Waveform(shape="file", file=str(table)), np.array([1.5])) == pytest.approx([0.75])
    table.write_text("time_s,fraction\n0,0\n0,2\n", "utf-8")
    with pytest.raises(InputError, match=r"press\.waveform\.file.*between 0 and 1"):
        fraction(Waveform(shape="file", file=str(table)), np.array([0.0]))


def test_a_slide_needs_a_load_that_stays():
    with pytest.raises(ValidationError, match=r"waveform\.shape = 'half-sine': a slide needs a load that is held"):
        Press(path_xy_mm=((1.0, 0.0),), waveform=Waveform(shape="half-sine"))
    with pytest.raises(ValidationError, match=r"waveform\.hold_s = 0: a slide"):
        Press(path_xy_mm=((1.0, 0.0),), waveform=Waveform(shape="trapezoid"))


def test_the_charge_of_a_ramp_and_hold_keeps_its_corner():
    """Q rises linearly in 0.1 s and stays: V at the end of the rise is Q / C (tau / T)(1 - exp(-T / tau))."""
    time, tau = np.array([0.0, 0.05, 0.1, 0.3, 0.5]), 1e9 * FILM_F / 100.0
    charge = np.array([0.0, 0.5e-9, 1e-9, 1e-9, 1e-9])
    result = press_with(charge, times_s=time)
    press = Press(waveform=Waveform(rise_s=0.1, hold_s=0.4))
    voltage = readout_voltage(result, press, Readout(input_resistance_MOhm=10.0))
    assert voltage[2] == pytest.approx(1e-9 / FILM_F * tau / 0.1 * (1.0 - np.exp(-0.1 / tau)), rel=1e-6)

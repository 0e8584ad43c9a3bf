"""The input of the amplifier alone: the film is a given charge Q_s with the capacitance C_f."""

import numpy as np
import pytest

from solve.model import Readout
from solve.physics import Physics
from solve.readout.amplifier import leaky_integral
from solve.readout.channel_parts import MutualCapacitance
from solve.readout.channels import input_voltages
from solve.terms.circuit import Circuit, TiedInputs
from tests.cases import for_each
from tests.solve.trial import trial

C_FILM, C_INPUT = 3.0, 2.0
TIME = np.array([0.0, 0.1, 0.15, 0.4, 1.0, 1.3])
CHARGE = np.array([0.0, 0.2, 1.0, 0.7, 0.7, 0.0])


def voltages(circuit, charge=CHARGE, time=TIME):
    """Voltage (t,) at which film and circuit balance: the film's row is Q_s - C_f V."""
    history, result = circuit.start(), [0.0]
    for q, dt in zip(charge[1:], np.diff(time), strict=True):
        state = trial(np.zeros((1, 3)), [0.0], dt)
        block = next(iter(circuit.elements(state, history)))
        v = -(q + block.residuals[0, 0]) / (block.matrices[0, 0, 0] - C_FILM)
        history = circuit.advance(trial(np.zeros((1, 3)), [v], dt), history)
        assert history == pytest.approx((q, v), abs=1e-14)
        result.append(v)
    return np.array(result)


def circuit(resistance, input_capacitance=C_INPUT):
    return Circuit(0, C_FILM, input_capacitance, resistance)


@for_each("resistance", [0.02, 0.1, 3.0])
def test_it_is_the_read_out_after_the_press(resistance):
    expected = leaky_integral(TIME, CHARGE, C_FILM + C_INPUT, resistance)
    np.testing.assert_allclose(voltages(circuit(resistance)), expected, atol=1e-14)


def test_a_charge_step_decays_with_rc():
    time = np.array([0.0, 1e-12, 0.1, 0.7])
    ours = voltages(circuit(0.05), np.array([0.0, 1.0, 1.0, 1.0]), time)
    np.testing.assert_allclose(ours[1:], np.exp(-time[1:] / 0.25) / 5.0, rtol=1e-10)


def test_a_charge_ramp_saturates_at_r_times_the_current():
    time = np.linspace(0.0, 1.0, 7)
    ours = voltages(circuit(0.05), 2.0 * time, time)
    np.testing.assert_allclose(ours, 0.05 * 2.0 * -np.expm1(-time / 0.25), atol=1e-14)


def test_a_sine_has_the_gain_and_lead_of_the_high_pass():
    """Gain w tau / sqrt(1 + (w tau)^2), lead atan(1 / w tau)."""
    w, tau = 2.0 * np.pi * 3.0, 0.25
    time = np.linspace(0.0, 5.0, 6001)
    ours = voltages(circuit(0.05), np.sin(w * time), time)[-1200:]
    expected = w * tau / np.hypot(1.0, w * tau) * np.sin(w * time + np.arctan(1.0 / (w * tau))) / 5.0
    np.testing.assert_allclose(ours, expected[-1200:], atol=1e-5)


def test_an_infinite_resistance_is_open_circuit():
    np.testing.assert_allclose(voltages(circuit(np.inf, 0.0)), CHARGE / C_FILM, atol=1e-15)


def test_a_small_resistance_is_a_short_circuit():
    """V tends to R dQ/dt."""
    ours = voltages(circuit(1e-9))
    np.testing.assert_allclose(ours[1:], 1e-9 * np.diff(CHARGE) / np.diff(TIME), atol=1e-20)


def test_long_at_rest_it_is_discharged():
    block = next(iter(circuit(3.0).elements(trial(np.zeros((1, 3)), [0.0], np.inf), (7.0, 2.0))))
    assert block.residuals[0, 0] == 0.0
    assert block.matrices[0, 0, 0] < -1e8


@for_each(("resistance", "error"), [(np.inf, 1e-12), (0.3, 2e-4)])
def test_tied_inputs_are_the_channels_of_the_read_out(resistance, error):
    """Two films whose charges flow into circuits with a capacitance between them, against the exact modes of both."""
    time = np.linspace(0.0, 1.0, 401)
    charge = np.column_stack([np.sin(3.0 * time), 0.2 * time])
    circuits = [Circuit(n, C_FILM, C_INPUT, resistance) for n in (0, 1)]
    tied = TiedInputs(np.array([0, 1]), 0.8 * np.array([[1.0, -1.0], [-1.0, 1.0]]))
    history, found = [one.start() for one in circuits], [np.zeros(2)]
    for q, dt in zip(charge[1:], np.diff(time), strict=True):
        state = trial(np.zeros((1, 3)), [0.0, 0.0], dt)
        blocks = [next(iter(one.elements(state, known))) for one, known in zip(circuits, history, strict=True)]
        tangent = np.diag([block.matrices[0, 0, 0] - C_FILM for block in blocks])
        tangent += next(iter(tied.elements(state, None))).matrices[0]
        voltage = np.linalg.solve(tangent, -(q + [block.residuals[0, 0] for block in blocks]))
        state = trial(np.zeros((1, 3)), voltage, dt)
        history = [one.advance(state, known) for one, known in zip(circuits, history, strict=True)]
        found.append(voltage)
    readout = Readout(input_resistance_MOhm=1e-6 * resistance if resistance < np.inf else None)
    readout = readout.model_copy(update={"input_capacitance_pF": 1e12 * C_INPUT})
    physics = Physics(channels=(MutualCapacitance(1, 2, 0.8e12),))
    exact = input_voltages(time, charge, np.full(2, C_FILM), readout, physics)
    assert np.abs(np.array(found) - exact.T).max() < error

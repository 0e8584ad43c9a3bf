"""Amplifiers whose inputs are tied by a stray capacitance, against closed forms of two RC circuits."""

import numpy as np
import pytest

from solve.mechanisms import Mechanism, with_mechanisms
from solve.model import Readout
from solve.physics import Physics
from solve.readout.amplifier import amplify
from solve.readout.channel_parts import ChannelLeak, ChannelStage, MutualCapacitance
from solve.readout.channels import amplify_channels, input_voltages
from solve.readout.filters import Filter
from tests.cases import for_each
from tests.diagnose.segment.rigs import model

TIME = np.linspace(0.0, 2.0, 2001)
FILM_PF, INPUT_PF, TIED_PF, MOHM, CHARGE_PC = 60.0, 40.0, 25.0, 5000.0, 500.0
TIED = Physics(channels=(MutualCapacitance(1, 2, TIED_PF),))
STEP = np.where(TIME > 0.0, 1e-12 * CHARGE_PC, 0.0)
READOUT = Readout(input_resistance_MOhm=MOHM, input_capacitance_pF=INPUT_PF)


def films(*values_pF):
    return 1e-12 * np.array(values_pF)


def test_a_step_on_one_of_two_equal_channels_has_a_common_and_a_differential_decay():
    """Sum: C = 100 pF, 0.5 s. Difference: C + 2 C_m = 150 pF, 0.75 s."""
    charge = np.column_stack([STEP, 0.0 * STEP])
    one, other = amplify_channels(TIME, charge, films(FILM_PF, FILM_PF), READOUT, TIED)
    common = CHARGE_PC / 100.0 * np.exp(-(TIME - TIME[1]) / 0.5)
    difference = CHARGE_PC / 150.0 * np.exp(-(TIME - TIME[1]) / 0.75)
    later = TIME > 0.0
    np.testing.assert_allclose((one + other)[later], common[later], rtol=2e-3)
    np.testing.assert_allclose((one - other)[later], difference[later], rtol=2e-3)


def test_at_open_circuit_charges_share_out_as_the_capacitance_matrix_has_it():
    """V = (diag(C) + C_m [[1, -1], [-1, 1]])^-1 Q, and the coupling is reciprocal although the films differ."""
    open_circuit = Readout(input_capacitance_pF=INPUT_PF)
    matrix = np.array([[100.0 + TIED_PF, -TIED_PF], [-TIED_PF, 240.0 + TIED_PF]])
    found = []
    for charged in np.eye(2):
        charge = STEP[:, None] * charged
        found.append(input_voltages(TIME, charge, films(60.0, 200.0), open_circuit, TIED))
    at_end = np.array(found)[:, :, -1]
    np.testing.assert_allclose(at_end, CHARGE_PC * np.linalg.inv(matrix).T, rtol=1e-9)
    assert at_end[0, 1] == pytest.approx(at_end[1, 0])


def test_a_third_channel_that_is_tied_to_none_stays_as_it_was():
    charge = np.column_stack([STEP, 0.3 * STEP, 0.5 * STEP])
    capacitance = films(60.0, 70.0, 80.0)
    alone = amplify(TIME, charge[:, 2].copy(), float(capacitance[2]), READOUT, Physics())
    np.testing.assert_allclose(amplify_channels(TIME, charge, capacitance, READOUT, TIED)[2], alone, rtol=1e-9)


def test_inputs_of_charge_amplifiers_are_virtual_grounds():
    charge = np.column_stack([STEP, 0.0 * STEP])
    readout = Readout(mode="charge", feedback_pF=100.0, feedback_MOhm=1e4)
    of = (TIME, charge, films(FILM_PF, FILM_PF), readout)
    tied = amplify_channels(*of, TIED)
    np.testing.assert_array_equal(tied, amplify_channels(*of, Physics()))


def test_a_leak_and_a_filter_of_one_channel_leave_the_others_alone():
    charge = np.column_stack([STEP, STEP])
    physics = Physics(channels=(ChannelLeak(2, 1.0 / MOHM), ChannelStage(2, Filter(20.0, 2))))
    one, other = amplify_channels(TIME, charge, films(FILM_PF, FILM_PF), READOUT, physics)
    half = Readout(input_resistance_MOhm=0.5 * MOHM, input_capacitance_pF=INPUT_PF, low_pass_Hz=20.0, filter_order=2)
    np.testing.assert_allclose(one, amplify(TIME, STEP, 1e-12 * FILM_PF, READOUT, Physics()), rtol=1e-12)
    np.testing.assert_allclose(other, amplify(TIME, STEP, 1e-12 * FILM_PF, half, Physics()), rtol=1e-9, atol=1e-12)


@for_each(
    ("component", "parameters", "said"),
    [
        ("channel-1-channel-2", {"coupling": 0.1}, "parameters.coupling = 0.1: is of one channel"),
        ("channel-1", {"capacitance_pF": 5.0}, "parameters.capacitance_pF = 5: is of two channels"),
    ],
)
def test_a_pair_takes_a_capacitance_and_a_channel_a_coupling(component, parameters, said):
    with pytest.raises(ValueError, match=said):
        with_mechanisms(model(), [Mechanism(name="crosstalk", component=component, parameters=parameters)])

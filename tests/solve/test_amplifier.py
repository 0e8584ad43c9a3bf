"""The compiled recurrences against scipy.signal's integration of the same circuit."""

import numpy as np
from scipy.signal import butter, lsim

from solve.model import Readout
from solve.physics import Physics
from solve.readout.amplifier import amplify
from solve.readout.filters import Filter
from tests.cases import for_each

FILM_F = 24e-12


def by_scipy(time, charge, resistance, capacitance, readout, low_pass):
    """V(s) = s R / (1 + s R C) Q(s), then the filters, each exact for what is linear between the samples."""
    voltage = lsim(([resistance, 0.0], [resistance * capacitance, 1.0]), charge, time)[1]
    own = [(readout.low_pass_Hz, readout.filter_order, "low"), (readout.high_pass_Hz, readout.filter_order, "high")]
    for corner, order, kind in [*own, low_pass]:
        if corner is not None:
            voltage = lsim(butter(order, 2.0 * np.pi * corner, kind, analog=True), voltage, time)[1]
    return readout.polarity * voltage


@for_each(
    ("readout", "resistance", "capacitance"),
    [
        (Readout(input_resistance_MOhm=10.0, input_capacitance_pF=100.0, polarity=-1), 10e6, 124e-12),
        (
            Readout(input_resistance_MOhm=1.0, low_pass_Hz=60.0, high_pass_Hz=0.5, filter_order=3),
            1e6,
            FILM_F + 1e-12 * Readout().input_capacitance_pF,
        ),
        (Readout(mode="charge", feedback_pF=100.0, feedback_MOhm=1000.0), -1e9, -100e-12),
    ],
)
def test_amplifier_is_its_transfer_function(readout, resistance, capacitance):
    time = np.linspace(0.0, 2.0, 6001)
    charge = 1e-10 * np.sin(9.0 * time) ** 2
    expected = by_scipy(time, charge, resistance, capacitance, readout, (40.0, 2, "low"))
    found = amplify(time, charge, FILM_F, readout, Physics(stages=(Filter(40.0, 2),)))
    np.testing.assert_allclose(found, expected, atol=1e-9 * np.abs(expected).max())


def test_uneven_samples_change_no_answer():
    readout = Readout(input_resistance_MOhm=1.0, low_pass_Hz=60.0)
    even = np.linspace(0.0, 2.0, 20_001)
    uneven = even + 2e-5 * np.sin(40.0 * even)
    answers = [amplify(time, 1e-10 * np.sin(9.0 * time) ** 2, FILM_F, readout, Physics()) for time in (even, uneven)]
    found = np.interp(even, uneven, answers[1])
    np.testing.assert_allclose(found, answers[0], atol=1e-4 * np.abs(answers[0]).max())

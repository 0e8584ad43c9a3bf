"""The read-out of the rig against limits that follow from the circuit, and against integration in time."""

import numpy as np
import pytest

from softdot.studies.paper.calibration.readout import (
    LOW_PASS_HZ,
    SAMPLES,
    Chain,
    depth_fraction,
    recorded_V,
    swing_V,
    times_s,
)
from solve.model import Readout
from solve.physics import Physics
from solve.readout.amplifier import amplify
from tests.cases import for_each

CHARGE_PC, FILM_PF = 4000.0, 971.0


@for_each("press_time_s", [0.2, 0.5])
def test_far_below_the_corner_the_voltage_is_resistance_times_current(press_time_s):
    """A raised cosine is fastest half-way, with pi Q / 2 T, once in each direction; R in MΩ times pC/s is µV."""
    charge = CHARGE_PC * depth_fraction(press_time_s)
    swing = swing_V(charge, FILM_PF, Chain(0.01, 100.0, filtered=False))
    assert swing == pytest.approx(2 * 0.01e-6 * np.pi * CHARGE_PC / (2 * press_time_s), rel=1e-3)


def test_without_leakage_the_charge_spreads_over_film_and_cable():
    swing = swing_V(CHARGE_PC * depth_fraction(0.3), FILM_PF, Chain(1e7, 129.0, filtered=False))
    assert swing == pytest.approx(CHARGE_PC / (FILM_PF + 129.0), rel=1e-4)


def test_the_cable_hardly_counts_where_charge_leaks_fast():
    near, far = (swing_V(CHARGE_PC * depth_fraction(0.3), FILM_PF, Chain(1.0, c)) for c in (50.0, 400.0))
    assert far == pytest.approx(near, rel=1e-3)


@for_each("resistance_MOhm", [1.0, 100.0])
def test_the_periodic_solution_is_where_integration_in_time_ends(resistance_MOhm):
    charge, presses = CHARGE_PC * depth_fraction(1 / 3) ** 1.7, 10
    readout = Readout(
        input_resistance_MOhm=resistance_MOhm, input_capacitance_pF=150.0, low_pass_Hz=LOW_PASS_HZ, filter_order=8
    )
    time = np.arange(presses * SAMPLES) / SAMPLES
    marched = amplify(time, 1e-12 * np.tile(charge, presses), 1e-12 * FILM_PF, readout, Physics())[-SAMPLES:]
    periodic = recorded_V(charge, FILM_PF, Chain(resistance_MOhm, 150.0))
    np.testing.assert_allclose(periodic, marched, atol=3e-4 * np.ptp(marched))


def test_the_filter_falls_by_48_dB_in_an_octave():
    def loss_dB(frequency_Hz):
        charge = np.sin(2 * np.pi * frequency_Hz * times_s())
        plain, filtered = (swing_V(charge, FILM_PF, Chain(1.0, 0.0, filtered=on)) for on in (False, True))
        return 20 * np.log10(plain / filtered)

    assert loss_dB(10.0) == pytest.approx(0.0, abs=0.01)
    assert loss_dB(2 * LOW_PASS_HZ) == pytest.approx(48.2, abs=0.3)

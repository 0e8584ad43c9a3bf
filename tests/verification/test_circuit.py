"""The film's voltage solved together with the press, and charges that heat and touch add.

Two-way coupling: the voltage stiffens the film, so that it differs from the post-processed one by about k^2.
"""

from functools import cache

import numpy as np
import pytest

from solve.model import Readout
from solve.physics import Physics
from solve.readout.course import course
from solve.readout.heat_and_touch import ContactCharge, Pyroelectric
from tests.cases import for_each
from tests.verification.slices import charge, force, pressed, waved

STRONG = {"d31_pC_per_N": 60.0, "d32_pC_per_N": 60.0}
COUPLING = (60e-12) ** 2 * 2.0 * 2e9 / (1.0 - 0.29) / (12.0 * 8.8541878128e-12)  # 2 d31^2 Y / (1 - nu) / eps
PRESS = waved("ramp", 8, rise_s=0.1)


def voltage(result, press, readout, physics=None):
    along = course(result, press, readout, physics or Physics())
    return np.interp(result.trace.time_s, along.time_s, along.together_V)


@cache
def one_way():
    """The press that no circuit acts upon."""
    return pressed(PRESS, **STRONG)


def both(readout):
    """Voltages (t,) of the same press one-way and two-way; the elastic press ends at the end of the rise."""
    one = one_way()
    two = pressed(PRESS, readout=readout, coupling="two-way", **STRONG)
    return [voltage(r, PRESS, readout) for r in (one, two)], [one, two]


def test_open_circuit_gains_up_to_the_planar_coupling():
    """D3 = 0 at an imposed strain gives V / (1 - k^2); a film that the voltage may move on soft rubber gives less."""
    (one, two), results = both(Readout())
    limit = COUPLING / (1.0 - COUPLING)
    assert 0.8 * limit < two[-1] / one[-1] - 1.0 < limit
    assert force(results[1])[-1] > force(results[0])[-1]


def test_a_short_circuit_is_one_way():
    """Into 1 kOhm the film's voltage, and so its action back, vanishes."""
    (_, two), results = both(Readout(input_resistance_MOhm=1e-3))
    assert np.abs(two).max() < 1e-4 * abs(charge(results[0])[-1] / results[0].capacitance_F[0])
    one_way = charge(results[0])
    np.testing.assert_allclose(charge(results[1]), one_way, rtol=1e-4, atol=1e-4 * np.abs(one_way).max())
    assert force(results[1])[-1] == pytest.approx(force(results[0])[-1], rel=1e-6)


def test_a_resistor_gives_the_post_processed_voltage_within_the_coupling():
    (one, two), _ = both(Readout(input_resistance_MOhm=1000.0, input_capacitance_pF=20.0))
    assert 1e-4 < np.abs(two - one).max() / np.abs(one).max() < 2.0 * COUPLING


def test_weak_coupling_makes_no_difference():
    """d31 a hundredth: k^2 is ten thousand times less, so is the difference."""
    weak = {"d31_pC_per_N": 0.6, "d32_pC_per_N": 0.6}
    readout = Readout(input_resistance_MOhm=1000.0)
    results = [pressed(PRESS, readout=readout, coupling=c, **weak) for c in ("one-way", "two-way")]
    one, two = (voltage(result, PRESS, readout) for result in results)
    np.testing.assert_allclose(two, one, atol=2e-4 * np.abs(one).max())


def test_a_charge_amplifier_holds_the_film_at_ground():
    """V = -Q / C_fb whatever the coupling: its input is a virtual ground."""
    readout = Readout(mode="charge", feedback_pF=100.0)
    (one, two), results = both(readout)
    np.testing.assert_allclose(one, -charge(results[0]) / 1e-10, atol=1e-9 * np.abs(one).max())
    np.testing.assert_allclose(two, one, atol=1e-9 * np.abs(one).max())


@pytest.fixture(scope="module")
def plain():
    return pressed(PRESS)


def test_one_kelvin_is_seven_point_six_volts(plain):
    """V = p t / eps: 30 uC/m2K x 28 um / (12 x 8.854 pF/m) = 7.9 V/K; 7.6 with the data sheet's 110 pF/m."""
    heat = pressed(PRESS, Physics(added=(Pyroelectric(1.0, 1e-4),)))
    per_kelvin = 30e-6 * 28e-6 / (12.0 * 8.8541878128e-12)
    extra = heat.steps[-1].open_circuit_voltage_V[0] - plain.steps[-1].open_circuit_voltage_V[0]
    assert extra == pytest.approx(per_kelvin, rel=1e-9)
    assert pytest.approx(7.6, abs=0.05) == 28e-6 * 30e-6 / 110e-12
    assert extra == pytest.approx(7.6 * 110.0 / (12.0 * 8.8541878128), rel=5e-3)


def test_heat_comes_with_its_time_constant(plain):
    heat = pressed(PRESS, Physics(added=(Pyroelectric(0.5, 0.04),)))
    share = (charge(heat) - charge(plain)) / (charge(heat) - charge(plain))[-1]
    time = heat.trace.time_s
    np.testing.assert_allclose(share, np.expm1(-time / 0.04) / np.expm1(-time[-1] / 0.04), atol=1e-9)


@pytest.mark.press
@for_each("exponent", [1.0, 0.5, 2.0])
def test_touch_leaves_its_charge_by_a_power_of_the_area(plain, exponent):
    touched = pressed(PRESS, Physics(added=(ContactCharge(5.0, exponent),)))
    area = plain.trace.contact_area_m2
    np.testing.assert_allclose(charge(touched) - charge(plain), 5e-12 * (area / area.max()) ** exponent, atol=1e-20)


def test_what_leaks_through_the_resistance_is_missing_on_the_capacitance(plain):
    """int V / R dt = Q - C V, with 7.5 and 15 GOhm in parallel, 5 GOhm."""
    readout = Readout(input_resistance_MOhm=1.0 / (1.0 / 7.5e3 + 1.0 / 1.5e4))
    along = course(plain, PRESS, readout, Physics())
    leaked = np.trapezoid(along.together_V, along.time_s) / 5e9
    held = plain.capacitance_F[0] * along.together_V[-1]
    assert 0.1 < leaked / charge(plain)[-1] < 0.9
    assert leaked + held == pytest.approx(charge(plain)[-1], rel=1e-4)


def test_the_capacitance_of_the_film_is_that_of_a_plate_capacitor(plain):
    """eps A / t of 2.5 x 2.5 mm, 28 um: 23.7 pF."""
    assert plain.capacitance_F[0] == pytest.approx(12.0 * 8.8541878128e-12 * 6.25e-6 / 28e-6, rel=1e-6)

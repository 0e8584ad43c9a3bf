"""The read-out of a film: voltage and charge amplifier and filters against closed forms."""

import numpy as np

from foundation.arrays import Floats
from softdot.verify.problem import Problem
from solve.model import Readout
from solve.physics import Physics
from solve.readout.amplifier import amplify

FILM_F, CHARGE_C = 100e-12, 1e-9
"""Capacitance of the film, and charge at the end of the ramp."""
TIME_S = np.linspace(0.0, 1.0, 4001)
FREQUENCY_HZ = 20.0


def ramp_of_charge() -> Floats:
    """Charge (t,) that rises evenly over the whole time."""
    return np.asarray(CHARGE_C * TIME_S / TIME_S[-1])


def last_voltage(charge_C: Floats, readout: Readout) -> float:
    """Voltage of the amplifier at the end of the time."""
    return float(amplify(TIME_S, charge_C, FILM_F, readout, Physics())[-1])


def gain(readout: Readout) -> float:
    """Amplitude of the voltage under a sine of charge, over that of charge over capacitance, once it is steady."""
    voltage = amplify(TIME_S, CHARGE_C * np.sin(2.0 * np.pi * FREQUENCY_HZ * TIME_S), FILM_F, readout, Physics())
    last = TIME_S >= 0.8  # four whole periods
    turn = np.exp(-2j * np.pi * FREQUENCY_HZ * TIME_S[last][:-1])
    return float(2.0 * abs(np.mean(voltage[last][:-1] * turn)) / (CHARGE_C / FILM_F))


def ramp_voltage(resistance_Ohm: float, capacitance_F: float) -> float:
    """Voltage at the end of a ramp of charge into R and C: R Q' (1 - exp(-t / R C))."""
    current = CHARGE_C / TIME_S[-1]
    return float(resistance_Ohm * current * -np.expm1(-TIME_S[-1] / (resistance_Ohm * capacitance_F)))


VOLTAGE_AMPLIFIER = Readout(input_resistance_MOhm=1000.0, input_capacitance_pF=150.0)
CHARGE_AMPLIFIER = Readout(mode="charge", feedback_pF=500.0, feedback_MOhm=1000.0)
SOURCE = "linear circuits (Horowitz and Hill, The Art of Electronics, 2015, ch. 1); "
EXACT = "integrated exactly for a charge that is linear between the samples: round-off"
SAMPLED = "a sine sampled 200 times a period and taken as straight between, (π/200)²/3 = 0.01 % for each stage"

PROBLEMS = (
    Problem(
        name="rc-voltage",
        title="Ramp of charge into 1 GΩ and 250 pF, voltage at its end",
        source=SOURCE + "R Q̇ (1 - exp(-t / R C))",
        unit="V",
        bound_percent=1e-6,
        basis=EXACT,
        reference=lambda: ramp_voltage(1e9, FILM_F + 150e-12),
        solve=lambda: last_voltage(ramp_of_charge(), VOLTAGE_AMPLIFIER),
    ),
    Problem(
        name="rc-charge",
        title="Ramp of charge into a charge amplifier of 1 GΩ and 500 pF, voltage at its end",
        source=SOURCE + "-R Q̇ (1 - exp(-t / R C)) of the feedback",
        unit="V",
        bound_percent=1e-6,
        basis=EXACT,
        reference=lambda: -ramp_voltage(1e9, 500e-12),
        solve=lambda: last_voltage(ramp_of_charge(), CHARGE_AMPLIFIER),
    ),
    Problem(
        name="rc-low-pass",
        title="Gain of a Butterworth low-pass of order 3 at twice its corner",
        source="Butterworth, Wireless Engineer 7, 1930: 1 / √(1 + (f/f₀)^(2n))",
        unit="1",
        bound_percent=0.1,
        basis=SAMPLED,
        reference=lambda: 1.0 / np.sqrt(1.0 + 2.0**6),
        solve=lambda: gain(Readout(low_pass_Hz=FREQUENCY_HZ / 2.0, filter_order=3)),
    ),
    Problem(
        name="rc-high-pass",
        title="Gain of a Butterworth high-pass of order 2 at half its corner",
        source="Butterworth, Wireless Engineer 7, 1930: 1 / √(1 + (f₀/f)^(2n))",
        unit="1",
        bound_percent=0.1,
        basis=SAMPLED,
        reference=lambda: 1.0 / np.sqrt(1.0 + 2.0**4),
        solve=lambda: gain(Readout(high_pass_Hz=2.0 * FREQUENCY_HZ, filter_order=2)),
    ),
)

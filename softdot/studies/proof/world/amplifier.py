"""From charge to voltage by the trapezoidal rule on a finer grid, and filters of another kind than the rig states."""

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.signal import bessel, butter, lfilter, sosfilt

from softdot.studies.proof.world.arrays import Floats

SAMPLES_FACTOR = 8


@dataclass(frozen=True)
class Filter:
    """Low-pass of an amplifier. cutoff_Hz at -3 dB; kind : "bessel", or "butterworth" as the rig states its own."""

    cutoff_Hz: float
    order: int
    kind: Literal["bessel", "butterworth"] = "bessel"

    def apply(self, voltage: Floats, rate_Hz: float) -> Floats:
        """Filter a voltage (n,) at an even rate by the bilinear transform, from rest."""
        if self.kind == "bessel":
            sections = bessel(self.order, self.cutoff_Hz, fs=rate_Hz, output="sos", norm="mag")
        else:
            sections = butter(self.order, self.cutoff_Hz, fs=rate_Hz, output="sos")
        return np.asarray(sosfilt(sections, voltage))


@dataclass(frozen=True)
class Amplifier:
    """Input resistance and capacitance, filters in order, hum and a soft limit before them."""

    resistance_MOhm: float | None
    capacitance_pF: float
    filters: tuple[Filter, ...] = ()
    hum_V: float = 0.0
    limit_V: float | None = None

    def voltage(self, time_s: Floats, charge_pC: Floats, film_pF: float, hum_phase: float) -> Floats:
        """Voltage (t,) for the charge (t,) of the film at even times (t,), from rest."""
        rate = SAMPLES_FACTOR * (len(time_s) - 1) / (time_s[-1] - time_s[0])
        fine = time_s[0] + np.arange(SAMPLES_FACTOR * (len(time_s) - 1) + 1) / rate
        voltage = self.input_V(CubicSpline(time_s, charge_pC)(fine), film_pF, rate)
        return self.behind(voltage, fine, rate, hum_phase)[::SAMPLES_FACTOR]

    def behind(self, voltage: Floats, fine_s: Floats, rate_Hz: float, hum_phase: float) -> Floats:
        """Voltage (n,) behind everything that follows the input, on its own fine grid (n,)."""
        angle = 2.0 * np.pi * HUM_HZ * fine_s
        voltage = voltage + self.hum_V * (np.sin(angle + hum_phase) + HARMONIC * np.sin(3.0 * (angle + hum_phase)))
        if self.limit_V is not None:
            voltage = _softly_clipped(voltage, self.limit_V)
        for one in self.filters:
            voltage = one.apply(voltage, rate_Hz)
        return np.asarray(voltage)

    def leaking(self, resistance_MOhm: float | None) -> "Amplifier":
        """The amplifier with a resistance beside that of its input; None for none."""
        conductance = sum(1.0 / r for r in (self.resistance_MOhm, resistance_MOhm) if r is not None)
        return replace(self, resistance_MOhm=1.0 / conductance if conductance else None)

    def input_V(self, charge_pC: Floats, film_pF: float, rate_Hz: float) -> Floats:
        """Voltage (n,) at the input on the fine grid: (C_f + C) V' = Q' - V / R; MOhm times pF is microseconds."""
        capacitance = film_pF + self.capacitance_pF
        half = 0.0 if self.resistance_MOhm is None else 0.5e6 / (rate_Hz * self.resistance_MOhm * capacitance)
        gain = 1.0 / (capacitance * (1.0 + half))
        return np.asarray(lfilter([gain, -gain], [1.0, -(1.0 - half) / (1.0 + half)], charge_pC - charge_pC[0]))


def _softly_clipped(voltage: Floats, limit_V: float) -> Floats:
    """A clip whose corners are those of log(1 + exp(x))."""
    knee = limit_V / SHARPNESS
    from_below, from_above = (np.logaddexp(0.0, (voltage + side) / knee) for side in (limit_V, -limit_V))
    return np.asarray(knee * (from_below - from_above) - limit_V)


HUM_HZ, HARMONIC, SHARPNESS = 49.98, 0.15, 8.0

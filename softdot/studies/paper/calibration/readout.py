"""The read-out of the rig while the same press is repeated once a second.

The film's charge Q(t) drives R parallel to film and cable, and an eighth-order low-pass follows:
    (C_f + C) V' + V / R = Q',        V_hat = i w Q_hat / (1/R + i w (C_f + C)) H(w).
Everything is linear and periodic, so that the steady state after many presses follows exactly from the Fourier series
of one period. A single press from rest is integrated in time by solve.readout.course.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.signal import butter, freqs

from foundation.arrays import Floats
from softdot.studies.paper.calibration.inputs import Values
from solve.solution.schedule import fraction
from solve.waveform import Waveform

PERIOD_S = 1.0  # ten presses in ten seconds
SAMPLES = 2048
LOW_PASS_HZ = 60.0
ORDER = 8  # 48 dB per octave


@dataclass(frozen=True)
class Chain:
    """Input resistance and capacitance, in parallel to the film, and whether the low-pass is on."""

    resistance_MOhm: float
    capacitance_pF: float
    filtered: bool = True


def times_s() -> Floats:
    """One period (SAMPLES,)."""
    return PERIOD_S * np.arange(SAMPLES) / SAMPLES


def depth_fraction(press_time_s: float) -> Floats:
    """Fraction of the depth over time (SAMPLES,): a raised cosine down in the press time, up in the same, then
    nothing.
    """
    to_deepest = np.abs(times_s() - press_time_s)
    return fraction(Waveform(shape="raised-cosine", rise_s=press_time_s), press_time_s - to_deepest)


def recorded_V(charge_pC: Floats, film_capacitance_pF: float, chain: Chain) -> Floats:
    """Recorded voltage (..., SAMPLES) of a periodic charge (..., SAMPLES)."""
    rate = 2j * np.pi * np.fft.rfftfreq(SAMPLES, PERIOD_S / SAMPLES)
    conductance = 1.0 / (1e6 * chain.resistance_MOhm)
    admittance = conductance + rate * 1e-12 * (film_capacitance_pF + chain.capacitance_pF)
    spectrum = np.fft.rfft(1e-12 * charge_pC) * rate / admittance
    if chain.filtered:
        spectrum = spectrum * _low_pass()
    return np.asarray(np.fft.irfft(spectrum, SAMPLES))


def swing_V(charge_pC: Floats, film_capacitance_pF: float, chain: Chain) -> float:
    """Maximum minus minimum of the recorded voltage: the paper's V_B - V_A."""
    return float(np.ptp(recorded_V(charge_pC, film_capacitance_pF, chain)))


@cache
def _low_pass() -> NDArray[np.complex128]:
    """Response (SAMPLES / 2 + 1,) of the Butterworth filter."""
    angular = 2.0 * np.pi * np.fft.rfftfreq(SAMPLES, PERIOD_S / SAMPLES)
    coefficients = butter(ORDER, 2.0 * np.pi * LOW_PASS_HZ, analog=True)
    return np.asarray(freqs(*coefficients, worN=angular)[1])


def chain(values: Values, filtered: bool = True) -> Chain:
    """The read-out of given inputs."""
    return Chain(values["resistance_MOhm"], values["capacitance_pF"], filtered)

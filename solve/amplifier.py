"""From the charge of the film to the voltage that is recorded.

Voltage mode: the film, a charge source with capacitance C_f, drives R parallel to C_f + C_in:
    (C_f + C_in) V' = Q' - V / R
Charge mode: V' = -Q' / C_fb - V / (R_fb C_fb) (MSI Piezo Film Sensors Technical Manual, pp. 38-41).
The input and the Butterworth filters behind it are integrated exactly for what is linear between the samples: a
first-order hold (Franklin, Powell and Workman, Digital Control of Dynamic Systems, 1998, section 6.3).
"""

from functools import lru_cache

import numba as nb
import numpy as np
from scipy.linalg import expm
from scipy.signal import butter, impulse, tf2ss

from mesh.types import Floats
from solve.parameters import Readout
from solve.physics import Physics

SAMPLES = 4001  # of the even grid of a filter, at least


def amplify(time_s: Floats, charge_C: Floats, capacitance_F: float, readout: Readout, physics: Physics) -> Floats:
    """Voltage (t,) from the film's short-circuit charge (t,) at times (t,), from rest."""
    capacitance, resistance = input_of(readout, capacitance_F)
    voltage = leaky_integral(time_s, charge_C, capacitance, resistance)
    for frequency_Hz, amplitude_V in physics.hum:
        voltage += amplitude_V * np.sin(2.0 * np.pi * frequency_Hz * time_s)
    if readout.limit_V is not None:
        voltage = np.clip(voltage, -readout.limit_V, readout.limit_V)
    for corner_Hz, order, kind in filters(readout, physics):
        voltage = butterworth(time_s, voltage, corner_Hz, order, kind)
    return np.asarray(readout.polarity * voltage)


def input_of(readout: Readout, film_capacitance_F: float) -> tuple[float, float]:
    """Capacitance (F) and resistance (Ohm) into which the charge flows; both negative behind a charge amplifier."""
    if readout.mode == "charge":
        return -1e-12 * (readout.feedback_pF or np.inf), -1e6 * (readout.feedback_MOhm or np.inf)
    capacitance = film_capacitance_F + 1e-12 * readout.input_capacitance_pF
    return capacitance, 1e6 * (readout.input_resistance_MOhm or np.inf)


def filters(readout: Readout, physics: Physics) -> list[tuple[float, int, str]]:
    """Corner (Hz), order and kind of every filter behind the input."""
    own = ((readout.low_pass_Hz, "low"), (readout.high_pass_Hz, "high"))
    named = [(corner, readout.filter_order, kind) for corner, kind in own if corner is not None]
    return named + [(corner, order, "low") for corner, order in physics.low_pass]


@nb.njit(cache=True)
def leaky_integral(time: Floats, charge: Floats, capacitance: float, resistance: float) -> Floats:
    """V of C V' = Q' - V / R from rest, shape (n,), exact for a charge linear between the samples."""
    voltage = np.zeros(len(time))
    last, fade, gain = -1.0, 1.0, 1.0
    for n in range(len(time) - 1):
        step = time[n + 1] - time[n]
        if step != last:
            decay = step / (resistance * capacitance)
            fade, gain, last = np.exp(-decay), -np.expm1(-decay) / decay if decay > 0.0 else 1.0, step
        voltage[n + 1] = fade * voltage[n] + gain * (charge[n + 1] - charge[n]) / capacitance
    return voltage


def butterworth(time: Floats, voltage: Floats, corner_Hz: float, order: int, kind: str) -> Floats:
    """An analog Butterworth filter from rest, (n,), on an even grid as fine as the samples' mean."""
    even = np.linspace(time[0], time[-1], max(len(time), SAMPLES))
    step = float(even[1] - even[0])
    recurrence = _discrete(corner_Hz, order, kind, step)
    if len(even) == len(time) and np.abs(even - time).max() < 1e-9 * step:
        return np.asarray(_march(*recurrence, voltage))
    return np.asarray(np.interp(time, even, _march(*recurrence, np.interp(even, time, voltage))))


@lru_cache(maxsize=64)
def _discrete(corner_Hz: float, order: int, kind: str, step: float) -> tuple[Floats, Floats, Floats, Floats, float]:
    """A, the gains of the sample before and of this one, c and d of _march, by the exponential of one matrix."""
    a, b, c, d = tf2ss(*butter(order, 2.0 * np.pi * corner_Hz, kind, analog=True))
    generator = np.zeros((order + 2, order + 2))
    generator[:order, :order], generator[:order, order], generator[order, order + 1] = step * a, step * b[:, 0], 1.0
    held = expm(generator)
    rising = held[:order, order + 1].copy()
    return np.ascontiguousarray(held[:order, :order]), held[:order, order] - rising, rising, c[0], float(d[0, 0])


@lru_cache(maxsize=64)
def largest_gain(order: int, kind: str) -> float:
    """Integral of |impulse response|: by how much a Butterworth filter can enlarge the largest value, at any corner.

    A high-pass of order n has, besides its direct passage, the impulse response of its state space.
    """
    a, b, c, d = tf2ss(*butter(order, 1.0, kind, analog=True))
    time = np.linspace(0.0, 120.0, 24_001)
    direct = np.abs(d[0, 0])
    return float(direct + np.trapezoid(np.abs(impulse((a, b, c, 0.0 * d), T=time)[1]), time))


@nb.njit(cache=True)
def _march(a: Floats, first: Floats, second: Floats, c: Floats, d: float, given: Floats) -> Floats:
    """x <- A x + first v_n + second v_(n+1) from x = 0; y = c x + d v."""
    order = len(a)
    state, new = np.zeros(order), np.zeros(order)
    answer = np.empty(len(given))
    for n in range(len(given)):
        answer[n] = d * given[n]
        for i in range(order):
            if n > 0:
                new[i] = first[i] * given[n - 1] + second[i] * given[n]
                for j in range(order):
                    new[i] += a[i, j] * state[j]
        state[:] = new
        for i in range(order):
            answer[n] += c[i] * state[i]
    return answer

"""Analog filters behind the input of an amplifier, from rest.

Butterworth of any order, and a low-pass of order two of any quality Q:
    H(s) = w0^2 / (s^2 + s w0 / Q + w0^2)
Half the power is left at the corner w: (w / w0)^2 = x with x^2 + (1 / Q^2 - 2) x - 1 = 0 (Zverev, Handbook of Filter
Synthesis, 1967, section 2). Q is 1/2 for two equal RC stages, 1/sqrt(3) for Bessel's and 1/sqrt(2) for Butterworth's.
Dead time delays what leaves the filter: that of a converter, or what a filter of higher order adds to one of order two.
Integrated exactly for what is linear between the samples: a first-order hold (Franklin, Powell and Workman, Digital
Control of Dynamic Systems, 1998, section 6.3).

An amplifier at its limit: hard, or with a rounded knee.

V -> V / (1 + |V / V_max|^p)^(1 / p) (Rapp, Effects of HPA-nonlinearity on a 4-DPSK/OFDM-signal, ESA SP-332, 1991,
pp. 179-184), a hard clip for an infinite sharpness p. p = 2.5 is close to a hyperbolic tangent.
"""

from dataclasses import dataclass
from functools import lru_cache
from math import hypot, sqrt
from typing import Literal

import numba as nb
import numpy as np
from scipy.linalg import expm
from scipy.signal import butter, impulse, tf2ss

from geometry.arrays import Floats

SAMPLES = 4001  # of the even grid of a filter, at least


@dataclass(frozen=True)
class Filter:
    """corner_Hz : half the power is left there. quality : of a low-pass of order 2 only, None for Butterworth's.

    delay_s : dead time.
    """

    corner_Hz: float
    order: int
    kind: Literal["low", "high"] = "low"
    quality: float | None = None
    delay_s: float = 0.0

    def transfer(self) -> tuple[Floats, Floats]:
        """Numerator and denominator of H(s) but for the dead time, highest power first."""
        corner = 2.0 * np.pi * self.corner_Hz
        if self.quality is None:
            numerator, denominator = butter(self.order, corner, self.kind, analog=True)
            return numerator, denominator
        natural = corner / corner_over_natural(self.quality)
        return np.array([natural**2]), np.array([1.0, natural / self.quality, natural**2])

    def applied(self, time: Floats, voltage: Floats) -> Floats:
        """Filtered voltage (n,) at times (n,), on an even grid as fine as the samples' mean."""
        even = np.linspace(time[0], time[-1], max(len(time), SAMPLES))
        step = float(even[1] - even[0])
        recurrence = _discrete(self, step)
        if self.delay_s == 0.0 and len(even) == len(time) and np.abs(even - time).max() < 1e-9 * step:
            return np.asarray(_march(*recurrence, voltage))
        return np.asarray(np.interp(time - self.delay_s, even, _march(*recurrence, np.interp(even, time, voltage))))

    def largest_gain(self) -> float:
        """Integral of |impulse response|: by how much it can enlarge the largest value, at any corner."""
        return _largest_gain(Filter(0.5 / np.pi, self.order, self.kind, self.quality))


def corner_over_natural(quality: float) -> float:
    """w / w0 where half the power of a low-pass of order two is left."""
    half = 1.0 - 0.5 / quality**2
    return 1.0 / sqrt(hypot(half, 1.0) - half)


@lru_cache(maxsize=64)
def _discrete(own: Filter, step: float) -> tuple[Floats, Floats, Floats, Floats, float]:
    """A, the gains of the sample before and of this one, c and d of _march, by the exponential of one matrix."""
    a, b, c, d = tf2ss(*own.transfer())
    order = own.order
    generator = np.zeros((order + 2, order + 2))
    generator[:order, :order], generator[:order, order], generator[order, order + 1] = step * a, step * b[:, 0], 1.0
    held = expm(generator)
    rising = held[:order, order + 1].copy()
    return np.ascontiguousarray(held[:order, :order]), held[:order, order] - rising, rising, c[0], float(d[0, 0])


@lru_cache(maxsize=64)
def _largest_gain(own: Filter) -> float:
    """Of a filter whose corner is one radian per second.

    A high-pass of order n has, besides its direct passage, the impulse response of its state space.
    """
    a, b, c, d = tf2ss(*own.transfer())
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


@dataclass(frozen=True)
class Saturation:
    """limit_V : what is never exceeded. sharpness : p of the knee, infinite for none."""

    limit_V: float
    sharpness: float = np.inf

    def applied(self, voltage: Floats) -> Floats:
        """Voltage (t,) behind it."""
        hard = np.clip(voltage, -self.limit_V, self.limit_V)
        if np.isinf(self.sharpness):
            return np.asarray(hard)
        ratio = np.abs(voltage) / self.limit_V
        inside = np.minimum(ratio, 1.0 / np.maximum(ratio, 1e-300))  # no power of what is above 1: no overflow
        return np.asarray(hard * (1.0 + inside**self.sharpness) ** (-1.0 / self.sharpness))

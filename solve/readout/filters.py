"""Analog filters behind the input of an amplifier, from rest.

Butterworth of any order, and a low-pass of order two of any quality Q:
    H(s) = w0^2 / (s^2 + s w0 / Q + w0^2)
Half the power is left at the corner w: (w / w0)^2 = x with x^2 + (1 / Q^2 - 2) x - 1 = 0 (Zverev, Handbook of Filter
Synthesis, 1967, section 2). Q is 1/2 for two equal RC stages, 1/sqrt(3) for Bessel's and 1/sqrt(2) for Butterworth's.
Dead time delays what leaves the filter: that of a converter, or what a filter of higher order adds to one of order two.
Integrated exactly for what is linear between the samples: a first-order hold (Franklin, Powell and Workman, Digital
Control of Dynamic Systems, 1998, section 6.3).
"""

from dataclasses import dataclass
from functools import lru_cache
from math import hypot, sqrt
from typing import ClassVar, Literal

import numba as nb
import numpy as np
from scipy.linalg import expm

from geometry.arrays import Floats
from solve.readout.stages import FILTER

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
    place: ClassVar[int] = FILTER

    def transfer(self) -> tuple[Floats, Floats]:
        """Numerator and denominator of H(s) but for the dead time, highest power first."""
        from scipy.signal import butter  # half a second, which a press without a filter need not wait

        corner = 2.0 * np.pi * self.corner_Hz
        if self.quality is None:
            numerator, denominator = butter(self.order, corner, self.kind, analog=True)
            return numerator, denominator
        natural = corner / corner_over_natural(self.quality)
        return np.array([natural**2]), np.array([1.0, natural / self.quality, natural**2])

    def applied(self, time_s: Floats, voltage_V: Floats) -> Floats:
        """Filtered voltage (n,) at times (n,), on an even grid as fine as the samples' mean."""
        even = np.linspace(time_s[0], time_s[-1], max(len(time_s), SAMPLES))
        step = float(even[1] - even[0])
        recurrence = _discrete(self, step)
        if self.delay_s == 0.0 and len(even) == len(time_s) and np.abs(even - time_s).max() < 1e-9 * step:
            return np.asarray(_march(*recurrence, voltage_V))
        return np.asarray(
            np.interp(time_s - self.delay_s, even, _march(*recurrence, np.interp(even, time_s, voltage_V)))
        )

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
    from scipy.signal import tf2ss

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
    from scipy.signal import impulse, tf2ss

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

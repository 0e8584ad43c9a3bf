"""Analog filters behind the input of an amplifier, from rest.

Butterworth of any order, and a low-pass of order two of any quality Q:
    H(s) = w0^2 / (s^2 + s w0 / Q + w0^2)
Half the power is left at the corner w: (w / w0)^2 = x with x^2 + (1 / Q^2 - 2) x - 1 = 0 (Zverev, Handbook of Filter
Synthesis, 1967, section 2). Q is 1/2 for two equal RC stages, 1/sqrt(3) for Bessel's and 1/sqrt(2) for Butterworth's.
Dead time delays what leaves the filter: that of a converter, or what a filter of higher order adds to one of order two.
Integrated exactly for what is linear between the samples: a first-order hold (Franklin, Powell and Workman, Digital
Control of Dynamic Systems, 1998, section 6.3).
"""

from dataclasses import dataclass, replace
from functools import lru_cache
from math import hypot, sqrt
from typing import ClassVar, Literal

import numba as nb
import numpy as np
from scipy.linalg import expm

from foundation.arrays import Floats, Ints
from solve.compiled import copy_numbers
from solve.readout.stages import FILTER

SAME_STEP = 1e-9  # relative difference of two steps that count as one


@dataclass(frozen=True)
class Filter:
    """Analog filter behind an amplifier's input. corner_Hz : half the power is left there. quality : of a low-pass of
    order 2 only, None for Butterworth's.

    delay_s : dead time.
    """

    corner_Hz: float
    order: int
    kind: Literal["low", "high"] = "low"
    quality: float | None = None
    delay_s: float = 0.0
    place: ClassVar[int] = FILTER

    def transfer(self) -> tuple[Floats, Floats]:
        """Coefficients of the numerator and denominator of H(s) but for the dead time, highest power first."""
        from scipy.signal import butter  # half a second, which a press without a filter need not wait

        corner = 2.0 * np.pi * self.corner_Hz
        if self.quality is None:
            numerator, denominator = butter(self.order, corner, self.kind, analog=True)
            return numerator, denominator
        natural = corner / corner_over_natural(self.quality)
        return np.array([natural**2]), np.array([1.0, natural / self.quality, natural**2])

    def apply(self, time_s: Floats, voltage_V: Floats) -> Floats:
        """Filter a voltage (n,) at increasing times (n,), even or not."""
        number, recurrences = _recurrence_of_steps(self, time_s)
        filtered = _recur(number, *recurrences, voltage_V)
        return filtered if self.delay_s == 0.0 else np.interp(time_s - self.delay_s, time_s, filtered)

    def largest_gain(self) -> float:
        """Integral of |impulse response|: by how much it can enlarge the largest value, at any corner."""
        return _unit_gain(Filter(0.5 / np.pi, self.order, self.kind, self.quality))


def corner_over_natural(quality: float) -> float:
    """Ratio w / w0 of the corner, where half the power is left, to the natural frequency of a low-pass of order two."""
    half = 1.0 - 0.5 / quality**2
    return 1.0 / sqrt(hypot(half, 1.0) - half)


Recurrences = tuple[Floats, Floats, Floats, Floats, float]


def _recurrence_of_steps(own: Filter, time_s: Floats) -> tuple[Ints, Recurrences]:
    """Number of the recurrence of each step between the times (n - 1,), and the recurrences of all sizes of step."""
    step = np.diff(time_s)
    if len(step) == 0:
        return np.zeros(0, dtype=np.int64), _discretise(own, (1.0,))
    mean = float(time_s[-1] - time_s[0]) / len(step)
    even = time_s[0] + mean * np.arange(len(time_s))
    if np.abs(even - time_s).max() < SAME_STEP * mean:
        return np.zeros(len(step), dtype=np.int64), _discretise(own, (mean,))
    _, first, number = np.unique(np.round(np.log(step) / SAME_STEP), return_index=True, return_inverse=True)
    return number.ravel(), _discretise(own, tuple(step[first].tolist()))


@lru_cache(maxsize=64)
def _discretise(own: Filter, steps: tuple[float, ...]) -> Recurrences:
    """A, the gains of the sample before and of this one for each step, c and d of _recur, by exponentials of matrices.

    Time is counted in units of the corner, so that no coefficient of a high order is out of range.
    """
    from scipy.signal import tf2ss

    corner = 2.0 * np.pi * own.corner_Hz
    a, b, c, d = tf2ss(*replace(own, corner_Hz=0.5 / np.pi).transfer())
    order, size = own.order, corner * np.array(steps)
    generator = np.zeros((len(size), order + 2, order + 2))
    generator[:, :order, :order] = size[:, None, None] * a
    generator[:, :order, order] = size[:, None] * b[:, 0]
    generator[:, order, order + 1] = 1.0
    held = expm(generator)
    rising = held[:, :order, order + 1].copy()
    return np.ascontiguousarray(held[:, :order, :order]), held[:, :order, order] - rising, rising, c[0], float(d[0, 0])


@lru_cache(maxsize=64)
def _unit_gain(own: Filter) -> float:
    """Integral of |impulse response| of a filter whose corner is one radian per second.

    A high-pass of order n has, besides its direct passage, the impulse response of its state space.
    """
    from scipy.signal import impulse, tf2ss

    a, b, c, d = tf2ss(*own.transfer())
    time = np.linspace(0.0, 120.0, 24_001)
    direct = np.abs(d[0, 0])
    return float(direct + np.trapezoid(np.abs(impulse((a, b, c, 0.0 * d), T=time)[1]), time))


@nb.njit(cache=True)
def _recur(number: Ints, a: Floats, first: Floats, second: Floats, c: Floats, d: float, given: Floats) -> Floats:
    """Answer (n,) of x <- A x + first v_n + second v_(n+1) from x = 0, with the A and gains of each step, y = c x + d
    v.
    """
    order = len(c)
    state, new = np.zeros(order), np.zeros(order)
    answer = np.empty(len(given))
    for n in range(len(given)):
        answer[n] = d * given[n]
        for i in range(order):
            if n > 0:
                k = number[n - 1]
                new[i] = first[k, i] * given[n - 1] + second[k, i] * given[n]
                for j in range(order):
                    new[i] += a[k, i, j] * state[j]
        copy_numbers(new, state)
        for i in range(order):
            answer[n] += c[i] * state[i]
    return answer

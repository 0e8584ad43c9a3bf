"""What stands behind the input of an amplifier, in order: what adds to the voltage, what limits it, what filters it.

A limit, hard or with a rounded knee: V -> V / (1 + |V / V_max|^p)^(1 / p) (Rapp, Effects of HPA-nonlinearity on a
4-DPSK/OFDM-signal, ESA SP-332, 1991, pp. 179-184), a hard clip for an infinite sharpness p. p = 2.5 is close to a
hyperbolic tangent.
"""

from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np

from foundation.arrays import Floats

INPUT, GAIN, LIMIT, FILTER, CONVERTER = range(5)
"""Where a stage stands: at the input, where it is amplified, at the limit of the amplifier, behind it, at its end."""


class Stage(Protocol):
    """A part of the amplifier. Stages of one place stand in the order in which they were switched on."""

    place: ClassVar[int]

    def apply(self, time_s: Floats, voltage_V: Floats) -> Floats:
        """Voltage (t,) behind the stage, of the voltage (t,) before it at times (t,)."""

    def largest_gain(self) -> float:
        """Factor by which the stage can at most enlarge an error of the voltage before it."""


@dataclass(frozen=True)
class Hum:
    """A sine that adds to the voltage; its phase is zero at time zero."""

    frequency_Hz: float
    amplitude_V: float
    place: ClassVar[int] = INPUT

    def apply(self, time_s: Floats, voltage_V: Floats) -> Floats:
        """Add the sine to a voltage (t,)."""
        return np.asarray(voltage_V + self.amplitude_V * np.sin(2.0 * np.pi * self.frequency_Hz * time_s))

    def largest_gain(self) -> float:
        """One: an error passes unchanged."""
        return 1.0


@dataclass(frozen=True)
class Gain:
    """The gain of the amplifier, a number."""

    gain: float
    place: ClassVar[int] = GAIN

    def apply(self, time_s: Floats, voltage_V: Floats) -> Floats:
        """Amplify a voltage (t,), whatever the times."""
        return self.gain * voltage_V

    def largest_gain(self) -> float:
        """The gain itself."""
        return abs(self.gain)


@dataclass(frozen=True)
class Saturation:
    """A limit of the voltage. limit_V : never exceeded. sharpness : p of the knee, infinite for none."""

    limit_V: float
    sharpness: float = np.inf
    place: ClassVar[int] = LIMIT

    def apply(self, time_s: Floats, voltage_V: Floats) -> Floats:
        """Limit a voltage (t,), whatever the times."""
        hard = np.clip(voltage_V, -self.limit_V, self.limit_V)
        if np.isinf(self.sharpness):
            return np.asarray(hard)
        ratio = np.abs(voltage_V) / self.limit_V
        inside = np.minimum(ratio, 1.0 / np.maximum(ratio, 1e-300))  # no power of what is above 1: no overflow
        return np.asarray(hard * (1.0 + inside**self.sharpness) ** (-1.0 / self.sharpness))

    def largest_gain(self) -> float:
        """One: a limit enlarges no error."""
        return 1.0


@dataclass(frozen=True)
class ConverterRange(Saturation):
    """The range of a converter, which is a hard limit behind all filters."""

    place: ClassVar[int] = CONVERTER

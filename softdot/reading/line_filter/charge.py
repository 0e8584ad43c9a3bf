"""The charge behind voltages, as means over blocks of samples: Q = C V + integral of (V - V0) / R. It does not depend
on the speed, and white noise of the voltages makes it a slow random walk.
"""

from dataclasses import dataclass, field

import numba as nb
import numpy as np

from foundation.arrays import Floats


@dataclass
class ChargeBlocks:
    """The charge of some channels, in pC, block of samples after block.

    capacitance_F, resistance_Ohm (n,) : into which the charge flows, with the sign of the channel. resting_V (n,) : the
    voltage that is taken for none. samples : in a block.
    """

    capacitance_F: Floats
    resistance_Ohm: Floats
    resting_V: Floats
    samples: int
    step_s: float
    last_V: Floats = field(init=False)
    leaked: Floats = field(init=False)

    def __post_init__(self) -> None:
        """Begin without a charge."""
        self.last_V = np.zeros(len(self.resting_V))
        self.leaked = np.zeros(len(self.resting_V))

    def add(self, voltage_V: Floats) -> Floats:
        """Mean charges (b, n) of whole blocks of voltages (b * samples, n)."""
        return np.asarray(
            block_charges(
                voltage_V - self.resting_V, 1e12 * self.capacitance_F, 1e12 * self.step_s / self.resistance_Ohm,
                self.last_V, self.leaked, self.samples,
            )
        )  # fmt: skip


@nb.njit(cache=True)
def block_charges(voltage, capacitance, leak, last, leaked, samples):  # type: ignore[no-untyped-def]
    """Mean charges (b, n); last and leaked (n,) are moved on. leak (n,) : charge of a volt that leaves in a sample."""
    found = np.zeros((voltage.shape[0] // samples, voltage.shape[1]))
    for t in range(found.shape[0] * samples):
        for j in range(voltage.shape[1]):
            leaked[j] += 0.5 * leak[j] * (voltage[t, j] + last[j])
            last[j] = voltage[t, j]
            found[t // samples, j] += (capacitance[j] * voltage[t, j] + leaked[j]) / samples
    return found


def noise_V(voltage_V: Floats) -> Floats:
    """Standard deviation of the white noise of each channel (n,), by third differences, which a slow signal passes."""
    third = np.abs(np.diff(voltage_V, 3, axis=0))
    return np.asarray(np.median(third, axis=0) / (0.6745 * np.sqrt(20.0)))

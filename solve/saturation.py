"""An amplifier at its limit: hard, or with a rounded knee.

V -> V / (1 + |V / V_max|^p)^(1 / p) (Rapp, Effects of HPA-nonlinearity on a 4-DPSK/OFDM-signal, ESA SP-332, 1991,
pp. 179-184), a hard clip for an infinite sharpness p. p = 2.5 is close to a hyperbolic tangent.
"""

from dataclasses import dataclass

import numpy as np

from mesh.types import Floats


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

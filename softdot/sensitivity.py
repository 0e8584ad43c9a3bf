"""Signal per press, and the smallest press whose signal exceeds the noise."""

import numpy as np

from foundation.arrays import Floats
from solve.model import Readout


def sensitivity(
    indentation_mm: Floats, force_N: Floats, charge_pC: Floats, voltage_V: Floats, readout: Readout | None
) -> dict[str, float | None]:
    """Secants at the deepest step and the least detectable indentation. All histories of shape (s,).

    voltage_V : at the amplifier where there is one, else open circuit.
    """
    noise = (readout or Readout()).noise_V
    deepest = int(np.argmax(indentation_mm))
    least = least_detectable(indentation_mm, voltage_V, noise)
    return {
        "voltage_per_mm": _quotient(voltage_V[deepest], indentation_mm[deepest]),
        "charge_pC_per_N": _quotient(charge_pC[deepest], force_N[deepest]),
        "least_detectable_indentation_um": None if least is None else 1e3 * least,
        "noise_V": noise,
    }


def least_detectable(indentation_mm: Floats, voltage_V: Floats, noise_V: float) -> float | None:
    """Indentation in mm at which |V| first reaches the noise, None when it never does.

    Linear between load steps; before the first one by the power law V ~ u^n through the first two, as the signal of a
    held film grows much faster than the indentation.
    """
    size = np.abs(voltage_V)
    above = np.flatnonzero(size >= noise_V)
    if len(above) == 0:
        return None
    k = int(above[0])
    if k == 0:
        return 0.0
    if k == 1:
        return float(indentation_mm[1] * (noise_V / size[1]) ** (1.0 / _exponent(indentation_mm, size)))
    share = (noise_V - size[k - 1]) / (size[k] - size[k - 1])
    return float(indentation_mm[k - 1] + share * (indentation_mm[k] - indentation_mm[k - 1]))


def _exponent(indentation_mm: Floats, size: Floats) -> float:
    """Slope of log V over log u through the first two load steps; 1 where these do not rise."""
    if len(size) < 3 or not size[2] > size[1] or not indentation_mm[2] > indentation_mm[1] > 0:
        return 1.0
    return float(np.log(size[2] / size[1]) / np.log(indentation_mm[2] / indentation_mm[1]))


def _quotient(value: float, over: float) -> float | None:
    """The quotient, None for a divisor of zero."""
    return float(value / over) if over else None

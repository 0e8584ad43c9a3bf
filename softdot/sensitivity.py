"""Signal per press, and the smallest press whose signal exceeds the noise."""

import numpy as np

from foundation.arrays import Floats
from solve.model import Model
from solve.readout.course import PressCourse
from solve.readout.noise import NoiseBudget, noise_budget
from solve.result import PressResult


def press_noise(model: Model, result: PressResult, along: PressCourse) -> NoiseBudget | None:
    """Noise of one amplifier of all electrodes over a press; None where none is stated as it is bought."""
    if model.readout is None or model.readout.amplifier is None:
        return None
    duration_s = float(along.time_s[-1] - along.time_s[0])
    return noise_budget(model.readout, model.physics, float(result.capacitance_F.sum()), duration_s)


def sensitivity(
    indentation_mm: Floats, force_N: Floats, charge_pC: Floats, voltage_V: Floats, noise_V: float
) -> dict[str, float | None]:
    """Secants at the deepest step and the least detectable press. All histories of shape (s,).

    voltage_V : at the amplifier where there is one, else open circuit.
    """
    deepest = int(np.argmax(indentation_mm))
    least = least_detectable(indentation_mm, voltage_V, noise_V)
    least_N = least_detectable(force_N, voltage_V, noise_V)
    return {
        "voltage_per_mm": _quotient(voltage_V[deepest], indentation_mm[deepest]),
        "charge_pC_per_N": _quotient(charge_pC[deepest], force_N[deepest]),
        "least_detectable_indentation_um": None if least is None else 1e3 * least,
        "least_detectable_force_mN": None if least_N is None else 1e3 * least_N,
        "noise_V": noise_V,
    }


def least_detectable(press: Floats, voltage_V: Floats, noise_V: float) -> float | None:
    """Indentation or force, in the unit of press (s,), at which |V| first reaches the noise, None when it never does.

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
        return float(press[1] * (noise_V / size[1]) ** (1.0 / _exponent(press, size)))
    share = (noise_V - size[k - 1]) / (size[k] - size[k - 1])
    return float(press[k - 1] + share * (press[k] - press[k - 1]))


def _exponent(press: Floats, size: Floats) -> float:
    """Slope of log V over log u through the first two load steps; 1 where these do not rise."""
    if len(size) < 3 or not size[2] > size[1] or not press[2] > press[1] > 0:
        return 1.0
    return float(np.log(size[2] / size[1]) / np.log(press[2] / press[1]))


def _quotient(value: float, over: float) -> float | None:
    """The quotient, None for a divisor of zero."""
    return float(value / over) if over else None

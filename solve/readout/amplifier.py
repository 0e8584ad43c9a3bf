"""From the charge of the film to the voltage that is recorded.

Voltage mode: the film, a charge source with capacitance C_f, drives R parallel to C_f + C_in:
    (C_f + C_in) V' = Q' - V / R
Charge mode: V' = -Q' / C_fb - V / (R_fb C_fb) (MSI Piezo Film Sensors Technical Manual, pp. 38-41).
The input is integrated exactly for what is linear between the samples; then come the filters.
"""

import numba as nb
import numpy as np

from geometry.arrays import Floats
from solve.model import Physics
from solve.parameters import Readout
from solve.readout.filters import Filter
from solve.readout.stages import Saturation, Stage


def amplify(time_s: Floats, charge_C: Floats, capacitance_F: float, readout: Readout, physics: Physics) -> Floats:
    """Voltage (t,) from the film's short-circuit charge (t,) at times (t,), from rest."""
    capacitance, resistance = input_of(readout, capacitance_F)
    voltage = leaky_integral(time_s, charge_C, capacitance, resistance)
    for stage in stages(readout, physics):
        voltage = stage.applied(time_s, voltage)
    return np.asarray(readout.polarity * voltage)


def input_of(readout: Readout, film_capacitance_F: float) -> tuple[float, float]:
    """Capacitance (F) and resistance (Ohm) into which the charge flows; both negative behind a charge amplifier."""
    if readout.mode == "charge":
        return -1e-12 * (readout.feedback_pF or np.inf), -1e6 * (readout.feedback_MOhm or np.inf)
    capacitance = film_capacitance_F + 1e-12 * readout.input_capacitance_pF
    return capacitance, 1e6 * (readout.input_resistance_MOhm or np.inf)


def stages(readout: Readout, physics: Physics) -> list[Stage]:
    """Everything behind the input, in order; of one place those of the read-out come first."""
    order = readout.filter_order
    limit = [] if readout.limit_V is None else [Saturation(readout.limit_V)]
    low = [] if readout.low_pass_Hz is None else [Filter(readout.low_pass_Hz, order)]
    high = [] if readout.high_pass_Hz is None else [Filter(readout.high_pass_Hz, order, "high")]
    return sorted([*limit, *low, *high, *physics.electronics], key=lambda stage: stage.place)


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

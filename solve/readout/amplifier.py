"""From the charge of the film to the voltage that is recorded.

Voltage mode: the film, a charge source with capacitance C_f, drives R parallel to C_f + C_in:
    (C_f + C_in) V' = Q' - V / R
Charge mode: V' = -Q' / C_fb - V / (R_fb C_fb) (MSI Piezo Film Sensors Technical Manual, pp. 38-41).
The input is integrated exactly for what is linear between the samples; then come the filters.
"""

import numba as nb
import numpy as np

from foundation.arrays import Floats
from solve.decay import mean_decay
from solve.model import Readout
from solve.physics import Physics
from solve.readout.filters import Filter
from solve.readout.part import Amplifier
from solve.readout.stages import ConverterRange, Gain, Saturation, Stage


def amplify(time_s: Floats, charge_C: Floats, capacitance_F: float, readout: Readout, physics: Physics) -> Floats:
    """Voltage (t,) from the film's short-circuit charge (t,) at times (t,), from rest."""
    voltage = leaky_integral(time_s, charge_C, *input_of(readout, capacitance_F))
    return output_voltage(time_s, voltage, readout, physics)


def output_voltage(time_s: Floats, voltage_V: Floats, readout: Readout, physics: Physics, channel: int = 0) -> Floats:
    """Voltage (t,) that an amplifier gives for the voltage (t,) at its input; channel as in stages."""
    for stage in stages(readout, physics, channel):
        voltage_V = stage.apply(time_s, voltage_V)
    return np.asarray(readout.polarity * voltage_V)


def input_of(readout: Readout, film_capacitance_F: float) -> tuple[float, float]:
    """Capacitance (F) and resistance (Ohm) into which the charge flows; both negative behind a charge amplifier."""
    if readout.mode == "charge":
        return -1e-12 * (readout.feedback_pF or np.inf), -1e6 * (readout.feedback_MOhm or np.inf)
    capacitance = film_capacitance_F + 1e-12 * readout.whole_input_pF
    return capacitance, 1e6 * (readout.input_resistance_MOhm or np.inf)


def stages(readout: Readout, physics: Physics, channel: int = 0) -> list[Stage]:
    """Stages behind the input, in order; of one place those of the read-out come first.

    channel : from 1, whose own stages come last of their place; 0 for an amplifier of all electrodes.
    """
    order = readout.filter_order
    limit = [] if readout.limit_V is None else [Saturation(readout.limit_V)]
    low = [] if readout.low_pass_Hz is None else [Filter(readout.low_pass_Hz, order)]
    high = [] if readout.high_pass_Hz is None else [Filter(readout.high_pass_Hz, order, "high")]
    own = [stage for part in physics.channels for stage in part.stages_behind(channel)]
    bought = bought_stages(readout.amplifier)
    return sorted([*limit, *low, *high, *bought, *physics.stages, *own], key=lambda stage: stage.place)


def bought_stages(part: Amplifier | None) -> list[Stage]:
    """Stages of an amplifier as it is bought: gain, bandwidth, range of the converter."""
    if part is None:
        return []
    gain: list[Stage] = [] if part.gain == 1.0 else [Gain(part.gain)]
    slow: list[Stage] = [] if part.bandwidth_Hz is None else [Filter(part.bandwidth_Hz, 1)]
    return [*gain, *slow, *([] if part.adc_range_V is None else [ConverterRange(part.adc_range_V)])]


@nb.njit(cache=True)
def leaky_integral(time: Floats, charge: Floats, capacitance: float, resistance: float) -> Floats:
    """Voltage (n,) of C V' = Q' - V / R from rest, exact for a charge linear between the samples."""
    voltage = np.zeros(len(time))
    last, fade, gain = -1.0, 1.0, 1.0
    for n in range(len(time) - 1):
        step = time[n + 1] - time[n]
        if step != last:
            decay = step / (resistance * capacitance)
            fade, gain, last = np.exp(-decay), mean_decay(decay), step
        voltage[n + 1] = fade * voltage[n] + gain * (charge[n + 1] - charge[n]) / capacitance
    return voltage


@nb.njit(cache=True)
def curved_integral(time: Floats, charge: Floats, capacitance: float, resistance: float) -> Floats:
    """Voltage (n,) of C V' = Q' - V / R from rest, exact for a charge that is a parabola over each two equal steps; n
    odd.

    With x = t / RC, p1 = (1 - exp(-x)) / x and p2 = (1 - p1) / x, a charge a t + b t^2 gives (a t p1 + 2 b t^2 p2) / C.
    """
    voltage = np.zeros(len(time))
    for n in range(0, len(time) - 2, 2):
        step = time[n + 1] - time[n]
        bend = 0.5 * (charge[n] - 2.0 * charge[n + 1] + charge[n + 2])
        rise = charge[n + 1] - charge[n] - bend
        for steps in (1, 2):
            decay = steps * step / (resistance * capacitance)
            first = mean_decay(decay)
            second = (1.0 - first) / decay if decay > 1e-3 else 0.5 - decay / 6.0 + decay**2 / 24.0
            gained = rise * steps * first + 2.0 * bend * steps**2 * second
            voltage[n + steps] = np.exp(-decay) * voltage[n] + gained / capacitance
    return voltage

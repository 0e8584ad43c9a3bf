"""Several electrodes, each on an amplifier of its own, whose inputs stray capacitances tie together.

Voltage mode, with the capacitance C_i of film and input, the resistance R_i and the mutual capacitances C_ij of inputs:
    C_i V_i' + sum_j C_ij (V_i' - V_j') = Q_i' - V_i / R_i
which is reciprocal (Paul, Introduction to Electromagnetic Compatibility, 2nd ed. 2006, chapter 9). With the symmetric
matrices C and G of it, the modes of G x = a C x, with x' C x = 1, do not act on each other:
    y' = x . Q' - a y,    V = sum of x y
and each of them is integrated exactly for charges that are linear between the samples. The inputs of charge amplifiers
are virtual grounds: a capacitance between them carries nothing.
"""

from collections.abc import Callable

import numpy as np
from scipy.linalg import eigh

from foundation.arrays import Floats
from solve.model import Readout
from solve.physics import Physics
from solve.readout.amplifier import input_of, leaky_integral, output_voltage
from solve.readout.channel_parts import capacitances_F, conductances_uS, with_crosstalk_V


def amplify_channels(
    time_s: Floats, charge_C: Floats, capacitance_F: Floats, readout: Readout, physics: Physics
) -> Floats:
    """Voltage (e, t) of every channel from the short-circuit charges (t, e) of electrodes with capacitances (e,).

    From rest at times (t,). What leaks from one input, ties two together, filters one channel or mixes what they give
    is in the physics, with channels numbered from 1.
    """
    return output_voltages(time_s, input_voltages(time_s, charge_C, capacitance_F, readout, physics), readout, physics)


def output_voltages(time_s: Floats, voltage_V: Floats, readout: Readout, physics: Physics) -> Floats:
    """Voltages (e, t) that all channels give for those (e, t) at their inputs, crosstalk included."""
    alone = [output_voltage(time_s, own, readout, physics, number) for number, own in enumerate(voltage_V, start=1)]
    return with_crosstalk_V(physics.channels, np.array(alone))


Integral = Callable[[Floats, Floats, float, float], Floats]


def input_voltages(
    time_s: Floats,
    charge_C: Floats,
    capacitance_F: Floats,
    readout: Readout,
    physics: Physics,
    integral: Integral = leaky_integral,
) -> Floats:
    """Voltage (e, t) at every input; integral : leaky_integral or curved_integral of solve.readout.amplifier.

    ValueError for a pair with a channel that is not there.
    """
    inputs = [input_of(readout, float(one)) for one in capacitance_F]
    if readout.mode == "charge":
        charges = zip(charge_C.T, inputs, strict=True)
        return np.array([integral(time_s, np.ascontiguousarray(q), c, r) for q, (c, r) in charges])
    between = capacitances_F(physics.channels, len(inputs))
    conductance = np.array([1.0 / r for _, r in inputs]) + 1e-6 * conductances_uS(physics.channels, len(inputs))
    capacitance = np.array([c for c, _ in inputs])
    if not between.any():
        told = zip(charge_C.T, capacitance, conductance, strict=True)
        return np.array([integral(time_s, np.ascontiguousarray(q), c, _resistance(g)) for q, c, g in told])
    rate, shape = eigh(np.diag(conductance), np.diag(capacitance) + between)
    driven = np.ascontiguousarray((charge_C @ shape).T)
    modes = [integral(time_s, own, 1.0, _resistance(a)) for own, a in zip(driven, rate, strict=True)]
    return np.asarray(shape @ np.array(modes))


def _resistance(conductance: float) -> float:
    """Resistance of a conductance, infinite for none; round-off makes no resistance negative."""
    return 1.0 / conductance if conductance > 0.0 else np.inf

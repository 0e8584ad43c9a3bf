"""What acts on the voltages behind the film: white noise, hum, slow drift, and the wiring of the channels."""

import numpy as np

from foundation.arrays import Floats
from softdot.reading.conditions import ReadingConditions
from softdot.reading.hand import slow_process

HUM_DRIFT_S, DRIFT_S = 2.0, 10.0
"""Correlation times of the frequency of the hum, and of the drift of the voltages."""


def disturbed(voltage_V: Floats, time_s: Floats, conditions: ReadingConditions, random: np.random.Generator) -> Floats:
    """Voltages (t, n) as they are recorded of those behind the film."""
    channels = voltage_V.shape[1]
    noise = 1e-3 * conditions.noise_mV * random.standard_normal(voltage_V.shape)
    found = voltage_V * _gains(channels, conditions, random) + noise
    found += _hum_V(time_s, conditions, random)[:, None] + _drift_V(time_s, channels, conditions, random)
    if conditions.dead_channel:
        found[:, int(conditions.dead_channel) - 1] = noise[:, int(conditions.dead_channel) - 1]
    if conditions.swapped_channel:
        first = int(conditions.swapped_channel) - 1
        found[:, [first, (first + 1) % channels]] = found[:, [(first + 1) % channels, first]]
    if conditions.reversed_channel:
        found[:, int(conditions.reversed_channel) - 1] *= -1.0
    return -found if conditions.reversed_all else found


def _gains(channels: int, conditions: ReadingConditions, random: np.random.Generator) -> Floats:
    """Gain (n,) of each channel."""
    if conditions.gain_scatter == 0.0:
        return np.ones(channels)
    return 1.0 + random.uniform(-conditions.gain_scatter, conditions.gain_scatter, channels)


def _hum_V(time_s: Floats, conditions: ReadingConditions, random: np.random.Generator) -> Floats:
    """Hum (t,), the same in all channels, with a third harmonic."""
    start = 2.0 * np.pi * random.random()
    if conditions.hum_mV == 0.0:
        return np.zeros(len(time_s))
    step = float(time_s[1] - time_s[0])
    drift = (
        conditions.hum_drift_Hz * slow_process(len(time_s), step / HUM_DRIFT_S, random)
        if conditions.hum_drift_Hz
        else 0.0
    )
    phase = start + 2.0 * np.pi * (conditions.hum_Hz * time_s + step * np.cumsum(drift))
    return 1e-3 * conditions.hum_mV * np.asarray(np.sin(phase) + conditions.hum_third * np.sin(3.0 * phase))


def _drift_V(
    time_s: Floats, channels: int, conditions: ReadingConditions, random: np.random.Generator
) -> Floats | float:
    """Slow drift (t, n) of each channel."""
    if conditions.drift_mV == 0.0:
        return 0.0
    step = float(time_s[1] - time_s[0]) / DRIFT_S
    return (
        1e-3
        * conditions.drift_mV
        * np.stack([slow_process(len(time_s), step, random) for _ in range(channels)], axis=1)
    )

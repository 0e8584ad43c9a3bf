"""Begin and end of the voltages of a sliding array, and a first guess of its speed by their frequencies."""

import numpy as np

from foundation.arrays import Floats
from foundation.errors import InputError
from softdot.reading.decoders.templates import Posture, templates
from softdot.reading.voltages import Reader, Voltages

SLOWEST_MM_PER_S, FASTEST_MM_PER_S, TRIED_SPEEDS = 0.5, 500.0, 13
"""Range of the speeds whose templates are compared with the voltages, and their number."""
ONSET_SIGMA, STRENGTH_QUANTILE = 6.0, 0.9
"""Noise levels above which a mean is a signal, and the quantile of the means that measures their strength."""
AVERAGED_SAMPLES, LEAST_GROUPS = (1, 2, 4, 8, 16, 32, 64), 20
"""Numbers of samples in a mean that are tried, and the least number of means."""


class NoDotError(InputError):
    """Raised where nothing stands out of the noise."""


def noise_by_channel_V(heard: Voltages) -> Floats:
    """Standard deviation of the noise of each channel (n,), by the median of differences of neighbouring samples."""
    return np.asarray(np.median(np.abs(np.diff(heard.voltage_V, axis=0)), axis=0) / (0.6745 * np.sqrt(2.0)))


def active_interval(heard: Voltages) -> tuple[float, float]:
    """First and last time at which means of samples stand out of their noise, over the length that shows it best."""
    noise = np.maximum(noise_by_channel_V(heard), 1e-6 * np.abs(heard.voltage_V).max() + 1e-15)
    best, first, last = 0.0, 0, 0
    for many in AVERAGED_SAMPLES:
        groups = len(heard.time_s) // many
        if groups < LEAST_GROUPS and many > 1:
            break
        mean = heard.voltage_V[: groups * many].reshape(groups, many, -1).mean(axis=1)
        over = (np.abs(mean - np.median(mean, axis=0)) / (noise / np.sqrt(many))).max(axis=1)
        loud = np.flatnonzero(over > ONSET_SIGMA)
        strength = float(np.quantile(over, STRENGTH_QUANTILE))
        if len(loud) and strength > best:
            best, first, last = strength, int(loud[0]) * many, min(int(loud[-1] + 1) * many, len(heard.time_s) - 1)
    if best == 0.0:
        raise NoDotError("voltages: nothing stands out of their noise; there is no dot to read")
    return float(heard.time_s[first]), float(heard.time_s[last])


def first_speed(reader: Reader, heard: Voltages, onset: float, end: float) -> float:
    """The speed at which templates have the same median frequency as the voltages."""
    inside = (heard.time_s >= onset) & (heard.time_s <= end)
    measured = _median_Hz(heard.voltage_V[inside], heard.step_s, noise_by_channel_V(heard))
    speeds = np.geomspace(SLOWEST_MM_PER_S, FASTEST_MM_PER_S, TRIED_SPEEDS)
    known = []
    for speed in speeds:
        step = 0.1 / speed
        voltage = templates(reader, Posture(float(speed)), step).voltage_V
        known.append(_median_Hz(voltage.reshape(len(voltage), -1), step, np.zeros(1)))
    return float(np.exp(np.interp(np.log(measured), np.log(np.maximum.accumulate(known)), np.log(speeds))))


def _median_Hz(voltage: Floats, step_s: float, noise: Floats) -> float:
    """The frequency below which half of the power of all channels lies, white noise subtracted."""
    power = (np.abs(np.fft.rfft(voltage - voltage.mean(axis=0), axis=0)) ** 2).sum(axis=1)
    power = power - len(voltage) * float((noise**2).sum()) * (voltage.shape[1] if noise.size == 1 else 1.0)
    total = np.cumsum(power)
    frequency = np.fft.rfftfreq(len(voltage), step_s)
    return max(float(frequency[np.argmax(total >= 0.5 * total.max())]), float(frequency[1]))

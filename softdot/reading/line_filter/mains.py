"""Hum of any frequency near the mains: found in the first seconds, then followed sample by sample.

Each channel has complex amplitudes z of the hum and of its harmonics, all with one phase p,
    V = Re sum over k of z_k exp(i k p) + rest,    z_k += 2 b rest exp(-i k p),    p' = w,
and the frequency w follows the turn of z that is common to all channels, in a loop that is critically damped.
"""

from typing import Any

import numba as nb
import numpy as np

from foundation.arrays import Floats

LOWEST_HZ, HIGHEST_HZ = 43.0, 67.0
"""Range in which hum is looked for."""
HARMONICS = 3
"""The hum itself and the harmonics that are followed."""
BANDWIDTH_HZ = 0.5
"""Of the amplitudes that are followed."""
LEAST_PEAK, ALIKE = 6.0, 0.9
"""Least power of a line over the median of the powers around it, and least share of it with one phase."""
PARTS, STEADY = 4, 0.4
"""Parts of the time, and least size of hum in one of them over that in another."""
FREQUENCY, PHASE = 0, 1
"""Places in the state: angular frequency per sample and phase."""


def hum_frequency_Hz(voltage_V: Floats, sampling_Hz: float) -> float | None:
    """The frequency of the hum in voltages (t, n); None where there is none.

    Hum has one phase in all channels, or the opposite one, so that its Fourier coefficients X have |sum of X^2| near
    sum of |X|^2. Dots that pass one segment after the other have lines there too, but with a phase of their own in
    each channel.
    """
    count = len(voltage_V)
    if sampling_Hz < 2.5 * HIGHEST_HZ or count < sampling_Hz:
        return None
    window, padded = np.hanning(count)[:, None], 8 * count
    lines = np.fft.rfft(window * (voltage_V - voltage_V.mean(axis=0)), padded, axis=0)
    frequency = np.fft.rfftfreq(padded, 1.0 / sampling_Hz)
    inside = (frequency >= LOWEST_HZ) & (frequency <= HIGHEST_HZ)
    frequency, lines = frequency[inside], lines[inside]
    power, alike = (np.abs(lines) ** 2).sum(axis=1), np.abs((lines**2).sum(axis=1))
    peak = int(np.argmax(alike))
    if peak in (0, len(power) - 1) or power[peak] < LEAST_PEAK * np.median(power) or alike[peak] < ALIKE * power[peak]:
        return None
    left, middle, right = np.log(power[peak - 1 : peak + 2])
    bend = left - 2.0 * middle + right
    found = frequency[peak] + (0.5 * (left - right) / bend if bend < 0.0 else 0.0) * (frequency[1] - frequency[0])
    return float(found) if _is_steady(voltage_V, 2.0 * np.pi * found / sampling_Hz, lines[peak]) else None


def _is_steady(voltage_V: Floats, per_sample: float, line: Any) -> bool:
    """Whether a line (n,) of the spectrum is there all the time, as hum is and dots that pass are not."""
    turning = np.exp(-1j * per_sample * np.arange(len(voltage_V)))[:, None]
    common = ((voltage_V - voltage_V.mean(axis=0)) * turning) @ np.conj(line)
    size = [abs(part.mean()) for part in np.array_split(common, PARTS)]
    return bool(min(size) > STEADY * max(size))


def hum_state(voltage_V: Floats, sampling_Hz: float, frequency_Hz: float | None) -> tuple[Floats, Floats]:
    """Frequency and phase (2,) and amplitudes (harmonic, 2, n), by least squares over voltages (t, n) of some seconds.

    The frequency is 0 where there is no hum.
    """
    count, channels = voltage_V.shape
    amplitude = np.zeros((HARMONICS, 2, channels))
    if frequency_Hz is None:
        return np.zeros(2), amplitude
    per_sample = 2.0 * np.pi * frequency_Hz / sampling_Hz
    kept = [k for k in range(1, HARMONICS + 1) if k * frequency_Hz < 0.45 * sampling_Hz]
    phase = per_sample * np.arange(count)
    waves = np.stack([wave(k * phase) for k in kept for wave in (np.cos, np.sin)], axis=1)
    found = np.linalg.lstsq(waves, voltage_V - voltage_V.mean(axis=0), rcond=None)[0]
    for number in range(len(kept)):
        amplitude[number] = found[2 * number : 2 * number + 2]
    return np.array([per_sample, 0.0]), amplitude


@nb.njit(cache=True)
def without_hum(voltage, state, amplitude, bandwidth):  # type: ignore[no-untyped-def]
    """Voltages (t, n) less the hum that is followed; state (2,) and amplitude (harmonic, 2, n) are moved on.

    bandwidth : of the amplitudes, in radians per sample.
    """
    rest = voltage.copy()
    if state[FREQUENCY] == 0.0:
        return rest
    for t in range(voltage.shape[0]):
        turn, size = 0.0, 1e-300
        for k in range(amplitude.shape[0]):
            if (k + 1) * state[FREQUENCY] > 0.9 * np.pi:
                break
            c, s = np.cos((k + 1) * state[PHASE]), np.sin((k + 1) * state[PHASE])
            for j in range(voltage.shape[1]):
                rest[t, j] -= amplitude[k, 0, j] * c + amplitude[k, 1, j] * s
        for k in range(amplitude.shape[0]):
            if (k + 1) * state[FREQUENCY] > 0.9 * np.pi:
                break
            c, s = np.cos((k + 1) * state[PHASE]), np.sin((k + 1) * state[PHASE])
            for j in range(voltage.shape[1]):
                a, b = 2.0 * bandwidth * rest[t, j] * c, 2.0 * bandwidth * rest[t, j] * s
                if k == 0:
                    turn += amplitude[0, 0, j] * b - amplitude[0, 1, j] * a
                    size += amplitude[0, 0, j] ** 2 + amplitude[0, 1, j] ** 2
                amplitude[k, 0, j] += a
                amplitude[k, 1, j] += b
        state[FREQUENCY] -= 0.25 * bandwidth * turn / size
        state[PHASE] = (state[PHASE] + state[FREQUENCY]) % (2.0 * np.pi)
    return rest

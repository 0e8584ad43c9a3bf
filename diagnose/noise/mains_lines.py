"""Mains lines: sinusoids at 50 or 60 Hz and its harmonics, found by an F test against the neighbouring frequencies.

The test is that of Thomson, Proc. IEEE 70 (1982) 1055, with single periodogram ordinates in place of tapered ones, as
stretches of rest are short.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize_scalar
from scipy.stats import f as f_distribution

from foundation.arrays import Floats

MAINS_HZ = (50.0, 60.0)
MAINS_DEVIATION_HZ = 0.3  # of the mains' frequency
HARMONICS = 10
MOST_SEARCHED_SAMPLES = 20_000  # in which a line is sought; its frequency is then refined with all
NEIGHBOUR_OFFSETS = np.array([-6.0, -5.0, -4.0, -3.0, -2.0, 2.0, 3.0, 4.0, 5.0, 6.0])  # in units of 1 / duration
FALSE_ALARM_PROBABILITY = 1e-3  # of finding any line where there is none


@dataclass(frozen=True)
class Line:
    """A sinusoid of the mains. amplitude : its peak, in the unit of the channel."""

    frequency_Hz: float
    amplitude: float


def line_basis(lines: Sequence[Line], time_s: Floats) -> Floats:
    """Columns (t, 2 l) at times (t,) whose random combination with unit variances has the power of the l lines."""
    columns = [line.amplitude / np.sqrt(2.0) * wave(2.0 * np.pi * line.frequency_Hz * time_s)
               for line in lines for wave in (np.cos, np.sin)]  # fmt: skip
    return np.column_stack(columns) if columns else np.zeros((len(time_s), 0))


def find_lines(times_s: Sequence[Floats], stretches: Sequence[Floats], step_s: float) -> tuple[Line, ...]:
    """Mains lines in stretches (n_i,) of zero mean at times (n_i,) in s; none where they are too short to tell."""
    if not stretches:
        return ()
    longest = max(range(len(stretches)), key=lambda n: len(stretches[n]))
    time, values = times_s[longest][:MOST_SEARCHED_SAMPLES], stretches[longest][:MOST_SEARCHED_SAMPLES]
    duration = len(values) * step_s
    found = [_mains_harmonics(mains, time, values, duration, 0.5 / step_s) for mains in MAINS_HZ]
    frequency, orders, _ = max(found, key=lambda item: item[2])
    if not orders:
        return ()
    time, values = np.concatenate(times_s), np.concatenate(stretches)
    frequency = _refine_frequency(frequency, orders, time, values, duration)
    return tuple(Line(k * frequency, float(np.sqrt(4.0 * _power_at(time, values, k * frequency)))) for k in orders)


def subtract_lines(lines: Sequence[Line], times_s: Sequence[Floats], stretches: Sequence[Floats]) -> list[Floats]:
    """Stretches (n_i,) less the sinusoids that fit all of them best by least squares; unchanged without lines."""
    if not lines:
        return list(stretches)
    rows = [line_basis(lines, time) for time in times_s]
    solution, *_ = np.linalg.lstsq(np.concatenate(rows), np.concatenate(stretches), rcond=None)
    return [values - row @ solution for values, row in zip(stretches, rows, strict=True)]


def _mains_harmonics(
    mains: float, time: Floats, values: Floats, duration: float, nyquist: float
) -> tuple[float, list[int], float]:
    """Frequency of the mains, orders of the harmonics that stand out, and the sum of their F ratios."""
    orders = [k for k in range(1, HARMONICS + 1) if k * (mains + MAINS_DEVIATION_HZ) < nyquist]
    if not orders or 8.0 / duration > mains:
        return mains, [], 0.0
    grid = mains + np.arange(-MAINS_DEVIATION_HZ, MAINS_DEVIATION_HZ + 1e-9, 0.25 / (orders[-1] * duration))
    grid = grid if len(grid) < 200 else np.linspace(mains - MAINS_DEVIATION_HZ, mains + MAINS_DEVIATION_HZ, 200)
    frequency = max(grid, key=lambda f: _power_at(time, values, f) + _power_at(time, values, 3.0 * f))
    limit = float(
        f_distribution.isf(
            FALSE_ALARM_PROBABILITY / (len(MAINS_HZ) * HARMONICS * len(grid)), 2, 2 * len(NEIGHBOUR_OFFSETS)
        )
    )
    ratios = {k: _power_ratio(time, values, k * frequency, duration) for k in orders}
    return frequency, [k for k in orders if ratios[k] > limit], sum(r for r in ratios.values() if r > limit)


def _power_ratio(time: Floats, values: Floats, frequency: float, duration: float) -> float:
    """Power at a frequency over the mean power at its neighbours."""
    around = np.mean([_power_at(time, values, f) for f in frequency + NEIGHBOUR_OFFSETS / duration])
    return _power_at(time, values, frequency) / float(around) if around > 0.0 else 0.0


def _power_at(time: Floats, values: Floats, frequency: float) -> float:
    """Power at a frequency, |mean of values exp(-2 pi i f t)|^2: a quarter of the squared amplitude of a sinusoid."""
    return float(np.abs(np.mean(values * np.exp(-2j * np.pi * frequency * time))) ** 2)


def _refine_frequency(near: float, orders: list[int], time: Floats, values: Floats, duration: float) -> float:
    """Frequency, near a first estimate, at which the harmonics hold the most power in all stretches together."""
    reach = 0.5 / (orders[-1] * duration)
    fine = np.linspace(near - reach, near + reach, 101)

    def negative_power(frequency: float) -> float:
        return -sum(_power_at(time, values, k * frequency) for k in orders)

    best = min(fine, key=negative_power)
    step = float(fine[1] - fine[0])
    return float(minimize_scalar(negative_power, bounds=(best - step, best + step), method="bounded").x)

"""The lag between two signals that were sampled on two clocks.

The lag maximises the likelihood of signal(t) = a reference(t - lag) + b + noise: the peak of the cross-correlation,
refined below the sampling step by Gauss-Newton on a cubic spline. Its variance is the Cramer-Rao bound of a delay (Kay,
Fundamentals of Statistical Signal Processing: Estimation Theory, 1993, example 3.13), with the covariance of an
autoregression that is fitted to what is left.
"""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.signal import correlate

from diagnose.noise.autoregression import fit_autoregression
from foundation.arrays import Floats

MAX_ITERATIONS = 20
FINEST_LAG_STEPS = 1e-5  # no lag is known better


@dataclass(frozen=True)
class Lag:
    """Lag of a signal behind a reference. lag_s : by how much the signal comes later. sigma_s : its standard error.

    correlation : of signal and shifted reference, -1 to 1.
    """

    lag_s: float
    sigma_s: float
    correlation: float


def lag_between(reference: Floats, signal: Floats, step_s: float, largest_s: float | None = None) -> Lag:
    """Lag of a signal (n,) behind a reference (m,) that start together, both sampled every step_s.

    largest_s : largest lag that is sought, either way; half of the shorter one if None. ValueError for a constant
    signal.
    """
    if np.ptp(reference) == 0.0 or np.ptp(signal) == 0.0:
        raise ValueError("a constant has no lag")
    limit = min(len(reference), len(signal)) / 2.0
    limit = limit if largest_s is None else min(limit, largest_s / step_s)
    shift = float(_whole_step_shift(reference, signal, int(limit)))
    spline = CubicSpline(np.arange(len(reference)), reference)
    for _ in range(MAX_ITERATIONS):
        fit = _fit_shift(spline, len(reference), signal, shift)
        shift = float(np.clip(shift + fit.update, -limit, limit))
        if abs(fit.update) < FINEST_LAG_STEPS:
            break
    return Lag(shift * step_s, max(_standard_error_steps(fit), FINEST_LAG_STEPS) * step_s, fit.correlation)


def _whole_step_shift(reference: Floats, signal: Floats, limit: int) -> int:
    """Shift in whole steps, up to a limit, at which the magnitude of the cross-correlation is largest."""
    product = np.abs(correlate(signal - signal.mean(), reference - reference.mean(), mode="full", method="fft"))
    shifts = np.arange(len(product)) - (len(reference) - 1)
    allowed = np.abs(shifts) <= limit
    return int(shifts[allowed][np.argmax(product[allowed])])


@dataclass(frozen=True)
class _Fit:
    """Fit linear about a shift. update : Gauss-Newton step of the shift, in steps.

    sensitivity : (n,) of the signal to the shift, gain and offset projected out. rest : (n,) what is left of the
    signal. correlation : of signal and shifted reference.
    """

    update: float
    sensitivity: Floats
    rest: Floats
    correlation: float


def _fit_shift(spline: CubicSpline, length: int, signal: Floats, shift: float) -> _Fit:
    """Least-squares fit of shift, gain and offset, linear about a shift; all in steps."""
    place = np.arange(len(signal)) - shift
    inside = (place >= 0.0) & (place <= length - 1.0)
    template, slope, values = spline(place[inside]), spline(place[inside], 1), signal[inside]
    scale, _offset = np.polyfit(template, values, 1)
    free = np.column_stack([template, np.ones(len(template))])
    moving = -scale * slope
    sensitivity = moving - free @ np.linalg.lstsq(free, moving, rcond=None)[0]
    update = float(sensitivity @ values / (sensitivity @ sensitivity))
    left = values - update * moving
    rest = left - free @ np.linalg.lstsq(free, left, rcond=None)[0]
    return _Fit(update, sensitivity, rest, float(np.corrcoef(template, values)[0, 1]))


def _standard_error_steps(fit: _Fit) -> float:
    """Standard error of the shift, in steps: sqrt(w' C w) / w' w with the sensitivity w.

    C is the covariance of an autoregression fitted to the rest, applied by its spectral density.
    """
    weights, count = fit.sensitivity, 2 * len(fit.sensitivity)
    density = 0.5 * fit_autoregression([fit.rest]).spectral_density(
        np.asarray(np.fft.fftfreq(count), dtype=np.float64), 1.0
    )
    variance = np.mean(np.abs(np.fft.fft(weights, count)) ** 2 * density)
    return float(np.sqrt(variance) / (weights @ weights))

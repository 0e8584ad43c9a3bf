"""Noise of the recorder: autoregressions fitted to rest in real recordings, scaled to a stated size.

From charge to voltage by the trapezoidal rule on a finer grid, and filters of another kind than the rig states.
"""

import os
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Literal

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.linalg import solve_toeplitz
from scipy.signal import bessel, butter, lfilter, resample_poly, sosfilt

from diagnose.prove.world.laws import Floats

ORDER = 6
REST_S, RECORDED_HZ = 0.8, 2000
STATED = Path(__file__).with_name("noise.toml")
WARM_UP = 500


@dataclass(frozen=True)
class Autoregression:
    """y_t = sum a_i y_(t-i) + e_t with unit variance of y; sigma : of e."""

    coefficients: tuple[float, ...]
    sigma: float

    def draw(self, rng: np.random.Generator, count: int) -> Floats:
        """Noise (count,) of unit variance."""
        driven = self.sigma * rng.standard_normal(count + WARM_UP)
        return np.asarray(lfilter([1.0], [1.0, *(-a for a in self.coefficients)], driven)[WARM_UP:])

    def whitened(self, values: Floats) -> Floats:
        """Errors of one-step prediction of values (t, ...) in units of the noise's own; nothing known before."""
        return np.asarray(lfilter([1.0, *(-a for a in self.coefficients)], [1.0], values, axis=0) / self.sigma)


@lru_cache(maxsize=8)
def noises() -> Mapping[str, Autoregression]:
    """force_N and voltage_V: from rest in SOFTDOT_RECORDINGS (presses of P(VDF-TrFE) as .npz), else as stated."""
    folder = os.environ.get("SOFTDOT_RECORDINGS")
    if folder:
        return fitted(Path(folder))
    stated = tomllib.loads(STATED.read_text("utf-8"))
    return {name: Autoregression(tuple(one["coefficients"]), one["sigma"]) for name, one in stated.items()}


def fitted(folder: Path, rate_Hz: float = 250.0) -> Mapping[str, Autoregression]:
    """Yule-Walker's equations for the mean autocovariance of all files, resampled. FileNotFoundError without any."""
    force, voltage = [], []
    for file in sorted(folder.glob("*.npz")):
        with np.load(file) as data:
            force.append(_rest(data["force"].astype(np.float64), rate_Hz))
            voltage.append(_rest(data["voltage_code"][:, 0] * float(data["lsb_V"]), rate_Hz))
    if not force:
        raise FileNotFoundError(f"no .npz recordings in '{folder}'")
    return {"force_N": yule_walker(force), "voltage_V": yule_walker(voltage)}


def yule_walker(stretches: list[Floats], order: int = ORDER) -> Autoregression:
    """Of stretches of rest, each to its own mean; those twice as unquiet as usual were no rest."""
    covariance = np.zeros(order + 1)
    usual = float(np.median([rest.std() for rest in stretches]))
    for rest in (rest for rest in stretches if rest.std() <= 2.0 * usual):
        around = rest - rest.mean()
        around = around / max(float(around.std()), 1e-300)
        covariance += [around[: len(around) - k] @ around[k:] / len(around) for k in range(order + 1)]
    covariance /= covariance[0]
    coefficients = solve_toeplitz(covariance[:-1], covariance[1:])
    return Autoregression(tuple(map(float, coefficients)), float(np.sqrt(1.0 - coefficients @ covariance[1:])))


def _rest(values: Floats, rate_Hz: float) -> Floats:
    """The first samples, before anything is touched, at the rate of the proof."""
    return np.asarray(resample_poly(values[: int(REST_S * RECORDED_HZ)], 1, round(RECORDED_HZ / rate_Hz))[4:-4])


FINER = 8


@dataclass(frozen=True)
class Filter:
    """cutoff_Hz at -3 dB; kind : "bessel", or "butterworth" as the rig states its own."""

    cutoff_Hz: float
    order: int
    kind: Literal["bessel", "butterworth"] = "bessel"

    def applied(self, voltage: Floats, rate_Hz: float) -> Floats:
        """By the bilinear transform, from rest."""
        if self.kind == "bessel":
            sections = bessel(self.order, self.cutoff_Hz, fs=rate_Hz, output="sos", norm="mag")
        else:
            sections = butter(self.order, self.cutoff_Hz, fs=rate_Hz, output="sos")
        return np.asarray(sosfilt(sections, voltage))


@dataclass(frozen=True)
class Amplifier:
    """Input resistance and capacitance, filters in order, hum and a soft limit before them."""

    resistance_MOhm: float | None
    capacitance_pF: float
    filters: tuple[Filter, ...] = ()
    hum_V: float = 0.0
    limit_V: float | None = None

    def voltage(self, time_s: Floats, charge_pC: Floats, film_pF: float, hum_phase: float) -> Floats:
        """Voltage (t,) for the charge (t,) of the film at even times (t,), from rest."""
        rate = FINER * (len(time_s) - 1) / (time_s[-1] - time_s[0])
        fine = time_s[0] + np.arange(FINER * (len(time_s) - 1) + 1) / rate
        voltage = self.input_V(CubicSpline(time_s, charge_pC)(fine), film_pF, rate)
        return self.behind(voltage, fine, rate, hum_phase)[::FINER]

    def behind(self, voltage: Floats, fine_s: Floats, rate_Hz: float, hum_phase: float) -> Floats:
        """Voltage (n,) behind everything that follows the input, on its own fine grid (n,)."""
        angle = 2.0 * np.pi * HUM_HZ * fine_s
        voltage = voltage + self.hum_V * (np.sin(angle + hum_phase) + HARMONIC * np.sin(3.0 * (angle + hum_phase)))
        if self.limit_V is not None:
            voltage = _softly_clipped(voltage, self.limit_V)
        for one in self.filters:
            voltage = one.applied(voltage, rate_Hz)
        return np.asarray(voltage)

    def leaking(self, resistance_MOhm: float | None) -> "Amplifier":
        """With a resistance beside that of its input; None for none."""
        conductance = sum(1.0 / r for r in (self.resistance_MOhm, resistance_MOhm) if r is not None)
        return replace(self, resistance_MOhm=1.0 / conductance if conductance else None)

    def input_V(self, charge_pC: Floats, film_pF: float, rate_Hz: float) -> Floats:
        """Of the fine grid (n,): (C_f + C) V' = Q' - V / R; MOhm times pF is microseconds."""
        capacitance = film_pF + self.capacitance_pF
        half = 0.0 if self.resistance_MOhm is None else 0.5e6 / (rate_Hz * self.resistance_MOhm * capacitance)
        gain = 1.0 / (capacitance * (1.0 + half))
        return np.asarray(lfilter([gain, -gain], [1.0, -(1.0 - half) / (1.0 + half)], charge_pC - charge_pC[0]))


def _softly_clipped(voltage: Floats, limit_V: float) -> Floats:
    """A clip whose corners are those of log(1 + exp(x))."""
    knee = limit_V / SHARPNESS
    from_below, from_above = (np.logaddexp(0.0, (voltage + side) / knee) for side in (limit_V, -limit_V))
    return np.asarray(knee * (from_below - from_above) - limit_V)


HUM_HZ, HARMONIC, SHARPNESS = 49.98, 0.15, 8.0

"""From force and charge to the columns of a file: circuit, gain, lag, zeros, noise, hum and converter."""

from dataclasses import asdict, dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.signal import lfilter

from benchmarks.made_elsewhere.drives import RATE, Path
from benchmarks.made_elsewhere.rigs import Bench

Signal = NDArray[np.float64]
HUM_HZ = 50.0


@dataclass(frozen=True)
class Widths:
    """What a laboratory declares of each run: standard deviations."""

    gain: float = 0.02
    force_gain: float = 0.01
    lag_s: float = 0.003
    offset_V: float = 0.0
    offset_N: float = 0.0
    offset_mm: float = 0.003


@dataclass(frozen=True)
class Errors:
    """What these are in truth, alike in all runs."""

    gain: float
    force_gain: float
    lag_s: float
    offset_V: float
    offset_N: float
    offset_mm: float


@dataclass(frozen=True)
class Noise:
    """Of one recording; a converter's step is of the voltage."""

    voltage_sd_V: float
    voltage_ar1: float
    force_sd_N: float
    force_ar1: float
    displacement_sd_mm: float
    hum_amplitude_V: float
    adc_step_V: float


def drawn(force: float, voltage: float, loudness: float, rng: np.random.Generator) -> tuple[Noise, Widths, Errors]:
    """Noise as shares of the largest signals, widths that go with it, and errors inside them."""
    sd = loudness * rng.uniform(0.7, 1.3) * 0.006 * voltage
    noise = Noise(
        voltage_sd_V=sd,
        voltage_ar1=rng.uniform(0.6, 0.88),
        force_sd_N=loudness * rng.uniform(0.7, 1.3) * 0.006 * force,
        force_ar1=rng.uniform(0.1, 0.5),
        displacement_sd_mm=1e-4,
        hum_amplitude_V=rng.uniform(0.08, 0.2) * sd,
        adc_step_V=sd * rng.uniform(0.05, 0.15),
    )
    widths = Widths(offset_V=float(f"{1.5 * sd:.2g}"), offset_N=float(f"{1.5 * noise.force_sd_N:.2g}"))
    share = {name: width * np.clip(rng.standard_normal(), -1.3, 1.3) for name, width in asdict(widths).items()}
    return noise, widths, Errors(**{**share, "lag_s": abs(share["lag_s"])})


def voltage(bench: Bench, charge: Signal) -> Signal:
    """(Cf + Cin) dV/dt = dQ/dt - V/R, exact for a charge that is linear between rows; pF, MOhm, pC."""
    capacitance = bench.film_capacitance + bench.capacitance
    conductance = 1 / bench.resistance + (1 / bench.leak if bench.leak else 0.0)
    a = conductance / (capacitance * 1e-6 * RATE)
    growth = -np.expm1(-a) / a
    volts = lfilter([1.0], [1.0, -np.exp(-a)], growth * np.diff(charge, prepend=charge[0]) / capacitance)
    if bench.cable is None:
        return volts
    b = 2 * np.pi * bench.cable / RATE
    now, last = 1 + np.expm1(-b) / b, -np.expm1(-b) / b - np.exp(-b)  # exact for a voltage that is linear between rows
    return lfilter([now, last], [1.0, -np.exp(-b)], volts)


def coloured(sd: float, memory: float, n: int, rng: np.random.Generator) -> Signal:
    """Autoregressive noise of first order that is as loud from its first row on."""
    white = sd * np.sqrt(1 - memory**2) * rng.standard_normal(n + 200)
    return lfilter([1.0], [1.0, -memory], white)[200:]


def columns(press: Path, force: Signal, volts: Signal, noise: Noise, errors: Errors, rng: np.random.Generator):
    """time_s, displacement_mm, force_N and voltage_V as they are logged."""
    t, n = press.time, len(press.time)
    late = CubicSpline(t, volts)(np.clip(t - errors.lag_s, 0, None))
    hum = noise.hum_amplitude_V * np.sin(2 * np.pi * HUM_HZ * t + rng.uniform(0, 2 * np.pi))
    shown = (1 + errors.gain) * late + errors.offset_V + hum
    shown += coloured(noise.voltage_sd_V, noise.voltage_ar1, n, rng)
    felt = (1 + errors.force_gain) * force + errors.offset_N + coloured(noise.force_sd_N, noise.force_ar1, n, rng)
    travel = press.depth + errors.offset_mm + noise.displacement_sd_mm * rng.standard_normal(n)
    return t, travel, felt, noise.adc_step_V * np.round(shown / noise.adc_step_V)

"""Noise of the recorder: autoregressions fitted to rest in real recordings, scaled to a stated size."""

import os
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np
from scipy.linalg import solve_toeplitz
from scipy.signal import lfilter, resample_poly

from softdot.studies.proof.world.arrays import Floats

ORDER = 6
REST_S, RECORDED_HZ = 0.8, 2000
STATED = Path(__file__).with_name("noise.toml")
WARM_UP = 500


@dataclass(frozen=True)
class Autoregression:
    """Noise of a channel: y_t = sum a_i y_(t-i) + e_t with unit variance of y; sigma : of e."""

    coefficients: tuple[float, ...]
    sigma: float

    def draw(self, rng: np.random.Generator, count: int) -> Floats:
        """Noise (count,) of unit variance."""
        driven = self.sigma * rng.standard_normal(count + WARM_UP)
        return np.asarray(lfilter([1.0], [1.0, *(-a for a in self.coefficients)], driven)[WARM_UP:])

    def whiten(self, values: Floats) -> Floats:
        """Errors of one-step prediction of values (t, ...) in units of the noise's own; nothing is known before
        them.
        """
        return np.asarray(lfilter([1.0, *(-a for a in self.coefficients)], [1.0], values, axis=0) / self.sigma)


@lru_cache(maxsize=8)
def noises() -> Mapping[str, Autoregression]:
    """Noise of force_N and voltage_V: from rest in SOFTDOT_RECORDINGS (presses of P(VDF-TrFE) as .npz), else as
    stated.
    """
    folder = os.environ.get("SOFTDOT_RECORDINGS")
    if folder:
        return fit_noise(Path(folder))
    stated = tomllib.loads(STATED.read_text("utf-8"))
    return {name: Autoregression(tuple(one["coefficients"]), one["sigma"]) for name, one in stated.items()}


def fit_noise(folder: Path, rate_Hz: float = 250.0) -> Mapping[str, Autoregression]:
    """Noise of the channels by Yule-Walker's equations for the mean autocovariance of all files, resampled.
    FileNotFoundError without any.
    """
    force, voltage = [], []
    for file in sorted(folder.glob("*.npz")):
        with np.load(file) as data:
            force.append(_rest(data["force"].astype(np.float64), rate_Hz))
            voltage.append(_rest(data["voltage_code"][:, 0] * float(data["lsb_V"]), rate_Hz))
    if not force:
        raise FileNotFoundError(f"no .npz recordings in '{folder}'")
    return {"force_N": yule_walker(force), "voltage_V": yule_walker(voltage)}


def yule_walker(stretches: list[Floats], order: int = ORDER) -> Autoregression:
    """Noise of stretches of rest, each to its own mean; those twice as unquiet as usual were no rest."""
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

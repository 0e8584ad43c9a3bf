"""The common parts of searches for designs by Gaussian processes: the process, and the choice among candidates."""

import warnings
from typing import TYPE_CHECKING

import numpy as np

from foundation.arrays import Floats

if TYPE_CHECKING:
    from sklearn.gaussian_process import GaussianProcessRegressor

STEP_DEVIATION = 0.12
"""Standard deviation of steps beside a good design, in shares of an axis."""


def fit_process(
    features: Floats, target: Floats, length: tuple[float, float, float], noise: float
) -> "GaussianProcessRegressor":
    """A linear trend, a smooth deviation from it, and noise, fitted to a target (n,) at features (n, f).

    length : over which the deviation changes: the least, the first guess, the largest. noise : variance of what another
    mesh changes, over that of the target.
    """
    from sklearn.exceptions import ConvergenceWarning
    from sklearn.gaussian_process import GaussianProcessRegressor
    from sklearn.gaussian_process.kernels import ConstantKernel, DotProduct, Matern, WhiteKernel

    least, guess, largest = length
    trend = ConstantKernel(0.1, (1e-4, 1e2)) * DotProduct(1.0, "fixed")
    deviation = ConstantKernel(0.1, (1e-4, 1e2)) * Matern(guess, (least, largest), nu=2.5)
    process = GaussianProcessRegressor(trend + deviation + WhiteKernel(noise, "fixed"), normalize_y=True)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ConvergenceWarning)  # a scale at its bound is an answer too
        return process.fit(features, target)


def steps_beside(place: Floats, count: int, random: np.random.Generator) -> Floats:
    """Random candidates (count, d) beside a place (d,), in shares of the axes."""
    return np.clip(place + STEP_DEVIATION * random.standard_normal((count, len(place))), 0.0, 1.0)


def choose_apart(gains: Floats, places: Floats, known: Floats, count: int, apart: float) -> list[int]:
    """Numbers of at most count candidates with the largest gains (n,), each farther than apart from known ones
    and from the others.

    places : (n, f) of the candidates, known : (k, f).

    >>> choose_apart(np.array([1.0, 3.0, 2.9]), np.array([[0.0], [1.0], [1.1]]), np.array([[5.0]]), 2, 0.5)
    [1, 0]
    """
    chosen: list[int] = []
    for number in np.argsort(-gains, kind="stable"):
        if len(chosen) == count:
            break
        if np.linalg.norm(known - places[number], axis=1).min() > apart:
            chosen.append(int(number))
            known = np.vstack([known, places[number]])
    return chosen

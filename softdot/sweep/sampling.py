"""From axes to points: every combination, a list, or a space-filling design."""

import itertools
import math
import warnings
from typing import Any

import numpy as np

from geometry.base import InputError
from mesh.types import Floats
from softdot.sweep.parameters import MOST_POINTS, Axis, Sweep


def sampled(sweep: Sweep) -> list[tuple[Any, ...]]:
    """The value of each axis at each point. InputError when a grid has too many points."""
    if sweep.sampling == "grid":
        return _grid([levels(axis) for axis in sweep.axes])
    if sweep.sampling == "list":
        return list(zip(*(axis.values or () for axis in sweep.axes), strict=True))
    return [
        tuple(at(axis, float(share)) for axis, share in zip(sweep.axes, shares, strict=True))
        for shares in _unit_cube(sweep)
    ]


def _grid(values: list[list[Any]]) -> list[tuple[Any, ...]]:
    count = math.prod(map(len, values))
    if count > MOST_POINTS:
        sizes = " × ".join(str(len(one)) for one in values)
        raise InputError(f"sweep.axes: this grid has {sizes} = {count} points, at most {MOST_POINTS} are allowed")
    return list(itertools.product(*values))


def levels(axis: Axis) -> list[Any]:
    """The values of an axis of a grid."""
    if axis.values is not None:
        return list(axis.values)
    return [at(axis, share) for share in np.linspace(0.0, 1.0, axis.n or 2).tolist()]


def at(axis: Axis, share: float) -> Any:
    """The value at a share, 0 to 1, of an axis; values in a list have equal shares. Twelve digits."""
    if axis.values is not None:
        return axis.values[min(int(share * len(axis.values)), len(axis.values) - 1)]
    low, high = float(axis.low or 0.0), float(axis.high or 0.0)
    value = low * (high / low) ** share if axis.scale == "log" else low + share * (high - low)
    return min(max(float(f"{value:.12g}"), low), high)


def _unit_cube(sweep: Sweep) -> Floats:
    """Points (n, d) in the unit cube.

    Latin hypercube: one point in each of n slices of every axis (McKay, Beckman and Conover 1979).
    Sobol: scrambled after Owen (1998); its balance holds for powers of two.
    """
    from scipy.stats import qmc

    kind = qmc.Sobol if sweep.sampling == "sobol" else qmc.LatinHypercube
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # not a power of two: sampling_warnings says it
        return np.asarray(kind(len(sweep.axes), seed=np.random.default_rng(sweep.seed)).random(sweep.points or 1))


def sampling_warnings(sweep: Sweep) -> list[str]:
    """What a user should know about this design."""
    count = sweep.points or 1
    if sweep.sampling == "sobol" and count & (count - 1):
        return [f"sweep.points = {count}: Sobol points are balanced only for powers of two"]
    return []

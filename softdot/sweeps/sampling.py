"""The axes of a sweep and the points on them: a grid, or samples that fill the space."""

import itertools
import math
import warnings
from typing import Annotated, Any, Literal, Self

import numpy as np
from pydantic import Field, field_validator, model_validator

from foundation.arrays import Floats
from foundation.errors import InputError
from geometry.parameters import Finite, Table
from softdot.config.toml import key_path

MOST_POINTS = 20_000
"""Largest number of points of a sweep."""
Count = Annotated[int, Field(ge=1, le=MOST_POINTS)]


class Axis(Table):
    """One direction of the space: a key and its values, or several keys that always have the same value."""

    key: str | None = Field(None, description="dotted key, such as segment.medium1.thickness_mm")
    keys: tuple[str, ...] = Field((), description="instead of key: several keys that get the same value")
    values: tuple[Any, ...] | None = Field(None, description="the values: numbers, strings, lists or tables")
    low: Finite | None = Field(None, description="instead of values: smallest value")
    high: Finite | None = Field(None, description="largest value")
    n: Annotated[int, Field(ge=2, le=MOST_POINTS)] | None = Field(None, description="grid: values from low to high")
    scale: Literal["linear", "log"] = Field("linear", description="how the values from low to high are spaced")

    @field_validator("key", "keys")
    @classmethod
    def _readable(cls, given: Any) -> Any:
        for key in [given] if isinstance(given, str) else given or ():
            try:
                key_path(key)
            except ValueError as error:
                raise ValueError(str(error) if key == given else f"'{key}' {error}") from None
        return given

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        if (self.key is None) == (not self.keys):
            raise ValueError("key is missing" if self.key is None else "keys: give either key or keys, not both")
        if self.values is not None:
            self._require_values_alone()
        elif self.low is None or self.high is None:
            missing = "values" if self.low is None and self.high is None else "low" if self.low is None else "high"
            raise ValueError(f"{missing} is missing: an axis needs values, or low and high")
        elif self.low >= self.high:
            raise ValueError(f"low = {self.low:g}: must be below high = {self.high:g}")
        elif self.scale == "log" and self.low <= 0:
            raise ValueError(f"low = {self.low:g}: must be above 0 with scale = 'log'")
        return self

    def _require_values_alone(self) -> None:
        """ValueError where there is no value, or low, high or n besides."""
        if not self.values:
            raise ValueError("values = []: must have at least 1 value")
        for name in ("low", "high", "n"):
            if getattr(self, name) is not None:
                raise ValueError(f"{name} = {getattr(self, name):g}: give either values or low and high, not both")

    def names(self) -> tuple[str, ...]:
        """The keys that this axis sets."""
        return self.keys if self.key is None else (self.key,)


class Sweep(Table):
    """The way in which the space is sampled."""

    sampling: Literal["grid", "list", "latin-hypercube", "sobol"] = Field(
        "grid", description="grid: every combination; list: first values together, second values together, …"
    )
    points: Count | None = Field(None, description="latin-hypercube and sobol: number of points")
    seed: int = Field(0, ge=0, description="of latin-hypercube and sobol")
    workers: Annotated[int, Field(ge=1, le=1024)] | None = Field(
        None, description="processes on this computer; none: one per core"
    )
    axes: tuple[Axis, ...] = Field(min_length=1, description="what varies")

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        random = self.sampling in ("latin-hypercube", "sobol")
        if random and self.points is None:
            raise ValueError(f"points is missing: sampling = '{self.sampling}' needs the number of points")
        if not random and self.points is not None:
            raise ValueError(f"points = {self.points}: the axes of sampling = '{self.sampling}' say how many there are")
        for number, axis in enumerate(self.axes):
            self._require_fitting(axis, f"axes[{number}]")
        self._require_apart()
        return self

    def _require_fitting(self, axis: Axis, name: str) -> None:
        """ValueError unless an axis states as many values as the sampling needs, and no more."""
        if self.sampling == "grid" and axis.values is None and axis.n is None:
            raise ValueError(f"{name}.n is missing: a grid needs the number of values from low to high")
        if self.sampling != "grid" and axis.n is not None:
            raise ValueError(f"{name}.n = {axis.n}: is for sampling = 'grid' only")
        if self.sampling != "list":
            return
        if axis.values is None:
            raise ValueError(f"{name}.values is missing: sampling = 'list' needs the values themselves")
        first = self.axes[0].values or ()
        if len(axis.values) != len(first):
            raise ValueError(
                f"{name}.values has {len(axis.values)} values but axes[0].values has {len(first)}: "
                "one of each per point"
            )

    def _require_apart(self) -> None:
        """ValueError where a key is set twice, or one lies inside another."""
        ways = [(key, key_path(key)) for axis in self.axes for key in axis.names()]
        for number, (key, way) in enumerate(ways):
            for other, before in ways[:number]:
                shorter = min(len(way), len(before))
                if way[:shorter] == before[:shorter]:
                    raise ValueError(f"axes: '{other}' and '{key}' set the same key; remove one of them")


def sample_points(sweep: Sweep) -> list[tuple[Any, ...]]:
    """The value of each axis at each point. InputError when a grid has too many points."""
    if sweep.sampling == "grid":
        return _grid([grid_values(axis) for axis in sweep.axes])
    if sweep.sampling == "list":
        return list(zip(*(axis.values or () for axis in sweep.axes), strict=True))
    return [
        tuple(value_at_share(axis, float(share)) for axis, share in zip(sweep.axes, shares, strict=True))
        for shares in _unit_cube(sweep)
    ]


def _grid(values: list[list[Any]]) -> list[tuple[Any, ...]]:
    """Combinations of all values of the axes. InputError for too many."""
    count = math.prod(map(len, values))
    if count > MOST_POINTS:
        sizes = " × ".join(str(len(one)) for one in values)
        raise InputError(f"sweep.axes: this grid has {sizes} = {count} points, at most {MOST_POINTS} are allowed")
    return list(itertools.product(*values))


def grid_values(axis: Axis) -> list[Any]:
    """The values of an axis of a grid."""
    if axis.values is not None:
        return list(axis.values)
    return [value_at_share(axis, share) for share in np.linspace(0.0, 1.0, axis.n or 2).tolist()]


def value_at_share(axis: Axis, share: float) -> Any:
    """The value at a share, 0 to 1, of an axis, to twelve digits; values in a list have equal shares."""
    if axis.values is not None:
        return axis.values[min(int(share * len(axis.values)), len(axis.values) - 1)]
    low, high = float(axis.low or 0.0), float(axis.high or 0.0)
    value = low * (high / low) ** share if axis.scale == "log" else low + share * (high - low)
    return min(max(float(f"{value:.12g}"), low), high)


def share_of(axis: Axis, value: Any) -> float:
    """The share, 0 to 1, at which an axis has a value; the middle of its share for one in a list.

    >>> share_of(Axis(key="a", low=1.0, high=100.0, scale="log"), 10.0)
    0.5
    """
    if axis.values is not None:
        return (axis.values.index(value) + 0.5) / len(axis.values)
    low, high = float(axis.low or 0.0), float(axis.high or 0.0)
    return math.log(value / low) / math.log(high / low) if axis.scale == "log" else (value - low) / (high - low)


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
    """Warnings of a design that is not balanced."""
    count = sweep.points or 1
    if sweep.sampling == "sobol" and count & (count - 1):
        return [f"sweep.points = {count}: Sobol points are balanced only for powers of two"]
    return []

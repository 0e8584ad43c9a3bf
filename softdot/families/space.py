"""The space of a family: its axes, numbers alone, and the configuration at any place between their ends."""

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from scipy.stats import qmc

from foundation.arrays import Floats
from foundation.errors import InputError
from softdot.config.idle import has_value
from softdot.config.schema import Config
from softdot.config.settings import naming_the_flag, with_settings
from softdot.config.toml import key_path, read_toml
from softdot.sweeps.sampling import Axis, Sweep
from softdot.sweeps.space import point_at, sweep_of

MOST_AXES = 10
NUMERICAL = ("mesh", "array", "fabrication")
"""Tables without numbers of a design that presses on one mesh may differ in."""
SHORT = ("segment.", "materials.")
"""Beginnings of keys that their short names leave out."""


@dataclass(frozen=True)
class Range:
    """An axis of a family. low, high : ends of the value of its keys; even : "log" where ratios are drawn evenly."""

    keys: tuple[str, ...]
    low: float
    high: float
    even: str

    @property
    def name(self) -> str:
        """Short name of the first key, such as medium1_thickness_mm of segment.medium1.thickness_mm."""
        key = self.keys[0]
        for beginning in SHORT:
            key = key.removeprefix(beginning)
        for mark in ".[-":
            key = key.replace(mark, "_")
        return key.replace("]", "").replace(chr(34), "")

    @property
    def is_log(self) -> bool:
        """Whether places are even in the logarithm of the value: where it is positive, laws of powers are lines."""
        return self.low > 0.0

    def places(self, values: Floats | float) -> Floats:
        """Places of values (...), -1 at the low end and 1 at the high one; not finite where there is no logarithm."""
        low, high = (np.log(self.low), np.log(self.high)) if self.is_log else (self.low, self.high)
        with np.errstate(divide="ignore", invalid="ignore"):
            at = np.log(values) if self.is_log else values
        return np.asarray(2.0 * (at - low) / (high - low) - 1.0)

    def values(self, places: Floats | float) -> Floats:
        """Values at places (...)."""
        share = 0.5 * (np.asarray(places) + 1.0)
        if self.is_log:
            return np.asarray(self.low * (self.high / self.low) ** share)
        return np.asarray(self.low + share * (self.high - self.low))

    def slopes(self, places: Floats | float) -> Floats:
        """Derivatives of the value by the place, at places (...)."""
        if self.is_log:
            return np.asarray(0.5 * np.log(self.high / self.low) * self.values(places))
        return np.full(np.shape(places), 0.5 * (self.high - self.low))

    def drawn(self, shares: Floats) -> Floats:
        """Values at shares (...), 0 to 1, of the distribution: even in the value, or in its ratio."""
        if self.even == "log":
            return np.asarray(self.low * (self.high / self.low) ** shares)
        return np.asarray(self.low + shares * (self.high - self.low))


class FamilySpace:
    """The designs of a family. tables : a configuration with a table [sweep] whose axes all have low and high.

    InputError with one sentence for anything that presses on one mesh cannot differ in.
    """

    def __init__(self, tables: Mapping[str, Any]) -> None:
        self.tables = dict(tables)
        self.sweep: Sweep = sweep_of(_without_points(tables))
        self.base = {name: table for name, table in tables.items() if name != "sweep"}
        if len(self.sweep.axes) > MOST_AXES:
            raise InputError(f"sweep.axes: a family has at most {MOST_AXES} numbers, these are {len(self.sweep.axes)}")
        self.ranges = tuple(_range(number, axis) for number, axis in enumerate(self.sweep.axes))
        names = [one.name for one in self.ranges]
        if len(set(names)) < len(names):
            raise InputError(f"sweep.axes: two axes have the same short name, of {', '.join(names)}")
        self._refuse_other_parts()

    @property
    def count(self) -> int:
        """Number of axes."""
        return len(self.ranges)

    @cached_property
    def centre(self) -> Config:
        """The design in the middle of all ranges. InputError where it cannot be built."""
        return self.config_at(np.zeros(self.count))

    def config_at(self, place: Sequence[float] | Floats) -> Config:
        """The configuration at a place (d,). InputError for one that cannot be built."""
        row = tuple(float(one.values(at)) for one, at in zip(self.ranges, place, strict=True))
        point = point_at(self.base, self.sweep, row)
        if point.config is None:
            raise InputError(str(point.reason))
        return point.config

    def drawn_places(self, count: int, seed: int) -> Floats:
        """Places (n, d) of designs drawn from the ranges, spread evenly (a scrambled Sobol sequence)."""
        shares = qmc.Sobol(self.count, seed=np.random.default_rng(seed)).random_base2(int(np.ceil(np.log2(count))))
        return self.places_of_shares(shares[:count])

    def places_of_shares(self, shares: Floats) -> Floats:
        """Places (n, d) of shares (n, d) of the distributions."""
        columns = [one.places(one.drawn(share)) for one, share in zip(self.ranges, shares.T, strict=True)]
        return np.column_stack(columns)

    def told(self, place: Sequence[float] | Floats) -> str:
        """A place in words: each key with its value."""
        pairs = zip(self.ranges, place, strict=True)
        return ", ".join(f"{one.keys[0]} = {float(one.values(at)):.4g}" for one, at in pairs)

    def _refuse_other_parts(self) -> None:
        """InputError where a key does not act, or the ends of an axis differ in anything but numbers."""
        centre, tables = self.centre, self.centre.model_dump(mode="json")
        if centre.array is not None:
            raise InputError("array: a family is of one segment; leave the table out")
        for number, one in enumerate(self.ranges):
            for key in one.keys:
                if not has_value(tables, key_path(key)):
                    raise InputError(f"sweep.axes[{number}]: {key} does not act in this configuration")
            for end in (-1.0, 1.0):
                changed = np.zeros(self.count)
                changed[number] = end
                other = self._config_if_any(changed)
                if other is not None and _parts(other) != _parts(centre):
                    raise InputError(
                        f"sweep.axes[{number}]: {one.keys[0]} changes which parts there are; make one family of each"
                    )

    def _config_if_any(self, place: Floats) -> Config | None:
        """The configuration at a place, None where it cannot be built: presses find the region."""
        try:
            return self.config_at(place)
        except InputError:
            return None


def load_family_space(path: Path, settings: Sequence[str] = ()) -> FamilySpace:
    """The space in SPACE.toml, as of softdot sweep. settings : 'dotted.key=value' after the file. InputError."""
    with naming_the_flag(settings):
        return FamilySpace(with_settings(read_toml(path), settings))


def _without_points(tables: Mapping[str, Any]) -> dict[str, Any]:
    """Tables whose [sweep] leaves the points to the program, as a family does, whatever a sweep would take."""
    sweep = tables.get("sweep")
    if not isinstance(sweep, Mapping) or not isinstance(sweep.get("axes"), list):
        return dict(tables)
    axes = [
        {key: value for key, value in axis.items() if key != "n"} if isinstance(axis, Mapping) else axis
        for axis in sweep["axes"]
    ]
    return {**tables, "sweep": {**sweep, "sampling": "sobol", "points": 1, "axes": axes}}


def _range(number: int, axis: Axis) -> Range:
    """The range of an axis. InputError for one of choices, and for keys of the numerics."""
    keys = axis.names()
    if axis.values is not None or axis.low is None or axis.high is None:
        raise InputError(
            f"sweep.axes[{number}]: {keys[0]} has values; a family needs low and high, and one family of each choice"
        )
    for key in keys:
        if key_path(key)[0] in NUMERICAL or key == "press.load_steps":
            raise InputError(
                f"sweep.axes[{number}]: {key} is no number of a design; a family has one mesh and one course"
            )
    return Range(keys, float(axis.low), float(axis.high), axis.scale)


def _parts(config: Config) -> Any:
    """All of a configuration but its numbers."""

    def bare(value: Any) -> Any:
        if isinstance(value, dict):
            return {key: bare(one) for key, one in value.items()}
        if isinstance(value, list):
            return [bare(one) for one in value]
        return None if isinstance(value, float) else value

    return bare(config.model_dump(mode="python"))


def corners(count: int) -> list[Floats]:
    """Places of the ends of every axis alone, and the middle of all."""
    ends = [
        np.zeros(count),
        *(sign * np.eye(count)[axis] for axis, sign in itertools.product(range(count), (-1.0, 1.0))),
    ]
    return [np.asarray(one) for one in ends]

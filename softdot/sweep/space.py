"""SPACE.toml: a whole configuration and the axes along which it varies."""

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from geometry.base import InputError
from geometry.parameters import Table
from softdot.config import Config, config_from
from softdot.config_errors import sentence, shown
from softdot.default_design import completed
from softdot.dotted_keys import with_value
from softdot.settings import naming_the_flag, with_settings
from softdot.sweep.parameters import Axis, Sweep
from softdot.sweep.sampling import sampled
from softdot.toml_file import read_toml


class _File(Table):
    """The part of SPACE.toml that is not the configuration."""

    sweep: Sweep


@dataclass(frozen=True)
class Point:
    """One design: the values of its keys and its configuration, or the reason why it cannot have one."""

    values: Mapping[str, Any]
    config: Config | None
    reason: str | None = None


@dataclass(frozen=True)
class Space:
    """Every point of a sweep, checked. tables : SPACE.toml as read, text : as written, None for one without a file."""

    tables: Mapping[str, Any]
    sweep: Sweep
    points: tuple[Point, ...]
    text: str | None = None


def load_space(path: Path | str, settings: Sequence[str] = ()) -> Space:
    """Read and check SPACE.toml. InputError as space_from, and for a file that cannot be read.

    settings : 'dotted.key=value' after the file.
    """
    with naming_the_flag(settings):
        space = space_from(with_settings(read_toml(Path(path)), settings))
    added = "".join(f"# with --set {' '.join(setting.split())}\n" for setting in settings)
    return Space(space.tables, space.sweep, space.points, added + Path(path).read_text("utf-8-sig"))


def space_from(tables: Mapping[str, Any]) -> Space:
    """The points of a space. InputError with one sentence for a bad table [sweep] and for a bad axis.

    An axis is bad when it has a value (of low and high, one of them) with which no point can be built. A point whose
    combination alone cannot be built stays, with its reason.
    """
    sweep = _sweep(tables)
    base = {name: table for name, table in tables.items() if name != "sweep"}
    rows = sampled(sweep)
    points = tuple(_point(base, sweep, row) for row in rows)
    _refuse_bad_axes(base, sweep, rows, points)
    return Space(tables, sweep, points)


def _sweep(tables: Mapping[str, Any]) -> Sweep:
    if "sweep" not in tables:
        raise InputError("sweep is missing: SPACE.toml needs a table [sweep] with at least one [[sweep.axes]]")
    own = {"sweep": tables["sweep"]}
    try:
        return _File.model_validate_json(json.dumps(own, default=str), strict=True).sweep
    except ValidationError as error:
        raise InputError(sentence(error, own, _File)) from None


def _point(base: Mapping[str, Any], sweep: Sweep, row: tuple[Any, ...]) -> Point:
    """The point with these values of the axes. InputError for a key that leads nowhere."""
    values: dict[str, Any] = {}
    tables = dict(base)
    for number, axis in enumerate(sweep.axes):
        for key in axis.names():
            values[key] = row[number]
            try:
                tables = with_value(tables, key, row[number])
            except InputError as error:
                raise InputError(f"sweep.axes[{number}]: {error}") from None
    try:
        return Point(values, config_from(completed(tables)))
    except InputError as error:
        return Point(values, None, str(error))


def _refuse_bad_axes(
    base: Mapping[str, Any], sweep: Sweep, rows: list[tuple[Any, ...]], points: tuple[Point, ...]
) -> None:
    good = [row for row, point in zip(rows, points, strict=True) if point.config is not None]
    if not good:
        raise InputError(_of_axis(sweep, points[0].reason or ""))
    for number, axis in enumerate(sweep.axes):
        for name, value in _extremes(axis):
            if any(row[number] == value for row in good):
                continue
            tried = [_point(base, sweep, (*row[:number], value, *row[number + 1 :])) for row in good]
            if all(point.config is None for point in tried):
                raise InputError(f"sweep.axes[{number}].{name} = {shown(value)}: {tried[0].reason}")


def _extremes(axis: Axis) -> Iterator[tuple[str, Any]]:
    """The values that decide whether an axis is good, with their names."""
    if axis.values is not None:
        yield from ((f"values[{number}]", value) for number, value in enumerate(axis.values))
    else:
        yield from (("low", axis.low), ("high", axis.high))


def _of_axis(sweep: Sweep, reason: str) -> str:
    """The reason, after the name of the axis whose key it begins with."""
    for number, axis in enumerate(sweep.axes):
        if any(reason.startswith(key) for key in axis.names()):
            return f"sweep.axes[{number}]: {reason}"
    return reason

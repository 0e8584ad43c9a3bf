"""SPACE.toml: a whole configuration, the axes along which it varies, and the points on them, each checked."""

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from foundation.errors import InputError
from geometry.parameters import Table
from softdot.config.default_design import with_default_design
from softdot.config.errors import sentence, value_text
from softdot.config.idle import has_value, take_out_idle
from softdot.config.loading import config_from
from softdot.config.schema import Config
from softdot.config.settings import naming_the_flag, with_settings
from softdot.config.toml import key_path, read_toml, with_value
from softdot.sweeps.sampling import Axis, Sweep, sample_points


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
    """Every point of a sweep, checked. tables : SPACE.toml as read. text : as written, None without a file."""

    tables: Mapping[str, Any]
    sweep: Sweep
    points: tuple[Point, ...]
    text: str | None = None


def load_space(path: Path | str, settings: Sequence[str] = ()) -> Space:
    """Read and check SPACE.toml. InputError as in space_from, and for a file that cannot be read.

    settings : 'dotted.key=value' after the file.
    """
    with naming_the_flag(settings):
        space = space_from(with_settings(read_toml(Path(path)), settings))
    added = "".join(f"# with --set {' '.join(setting.split())}\n" for setting in settings)
    return Space(space.tables, space.sweep, space.points, added + Path(path).read_text("utf-8-sig"))


def space_from(tables: Mapping[str, Any]) -> Space:
    """The points of a space. InputError with one sentence for a bad table [sweep] and for a bad axis.

    An axis is bad when no point can be built with one of its values (of low and high, one of them), or when its key
    acts beside no value of another axis. A point whose combination alone cannot be built stays, with its reason. A key,
    of the file or of an axis, is left out at a point where it does not act beside the values of the axes.
    """
    sweep = sweep_of(tables)
    base = {name: table for name, table in tables.items() if name != "sweep"}
    rows = sample_points(sweep)
    points = tuple(point_at(base, sweep, row) for row in rows)
    _refuse_bad_axes(base, sweep, rows, points)
    return Space(tables, sweep, points)


def sweep_of(tables: Mapping[str, Any]) -> Sweep:
    """The table [sweep]. InputError."""
    if "sweep" not in tables:
        raise InputError("sweep is missing: SPACE.toml needs a table [sweep] with at least one [[sweep.axes]]")
    own = {"sweep": tables["sweep"]}
    try:
        return _File.model_validate_json(json.dumps(own, default=str), strict=True).sweep
    except ValidationError as error:
        raise InputError(sentence(error, own, _File)) from None


def point_at(base: Mapping[str, Any], sweep: Sweep, row: tuple[Any, ...]) -> Point:
    """The point with these values of the axes. InputError for a key that leads nowhere."""
    values = {key: row[number] for number, axis in enumerate(sweep.axes) for key in axis.names()}
    tables = _tables_at_point(base, sweep, row)
    try:
        return Point(values, config_from(with_default_design(tables)))
    except InputError as error:
        return Point(values, None, str(error))


def _tables_at_point(base: Mapping[str, Any], sweep: Sweep, row: tuple[Any, ...]) -> dict[str, Any]:
    """The tables with the values of the axes, without keys that do not act beside them. InputError as in _point."""
    tables = dict(base)
    for number, axis in enumerate(sweep.axes):
        for key in axis.names():
            try:
                tables = with_value(tables, key, row[number])
            except InputError as error:
                raise InputError(f"sweep.axes[{number}]: {error}") from None
    for axis in sweep.axes:
        for key in axis.names():
            take_out_idle(tables, key_path(key))
    return tables


def _refuse_bad_axes(
    base: Mapping[str, Any], sweep: Sweep, rows: list[tuple[Any, ...]], points: tuple[Point, ...]
) -> None:
    """InputError for an axis with a value that no point can have, or with a key that never acts."""
    good = [row for row, point in zip(rows, points, strict=True) if point.config is not None]
    if not good:
        raise InputError(_with_axis_name(sweep, points[0].reason or ""))
    beside = [
        (*good[0][:n], value, *good[0][n + 1 :]) for n, axis in enumerate(sweep.axes) for _, value in _extremes(axis)
    ]
    for number, axis in enumerate(sweep.axes):
        acting = (
            has_value(_tables_at_point(base, sweep, row), key_path(key))
            for row in (*good, *beside)
            for key in axis.names()
        )
        if not any(acting):  # by chance few random points may have none of the values beside which it acts
            raise InputError(f"sweep.axes[{number}]: {axis.names()[0]} acts beside no value of another axis")
        for name, value in _extremes(axis):
            if any(row[number] == value for row in good):
                continue
            tried = [point_at(base, sweep, (*row[:number], value, *row[number + 1 :])) for row in good]
            if all(point.config is None for point in tried):
                raise InputError(f"sweep.axes[{number}].{name} = {value_text(value)}: {tried[0].reason}")


def _extremes(axis: Axis) -> Iterator[tuple[str, Any]]:
    """Name and value of each of the values that decide whether an axis is good."""
    if axis.values is not None:
        yield from ((f"values[{number}]", value) for number, value in enumerate(axis.values))
    else:
        yield from (("low", axis.low), ("high", axis.high))


def _with_axis_name(sweep: Sweep, reason: str) -> str:
    """The reason, after the name of the axis whose key it begins with."""
    for number, axis in enumerate(sweep.axes):
        if any(reason.startswith(key) for key in axis.names()):
            return f"sweep.axes[{number}]: {reason}"
    return reason

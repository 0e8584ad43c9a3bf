"""What a study of reading asks: one condition after the other away from the usual ones, or all together."""

import itertools
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from geometry.base import InputError
from softdot.arrays.kernel import ArrayKernel
from softdot.reading.cells import cells_of
from softdot.reading.conditions import BOUNDS, ReadingConditions, standard_of
from softdot.reading.decoders import named_decoders

USUAL_TEXT = (
    "soft dots, read by touch: the quick brown fox jumps over the lazy dog, packs five dozen liquor jugs, and leaves "
    "at 7.45 for Vienna; who knows why? Six big quartz vaults, one jolly wizard."
)
MOST_READINGS = 20_000
KEYS = ("text", "table", "decoder", "repeats", "accuracy", "combine", "base", "axes")


@dataclass(frozen=True)
class ReadingStudy:
    """axes : condition -> values; combine : every combination of them, else one after the other beside the base.

    decoder : one or several, as --decoders; the first decides. accuracy : share of the characters that must be read;
    repeats : seeds for each condition, whose characters are counted together.
    """

    base: ReadingConditions
    axes: Mapping[str, tuple[float, ...]]
    text: str = USUAL_TEXT
    table: str | None = None
    decoder: str = "model"
    repeats: int = 2
    accuracy: float = 0.98
    combine: bool = False


def usual_axes(kernel: ArrayKernel, base: ReadingConditions) -> dict[str, tuple[float, ...]]:
    """What a study varies where no file says so. Heights are below the nominal one of the standard."""
    nominal = standard_of(kernel, base.standard).nominal_mm("height_mm", "--standard")
    below = tuple(round(nominal - share * float(kernel.depth_mm[-1]), 4) for share in (0.0, 0.15, 0.3, 0.45, 0.6))
    return {
        "speed_mm_per_s": (5.0, 10.0, 20.0, 50.0, 100.0),
        "noise_mV": (0.5, 1.0, 2.0, 5.0, 10.0),
        "offset_mm": (0.0, 0.25, 0.5, 0.75, 1.0),
        "yaw_deg": (0.0, 2.5, 5.0, 10.0, 15.0),
        "height_mm": below,
        "worn": (0.0, 0.1, 0.25, 0.5, 1.0),
    }


def load_study(path: Path, kernel: ArrayKernel, base: ReadingConditions) -> ReadingStudy:
    """Of a TOML file. InputError for a key, an axis or a value that is not allowed."""
    where = f"conditions '{path}'"
    try:
        tables = tomllib.loads(path.read_text("utf-8"))
    except (OSError, ValueError) as error:
        raise InputError(f"{where}: cannot be read ({error})") from None
    for key in tables:
        if key not in KEYS:
            raise InputError(f"{where}: '{key}' is not a key; known are {', '.join(KEYS)}")
    try:
        stated: dict[str, Any] = tables.get("base", {})
        changed = replace(base, **stated)
        axes = {name: tuple(float(one) for one in values) for name, values in tables.get("axes", {}).items()}
        study = ReadingStudy(
            changed, axes or usual_axes(kernel, changed),
            **{key: tables[key] for key in KEYS if key in tables and key not in ("base", "axes")},
        )  # fmt: skip
    except TypeError as error:
        raise InputError(f"{where}: {error}") from None
    _check(study, where)
    return study


def _check(study: ReadingStudy, where: str) -> None:
    for name, values in study.axes.items():
        if name not in BOUNDS:
            raise InputError(f"{where}: axes.{name} is no condition with a number; known are {', '.join(BOUNDS)}")
        if not values:
            raise InputError(f"{where}: axes.{name} = []: needs at least one value")
        for value in values:
            with_value(study.base, name, value)
    if not isinstance(study.repeats, int) or not 1 <= study.repeats <= 100:
        raise InputError(f"{where}: repeats = {study.repeats}: must be a whole number from 1 to 100")
    if not 0.0 < study.accuracy <= 1.0:
        raise InputError(f"{where}: accuracy = {study.accuracy}: must be above 0 and at most 1")
    named_decoders(study.decoder)
    if (count := len(points(study)) * study.repeats) > MOST_READINGS:
        raise InputError(f"{where}: has {count} readings, at most {MOST_READINGS} are allowed")
    cells_of(study.text, study.table)


def points(study: ReadingStudy) -> list[ReadingConditions]:
    """All conditions that the axes ask for, the usual ones first."""
    if study.combine:
        grid = itertools.product(*study.axes.values())
        changes: list[dict[str, Any]] = [dict(zip(study.axes, values, strict=True)) for values in grid]
        found = [replace(study.base, **change) for change in changes]
    else:
        found = [with_value(study.base, name, one) for name, values in study.axes.items() for one in values]
    return list(dict.fromkeys([study.base, *found]))


def with_value(conditions: ReadingConditions, name: str, value: float) -> ReadingConditions:
    """With another value of one condition. InputError for one out of bounds."""
    changed: dict[str, Any] = {name: value}
    return replace(conditions, **changed)


def repeated(study: ReadingStudy, conditions: ReadingConditions) -> list[ReadingConditions]:
    """The conditions with the seed of each repeat."""
    return [replace(conditions, seed=conditions.seed + number) for number in range(study.repeats)]

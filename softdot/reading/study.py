"""The plan of a study of reading: one condition after the other away from the base, or all combinations."""

import itertools
import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, get_type_hints

from pydantic import Field, ValidationError, create_model

from foundation.errors import InputError
from foundation.files import read_text
from geometry.parameters import Finite, Table
from softdot.arrays.kernel import ArrayKernel
from softdot.config.errors import sentence
from softdot.config.toml import parse_toml
from softdot.reading.cells import cells_of
from softdot.reading.conditions import BOUNDS, CHANNELS, ReadingConditions, standard_of
from softdot.reading.decoders import named_decoders

DEFAULT_TEXT = (
    "soft dots, read by touch: the quick brown fox jumps over the lazy dog, packs five dozen liquor jugs, and leaves "
    "at 7.45 for Vienna; who knows why? Six big quartz vaults, one jolly wizard."
)
"""The text that a study reads where none is stated."""
MOST_READINGS = 20_000
"""Largest number of readings of a study."""
MOST_CELLS = 2_000_000
"""Most cells of all readings together: a core reads about a hundred cells a second, so that these take hours."""
BaseConditions = create_model(
    "BaseConditions",
    __base__=Table,
    **{name: (kind | None, None) for name, kind in get_type_hints(ReadingConditions).items()},
)  # type: ignore[call-overload]
"""The table [base]: conditions that differ from those of the command line."""


class StudyTables(Table):
    """The content of a file of conditions."""

    text: str = Field(DEFAULT_TEXT, description="what is read")
    table: str | None = Field(None, description="a table of liblouis; none: plain English")
    decoder: str = Field("model", description="one or several, as --decoders; the first decides")
    repeats: int = Field(2, ge=1, le=100, description="seeds for each condition, counted together")
    accuracy: float = Field(0.98, gt=0.0, le=1.0, description="share of the characters that must be read")
    combine: bool = Field(False, description="every combination of the axes, else one after the other")
    base: BaseConditions = Field(BaseConditions(), description="conditions away from those of the command line")
    axes: dict[str, tuple[Finite, ...]] = Field({}, description="condition -> values")


@dataclass(frozen=True)
class ReadingStudy:
    """The plan of a study of reading.

    axes : condition -> values. combine : every combination of them, else one after the other beside the base. decoder :
    one or several, as --decoders; the first decides. accuracy : share of the characters that must be read. repeats :
    seeds for each condition, whose characters are counted together.
    """

    base: ReadingConditions
    axes: Mapping[str, tuple[float, ...]]
    text: str = DEFAULT_TEXT
    table: str | None = None
    decoder: str = "model"
    repeats: int = 2
    accuracy: float = 0.98
    combine: bool = False


def default_axes(kernel: ArrayKernel, base: ReadingConditions) -> dict[str, tuple[float, ...]]:
    """The axes of a study where no file states any. Heights are below the nominal one of the standard."""
    nominal = standard_of(kernel, base.standard).nominal_mm("height_mm", "--standard")
    below = tuple(round(nominal - share * float(kernel.depth_mm[-1]), 4) for share in (0.0, 0.15, 0.3, 0.45, 0.6))
    return {
        "speed_mm_per_s": (5.0, 10.0, 20.0, 50.0, 100.0),
        "noise_mV": (0.5, 1.0, 2.0, 5.0, 10.0),
        "offset_mm": (0.0, 0.25, 0.5, 0.75, 1.0),
        "yaw_deg": (0.0, 2.5, 5.0, 10.0, 15.0),
        "height_mm": below,
        "worn": (0.0, 0.1, 0.25, 0.5, 1.0),
        "speed_cv": (0.0, 0.1, 0.2, 0.3),
        "hum_mV": (0.0, 5.0, 10.0, 20.0),
    }


def load_study(path: Path, kernel: ArrayKernel, base: ReadingConditions) -> ReadingStudy:
    """Read the plan of a study from a TOML file. InputError for a key, an axis or a value that is not allowed."""
    where = f"conditions '{path}'"
    try:
        tables = parse_toml(read_text(path, where), str(path))
        asked = StudyTables.model_validate_json(json.dumps(tables, default=str), strict=True)
    except ValidationError as error:
        raise InputError(f"{where}: {sentence(error, tables, StudyTables)}") from None
    changed = replace(base, **asked.base.model_dump(exclude_unset=True))
    axes = dict(asked.axes) or default_axes(kernel, changed)
    given = {name: getattr(asked, name) for name in ("text", "table", "decoder", "repeats", "accuracy", "combine")}
    study = ReadingStudy(changed, axes, **given)
    _refuse_bad_study(study, where)
    return study


def _refuse_bad_study(study: ReadingStudy, where: str) -> None:
    """InputError for an axis, a value, a decoder or a number of readings that is not allowed."""
    for name, values in study.axes.items():
        if name not in BOUNDS:
            raise InputError(f"{where}: axes.{name} is no condition with a number; known are {', '.join(BOUNDS)}")
        if name in CHANNELS and not study.combine:
            raise InputError(f"{where}: axes.{name}: the number of a channel has no limit; set combine = true")
        if not values:
            raise InputError(f"{where}: axes.{name} = []: needs at least one value")
        for value in values:
            with_condition(study.base, name, value)
    named_decoders(study.decoder)
    if (count := len(study_points(study)) * study.repeats) > MOST_READINGS:
        raise InputError(f"{where}: has {count} readings, at most {MOST_READINGS} are allowed")
    cells = len(cells_of(study.text, study.table))
    if cells * count > MOST_CELLS:
        raise InputError(
            f"{where}: {count} readings of {cells} cells are {cells * count} cells, at most {MOST_CELLS} are "
            "read; shorten the text or leave out values"
        )


def study_points(study: ReadingStudy) -> list[ReadingConditions]:
    """All conditions that the axes ask for, those of the base first."""
    if study.combine:
        grid = itertools.product(*study.axes.values())
        changes: list[dict[str, Any]] = [dict(zip(study.axes, values, strict=True)) for values in grid]
        found = [replace(study.base, **change) for change in changes]
    else:
        found = [with_condition(study.base, name, one) for name, values in study.axes.items() for one in values]
    return list(dict.fromkeys([study.base, *found]))


def with_condition(conditions: ReadingConditions, name: str, value: float) -> ReadingConditions:
    """The conditions with another value of one of them. InputError for a value out of bounds."""
    changed: dict[str, Any] = {name: value}
    return replace(conditions, **changed)


def repeats_of(study: ReadingStudy, conditions: ReadingConditions) -> list[ReadingConditions]:
    """The conditions of every repeat, which differ by their seed."""
    return [replace(conditions, seed=conditions.seed + number) for number in range(study.repeats)]

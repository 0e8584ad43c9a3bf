"""How far the conditions of reading may go: one condition after the other away from the usual ones, or all together.

Each reading is a task of its own, kept as a file by the hash of all it depends on: a study that was stopped goes on.
The limit of a condition is where fewer characters than promised are read; it is bracketed by the values of the axis,
beyond them by doubling the distance, and then halved.
"""

import itertools
import json
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field, replace
from functools import lru_cache
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np

from geometry.base import InputError
from geometry.cache import read_checked, source_hash, write_checked
from softdot.arrays.kernel import JSON, NPZ, ArrayKernel
from softdot.console import Untold
from softdot.reading.cells import cells_of, text_of
from softdot.reading.conditions import BOUNDS, ReadingConditions, standard_of
from softdot.reading.decoders import named_decoders
from softdot.reading.decoders.track import NoDotError
from softdot.reading.job import content, read_line
from softdot.reading.kernels import opened_kernel
from solve.model import Readout

USUAL_TEXT = (
    "soft dots, read by touch: the quick brown fox jumps over the lazy dog, packs five dozen liquor jugs, and leaves "
    "at 7.45 for Vienna; who knows why? Six big quartz vaults, one jolly wizard."
)
HALVINGS, DOUBLINGS = 4, 3
RATES = ("cell", "character", "word")
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


@dataclass(frozen=True)
class StudyTask:
    """One reading of a study."""

    folder: str
    readout: str
    conditions: ReadingConditions
    text: str
    table: str | None
    decoder: str

    def key(self, kernel_hash: str) -> str:
        """Of all it depends on, the program among it."""
        told = {**asdict(self), "folder": kernel_hash, "program": source_hash("softdot.reading.study")}
        return sha256(json.dumps(told, sort_keys=True).encode()).hexdigest()


@dataclass
class Readings:
    """What is known: for each condition of a study the characters that were right, and of how many."""

    records: dict[ReadingConditions, dict[str, Any]] = field(default_factory=dict)

    def share(self, study: ReadingStudy, conditions: ReadingConditions) -> float | None:
        """Of the characters, over all repeats; None where a reading was refused."""
        found = [self.records[one] for one in repeated(study, conditions)]
        if any(one["status"] != "read" for one in found):
            return None
        return float(sum(one["right"] for one in found) / sum(one["of"] for one in found))


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


def kernel_hash(folder: Path) -> str:
    """Of both files of a kernel."""
    return sha256(b"".join((folder / name).read_bytes() for name in (NPZ, JSON))).hexdigest()


@lru_cache(maxsize=1)
def _kernel(folder: str) -> ArrayKernel:
    return opened_kernel(Path(folder))


def read_task(task: StudyTask) -> dict[str, Any]:
    """The record of one reading: status "read" with the numbers of the first decoder, and of each by its name, or
    "refused" with the reason. Raises no InputError.
    """
    try:
        kernel, cells = _kernel(task.folder), cells_of(task.text, task.table)
        readout, names = Readout.model_validate_json(task.readout), named_decoders(task.decoder)
        reading = read_line(kernel, readout, task.conditions, names, Untold(), cells)
    except NoDotError:
        nothing = {"right": 0, "of": len(text_of(cells, task.table)), "accuracy": dict.fromkeys(RATES, 0.0)}
        return {"status": "read", "reason": None, **nothing, "text_read": "", "decoders": dict.fromkeys(names, nothing)}
    except InputError as error:
        return {"status": "refused", "reason": str(error)}
    told = content(reading, task.text, task.table)
    decoders = {name: _numbers(own) for name, own in told["decoders"].items()}
    first = decoders[told["decoder"]]
    return {"status": "read", "reason": None, **first, "text_read": told["text_read"], "decoders": decoders}


def _numbers(told: Mapping[str, Any]) -> dict[str, Any]:
    """Of one decoder: characters that were right, of how many, and all rates."""
    counts = {name: told["character_accuracy"][name] for name in ("right", "of")}
    return {**counts, "accuracy": {name: told[f"{name}_accuracy"]["value"] for name in RATES}}


def kept(folder: Path, key: str) -> dict[str, Any] | None:
    """The record of an earlier reading."""
    return read_checked(folder / f"{key}.json", "it is read again")


def keep(folder: Path, key: str, task: StudyTask, record: dict[str, Any]) -> None:
    """Write a record, whole or not at all."""
    write_checked(folder / f"{key}.json", {**record, "conditions": asdict(task.conditions)})


def limits_of(study: ReadingStudy, readings: Readings) -> Iterator[tuple[str, "ConditionLimit"]]:
    """How far each condition may go, as far as is known."""
    for name, values in study.axes.items():
        start = getattr(study.base, name)
        usual = values[0] if start is None else start
        rising = np.mean(values) >= usual
        ahead = sorted({*values, usual}, reverse=not rising)
        ahead = ahead[ahead.index(usual) :]
        yield name, _limit(study, readings, name, [float(one) for one in ahead])


@dataclass(frozen=True)
class ConditionLimit:
    """good : the farthest value that is still read, None where the usual one is not; bad : the nearest that is not.

    following : the value to be read next, None where the limit is as narrow as was asked.
    """

    good: float | None
    bad: float | None
    following: float | None


def _limit(study: ReadingStudy, readings: Readings, name: str, ahead: list[float]) -> ConditionLimit:
    """By all readings of this condition at and behind its usual value."""
    start, sign = ahead[0], 1.0 if ahead[-1] >= ahead[0] else -1.0
    known: dict[float, bool] = {}
    for conditions in {replace(one, seed=study.base.seed) for one in readings.records}:
        value = getattr(conditions, name)
        value = start if value is None else value
        alone = replace(conditions, **{name: getattr(study.base, name)}) == study.base
        if alone and sign * (value - start) >= 0.0:
            share = readings.share(study, conditions)
            known[value] = share is not None and share >= study.accuracy
    order = sorted(known, key=lambda value: sign * value)
    bad = next((value for value in order if not known[value]), None)
    good = [value for value in order if known[value] and (bad is None or sign * (bad - value) > 0.0)]
    extra = len(set(known) - set(ahead))
    if not good:
        return ConditionLimit(None, bad, None)
    if bad is None:
        further = good[-1] + (good[-1] - start or sign)
        further = float(np.clip(further, *BOUNDS[name]))
        done = extra >= DOUBLINGS or further == good[-1]
        return ConditionLimit(good[-1], None, None if done else further)
    first = next((value for value in order if value not in ahead), None)
    halved = extra >= HALVINGS + (DOUBLINGS if first is not None and sign * (first - ahead[-1]) > 0.0 else 0)
    return ConditionLimit(good[-1], bad, None if halved else 0.5 * (good[-1] + bad))

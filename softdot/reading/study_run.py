"""A study of reading on all cores: its folder, which keeps the readings, its table and its picture."""

import csv
import logging
from dataclasses import replace
from pathlib import Path
from typing import Any

from foundation.errors import InputError
from foundation.executor import Executor
from foundation.scratch_folders import unlock_folder
from softdot.arrays.kernel import ArrayKernel
from softdot.config.schema import Config
from softdot.json_files import plain, write_json
from softdot.output import Product, check_output
from softdot.progress import Logged, Progress
from softdot.reading.conditions import ReadingConditions
from softdot.reading.decoders import named_decoders
from softdot.reading.kernels import open_kernel, readout_of
from softdot.reading.study import ReadingStudy, repeats_of, study_points, with_condition
from softdot.reading.study_limits import ConditionLimit, Readings, limits_of
from softdot.reading.study_task import StudyTask, kernel_hash, read_task, store_record, stored_record
from softdot.version import installed_version

FOLDER, TABLE, PICTURE = "conditions", "reading_study.csv", "reading_study.png"
STUDY = Product(
    "softdot-reading-study/1", "reading_study.json", frozenset({"reading_study.json", FOLDER, TABLE, PICTURE})
)
LOG = logging.getLogger(__name__)


def run_reading_study(
    study: ReadingStudy,
    kernel_folder: Path,
    out: Path,
    config: Config | None = None,
    workers: int | None = None,
    progress: Progress | None = None,
    scheduler: str | None = None,
) -> dict[str, Any]:
    """Read under all conditions of a study into the folder out; the content of reading_study.json. InputError.

    The work is done by one process per core, by as many as workers, or by the Dask cluster of a scheduler, whose
    workers find the kernel under the same path. Readings of an earlier study in out are not made again.
    """
    from foundation.scratch_folders import lock_folder
    from softdot.executors import executor_for

    progress = progress or Logged()
    kernel = open_kernel(kernel_folder, config)
    study.base.with_implied_values(kernel)
    place = check_output(out, STUDY)
    (place / FOLDER).mkdir(parents=True, exist_ok=True)
    held = lock_folder(place)
    if held is None:
        raise InputError(f"output '{out}': another study is writing it; wait for it or name another folder")
    try:
        if not (place / STUDY.summary).exists():
            write_json(place / STUDY.summary, {"format": STUDY.format, "complete": False})
        work = _Work(study, kernel_folder, place / FOLDER, readout_of(kernel, config).model_dump_json(), progress)
        LOG.info(
            "%d conditions, each read %d times; then what their limits ask for", len(study_points(study)), study.repeats
        )
        with executor_for(scheduler, workers) as executor:
            progress.stage("read")
            work.read_all(executor, study_points(study))
            while following := work.next_conditions():
                work.read_all(executor, following)
        summary: dict[str, Any] = plain(_summary(study, work.readings, kernel))
        _write_csv(summary["readings"], place / TABLE)
        _draw(summary, place / PICTURE)
        write_json(place / STUDY.summary, summary)
    finally:
        unlock_folder(held)
    return summary


class _Work:
    """The readings of a study: stored ones, and missing ones by an executor."""

    def __init__(self, study: ReadingStudy, kernel: Path, folder: Path, readout: str, progress: Progress) -> None:
        self.readings = Readings()
        self._study, self._kernel, self._folder, self._readout = study, kernel, folder, readout
        self._hash, self._progress = kernel_hash(kernel), progress

    def next_conditions(self) -> list[ReadingConditions]:
        """The conditions that the limits ask for next; none where every combination is read."""
        if self._study.combine:
            return []
        limits = dict(limits_of(self._study, self.readings))
        return [
            with_condition(self._study.base, name, limit.following)
            for name, limit in limits.items()
            if limit.following is not None
        ]

    def read_all(self, executor: Executor, wanted: list[ReadingConditions]) -> None:
        """Read under these conditions, with all repeats, what is not stored yet."""
        from softdot.sweeps.points import records_as_completed

        tasks = {
            task.hash_key(self._hash): task for one in wanted for task in map(self._task, repeats_of(self._study, one))
        }
        count = len(self.readings.records) + len(tasks)
        missing = {}
        for key, task in tasks.items():
            if (found := stored_record(self._folder, key)) is None:
                missing[key] = task
            else:
                self.readings.records[task.conditions] = found
        self._progress.step(len(self.readings.records), count, "")
        for key, record in records_as_completed(executor, read_task, {key: (task,) for key, task in missing.items()}):
            if record["status"] in ("read", "refused"):
                store_record(self._folder, key, missing[key], record)
            self.readings.records[missing[key].conditions] = record
            self._progress.step(len(self.readings.records), count, record["reason"] or "")

    def _task(self, conditions: ReadingConditions) -> StudyTask:
        study = self._study
        return StudyTask(str(self._kernel.resolve()), self._readout, conditions, study.text, study.table, study.decoder)


def _summary(study: ReadingStudy, readings: Readings, kernel: ArrayKernel) -> dict[str, Any]:
    rows = []
    for conditions in dict.fromkeys(replace(one, seed=study.base.seed) for one in readings.records):
        found = [readings.records[one] for one in repeats_of(study, conditions)]
        row: dict[str, Any] = {
            "conditions": conditions.as_dict(),
            "status": "read",
            "reason": None,
            "character_accuracy": None,
            "decoders": {},
        }
        failed = next((one for one in found if one["status"] != "read"), None)
        if failed is not None:
            row |= {"status": failed["status"], "reason": failed["reason"]}
        else:
            row["character_accuracy"] = _pooled_accuracy(found)
            row["decoders"] = {
                name: _pooled_accuracy([one["decoders"][name] for one in found])
                for name in named_decoders(study.decoder)
            }
            row["word_accuracy"] = sum(one["accuracy"]["word"] for one in found) / len(found)
        rows.append(row)
    limits = {} if study.combine else {name: _limit_row(study, readings, name, limit)
                                       for name, limit in limits_of(study, readings)}  # fmt: skip
    return {
        "format": STUDY.format,
        "complete": True,
        "softdot_version": installed_version(),
        "config_hash": kernel.about["config_hash"],
        "text": study.text,
        "table": study.table,
        "decoder": study.decoder,
        "repeats": study.repeats,
        "accuracy": study.accuracy,
        "combine": study.combine,
        "base": study.base.with_implied_values(kernel).as_dict(),
        "axes": {name: list(values) for name, values in study.axes.items()},
        "limits": limits,
        "readings": rows,
        "warnings": [f"{one['status']}: {one['reason']}" for one in rows if one["status"] != "read"],
    }


def _limit_row(study: ReadingStudy, readings: Readings, name: str, limit: ConditionLimit) -> dict[str, Any]:
    """The limit of a condition as reading_study.json holds it."""
    refused = limit.bad is not None and readings.share(study, with_condition(study.base, name, limit.bad)) is None
    return {"read_up_to": limit.good, "fails_at": limit.bad, "refused": refused}


def _pooled_accuracy(found: list[dict[str, Any]]) -> dict[str, Any]:
    """The share of right characters in all repeats together, with Wilson's 95 % interval."""
    from diagnose.statistics.proportions import wilson_interval

    right, of = sum(one["right"] for one in found), sum(one["of"] for one in found)
    low, high = wilson_interval(right, of)
    return {"value": right / of, "low": low, "high": high, "right": right, "of": of}


def _write_csv(rows: list[dict[str, Any]], path: Path) -> None:
    """Write a row for each condition, with the rates of the first decoder and those of each by its name."""
    names, told = list(rows[0]["conditions"]), ("value", "low", "high", "of")
    decoders = list(dict.fromkeys(name for row in rows for name in row["decoders"]))
    with path.open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow([*names, "status", "character_accuracy", "low", "high", "characters", *decoders])
        for row in rows:
            share = row["character_accuracy"] or {}
            each = [row["decoders"][name]["value"] if name in row["decoders"] else None for name in decoders]
            table.writerow([*row["conditions"].values(), row["status"], *map(share.get, told), *each])


def _draw(summary: dict[str, Any], path: Path) -> None:
    from export.array.conditions import draw_conditions

    base = summary["readings"][0]["conditions"]
    curves = {}
    for name in summary["axes"]:
        alone = [
            row
            for row in summary["readings"]
            if row["character_accuracy"] and all(row["conditions"][key] == base[key] for key in base if key != name)
        ]
        curves[name] = sorted(
            (
                summary["base"][name] if row["conditions"][name] is None else row["conditions"][name],
                *(row["character_accuracy"][key] for key in ("value", "low", "high")),
            )
            for row in alone
        )
    limits = {name: limit["read_up_to"] for name, limit in summary["limits"].items()}
    draw_conditions(curves, summary["accuracy"], limits, path)

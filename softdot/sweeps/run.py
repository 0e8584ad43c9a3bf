"""The whole sweep: from a space of designs to the folder with its table."""

import time
from collections import Counter
from collections.abc import Mapping
from contextlib import AbstractContextManager, ExitStack
from pathlib import Path
from typing import Any

from foundation.cache import check_cache_folder
from foundation.errors import InputError
from foundation.executor import Executor
from foundation.scratch_folders import unlock_folder
from softdot.config.hashes import config_hash
from softdot.config.schema import Config
from softdot.executors import executor_for
from softdot.families.family import Family
from softdot.hardware import hardware
from softdot.log import LOG_FILE, log_file
from softdot.progress import Logged, Progress
from softdot.sweeps import folder as sweep_folder
from softdot.sweeps.points import REFUSED, SOLVED, STATUSES, Record, failed_record, solve_all
from softdot.sweeps.sampling import sampling_warnings
from softdot.sweeps.space import Point, Space
from softdot.sweeps.table import check_tables, table_row


def run_sweep(
    space: Space,
    out: Path | str,
    scheduler: str | None = None,
    progress: Progress | None = None,
    family: Family | None = None,
) -> dict[str, Any]:
    """Solve every point of a space into the folder out and return the summary (sweep.json).

    On one process per core, or on the Dask cluster of a scheduler (tcp://HOST:PORT). Points that an earlier sweep
    left in out are not solved again. InputError before any work for a folder that cannot be written, for a
    scheduler that does not answer, and without pyarrow. After Ctrl-C, or when killed, the finished points stay.
    family : answers every point instead of presses.
    """
    check_tables()
    check_cache_folder()
    place = sweep_folder.check_folder(Path(out))
    configs = {config_hash(point.config): point.config for point in space.points if point.config is not None}
    records = {} if family is not None else _stored_records(place, configs)
    missing = {name: config for name, config in configs.items() if name not in records}
    where = executor_for(scheduler, space.sweep.workers)
    with ExitStack() as stack:
        measured = _work_summary(0, len(records))
        if family is not None:
            measured = _answer(configs, records, family, place, stack)
        elif missing:
            measured = _solve(missing, records, where, place, progress or Logged(), stack)
        ends = [_record_of_point(point, records) for point in space.points]
        summary = {**_design_summary(space, ends, family), "scheduler": scheduler, **measured, "hardware": hardware()}
        rows = [table_row(number, space.points[number].values, record) for number, record in enumerate(ends)]
        sweep_folder.finish(place, rows, list(space.points[0].values), space.text, summary)
    return summary


def _stored_records(place: Path, configs: Mapping[str, Config]) -> dict[str, Record]:
    """The records of points that an earlier sweep left in a folder, by the hash of their configuration."""
    found = {name: sweep_folder.stored_record(place, config) for name, config in configs.items()}
    return {name: record for name, record in found.items() if record is not None}


def _answer(
    configs: Mapping[str, Config], records: dict[str, Record], family: Family, place: Path, stack: ExitStack
) -> dict[str, Any]:
    """Answer the points by a family, into records alone; a summary of the work. stack : as of _solve."""
    begun = time.perf_counter()
    sweep_folder.make_folder(place)
    stack.callback(unlock_folder, sweep_folder.hold_folder(place))
    sweep_folder.remove_half_written(place)
    for name, config in configs.items():
        records[name] = {**_answered_record(config, family), "config_hash": name}
    return _work_summary(len(configs), 0, 1, 0.0, time.perf_counter() - begun)


def _answered_record(config: Config, family: Family) -> Record:
    """What a family says of a point, with its intervals; refused outside of it."""
    begun = time.perf_counter()
    try:
        found = family.press_config(config)
    except InputError as error:
        return failed_record(REFUSED, str(error))
    interval = {name: {"low": low, "high": high} for name, (low, high) in found.interval.items()}
    answered = {name: values.tolist() for name, values in found.courses.items()}
    seconds = time.perf_counter() - begun
    return {"status": SOLVED, "reason": None, "seconds": seconds, **answered, "interval": interval}


def _solve(
    missing: Mapping[str, Config],
    records: dict[str, Record],
    where: AbstractContextManager[Executor],
    place: Path,
    progress: Progress,
    stack: ExitStack,
) -> dict[str, Any]:
    """Solve the missing points into records and folder, which is made once a worker is ready; a summary of the work.

    stack : releases the folder at its end, so that no other sweep writes it meanwhile.
    """
    reused, count = len(records), len(records) + len(missing)
    begun = time.perf_counter()
    with where as executor:
        sweep_folder.make_folder(place)
        stack.callback(unlock_folder, sweep_folder.hold_folder(place))
        sweep_folder.remove_half_written(place)
        stack.callback(sweep_folder.remove_half_written, place)
        workers = executor.places
        ready = time.perf_counter()
        with log_file(place / LOG_FILE):
            progress.stage("solve")
            progress.step(reused, count, "")
            for name, record in solve_all(executor, missing):
                records[name] = sweep_folder.store_record(place, missing[name], record)
                progress.step(len(records), count, record["reason"] or "")
        end = time.perf_counter()
    return _work_summary(len(missing), reused, workers, ready - begun, end - ready)


def _work_summary(
    solved: int, reused: int, workers: int = 0, start_s: float = 0.0, solve_s: float = 0.0
) -> dict[str, Any]:
    """The numbers of solved and reused points of this call, and its speed."""
    return {
        "solved_now": solved,
        "reused": reused,
        "workers": workers,
        "timing_s": {"start": start_s, "solve": solve_s},
        "points_per_minute": 60.0 * solved / solve_s if solved else None,
    }


def _record_of_point(point: Point, records: Mapping[str, Record]) -> Record:
    """The record of a point; of one without configuration, that of its refusal."""
    if point.config is None:
        return failed_record(REFUSED, point.reason or "")
    return records[config_hash(point.config)]


def _design_summary(space: Space, ends: list[Record], family: Family | None) -> dict[str, Any]:
    """Format, design, the number of points by how they ended, and how many presses a family answered them from."""
    from softdot.version import installed_version

    ended = Counter(record["status"] for record in ends)
    return {
        "format": sweep_folder.SWEEP.format,
        "complete": True,
        "softdot_version": installed_version(),
        "sampling": space.sweep.sampling,
        "seed": space.sweep.seed,
        "points": len(ends),
        "answered_from_presses": None if family is None else len(family.places),
        "ended": {status: ended[status] for status in STATUSES},
        "warnings": sampling_warnings(space.sweep),
        "space": space.tables,
    }

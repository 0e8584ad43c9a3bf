"""One point of a sweep in a worker, many of them by an executor, and the folder that keeps points as they are solved.

Points are added one whole file at a time, named by the hash of their configuration, so they fit any sweep. Table,
space and summary are replaced together when a sweep is complete: before that the folder has no table, or still that
of the sweep before, with its own summary.
"""

import os
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Future
from contextlib import nullcontext
from pathlib import Path
from typing import Any

from geometry.base import InputError
from geometry.cache import read_checked, write_checked
from geometry.executor import Executor, LostError, each_done
from geometry.files import hold, whole_file
from softdot.config import Config, config_hash
from softdot.console import Logged, Progress, plain, write_json
from softdot.executors import AwayError, executor_for
from softdot.outcome import keep_outcome, outcome, outcome_key, remembered
from softdot.output import Product, check_output

Record = dict[str, Any]

SOLVED, REFUSED, NOT_CONVERGED, CRASHED, LOST = "solved", "refused", "not-converged", "crashed", "lost"
STATUSES = (SOLVED, REFUSED, NOT_CONVERGED, CRASHED, LOST)
ACCIDENTS = (CRASHED, LOST)
"""Not the fault of the configuration: tried again when the sweep is started again."""
OF_THE_CALL = ("status", "reason", "seconds")
"""What a record has beside the outcome."""


def solve_point(config: Config) -> Record:
    """Outcome of a press with status, reason (None when solved) and seconds. Raises nothing."""
    start = time.perf_counter()
    return {**_attempt(config), "seconds": time.perf_counter() - start}


def _attempt(config: Config) -> Record:
    try:
        found = outcome(config)
    except InputError as error:
        return failed(REFUSED, str(error))
    except Exception as error:
        return failed(CRASHED, f"{type(error).__name__}: {error}")
    if found["solver"]["converged"]:
        return {"status": SOLVED, "reason": None, **found}
    return {**failed(NOT_CONVERGED, found["solver"]["failure"]), **found}


def failed(status: str, reason: str) -> Record:
    """A record without numbers; the reason on one line."""
    return {"status": status, "reason": " ".join(reason.split())}


Task = Callable[..., Record]


def solve_points(
    configs: Sequence[Config],
    progress: Progress | None = None,
    workers: int | None = None,
    executor: Executor | None = None,
) -> list[Record]:
    """The outcome of every configuration, in order, solved on one process per core, as many as workers, or an executor.

    Each is a new dict with status ("solved", "refused", "not-converged", "crashed" or "lost"), reason (one line,
    None when solved), seconds, and all of softdot.outcome.outcome(config), as far as there is any. No point stops the
    others and nothing is raised for one. Equal configurations are solved once; outcomes that are remembered need no
    worker. progress.step(done, count, reason or "") is called after each point.
    """
    progress = progress or Logged()
    keys = [outcome_key(config) for config in configs]
    distinct = dict(zip(keys, configs, strict=True))
    records = {key: solve_point(config) for key, config in distinct.items() if remembered(config) is not None}
    missing = {key: config for key, config in distinct.items() if key not in records}
    with executor_for(workers=workers) if executor is None else nullcontext(executor) as on:
        for key, record in solve_all(on, missing):
            records[key] = record
            progress.step(len(records), len(distinct), record["reason"] or "")
    return [dict(records[key]) for key in keys]


def solve_all(executor: Executor, configs: Mapping[str, Config]) -> Iterator[tuple[str, Record]]:
    """Name and record of every configuration, in the order in which they end. What is solved is remembered."""
    for name, record in all_ended(executor, solve_point, {name: (config,) for name, config in configs.items()}):
        keep_outcome(configs[name], {key: value for key, value in record.items() if key not in OF_THE_CALL})
        yield name, record


def all_ended(executor: Executor, task: Task, arguments: Mapping[str, tuple[Any, ...]]) -> Iterator[tuple[str, Record]]:
    """Name and record of the task with each arguments, in the order in which they end. AwayError."""
    for name, future in each_done(executor, task, arguments):
        yield name, _record(future)


def _record(future: "Future[Any]") -> Record:
    """What the worker returned, or why it could not."""
    try:
        return dict(future.result())
    except AwayError:
        raise
    except LostError as error:
        return failed(LOST, str(error))
    except Exception as error:
        return failed(CRASHED, f"{type(error).__name__}: {error}")


POINTS, TABLE, SPACE_COPY = "points", "sweep.parquet", "space.toml"
CSV_TABLE, PICTURE, PAGE = "sweep.csv", "sweep.png", "report.html"
_WHOLE = ("sweep.json", TABLE, SPACE_COPY, CSV_TABLE, PICTURE, PAGE)
SWEEP = Product("softdot-sweep/1", "sweep.json", frozenset({*_WHOLE, *(f".{name}.part" for name in _WHOLE), POINTS}))
POINT_FORMAT = "softdot-point/1"


def check_folder(out: Path) -> Path:
    """The real path of out. InputError unless it can be made, or is empty or the folder of an earlier sweep."""
    place = check_output(out, SWEEP)
    existing = next(path for path in (place, *place.parents) if path.exists())
    if not os.access(existing, os.W_OK):
        raise InputError(f"output '{out}': not writable (Permission denied)")
    return place


def begin(place: Path) -> None:
    """Make the folder; an earlier sweep in it stays."""
    place.mkdir(parents=True, exist_ok=True)
    if not (place / SWEEP.summary).exists():
        write_json(place / SWEEP.summary, {"format": SWEEP.format, "complete": False})
    (place / POINTS).mkdir(exist_ok=True)


def take(place: Path) -> int | None:
    """Hold the folder for this process, to be released at the end. InputError while another sweep writes it."""
    held = hold(place)
    if held is None:
        raise InputError(f"output '{place}': another sweep is writing it; wait for it or name another folder")
    return held


def sweep_up(place: Path) -> None:
    """Remove what a process that was stopped may have left half-written."""
    for folder in (place, place / POINTS):
        for path in folder.glob(".*.part"):
            path.unlink(missing_ok=True)


def kept(place: Path, config: Config) -> Record | None:
    """The record of a point from an earlier sweep; None without one, after an accident and of another program.

    A damaged one is None too, with a warning; it is deleted.
    """
    found = read_checked(_path(place, config), "the point is solved again")
    if found is None:
        return None
    return found if found["key"] == outcome_key(config) and found["status"] not in ACCIDENTS else None


def keep(place: Path, config: Config, record: Record) -> Record:
    """Write the summary of a point, whole or not at all, and return it."""
    from softdot.console import installed_version

    summary: dict[str, Any] = plain({
        "format": POINT_FORMAT,
        "softdot_version": installed_version(),
        "key": outcome_key(config),
        "config_hash": config_hash(config),
        **record,
        "config": config.model_dump(mode="json"),
    })  # fmt: skip
    write_checked(_path(place, config), summary)
    return summary


def _path(place: Path, config: Config) -> Path:
    return place / POINTS / f"{config_hash(config)}.json"


def finish(
    place: Path, rows: list[dict[str, Any]], axes: Sequence[str], text: str | None, summary: Mapping[str, Any]
) -> None:
    """Replace tables, picture, page, space and, last, the summary. axes : the columns that the sweep has varied."""
    from softdot.sweeps.table import draw, write_csv, write_report, write_table

    write_table(place / TABLE, rows)
    write_csv(place / CSV_TABLE, rows)
    draw(place / PICTURE, rows, axes)
    write_report(place / PAGE, rows, axes, summary, place / PICTURE)
    if text is None:
        (place / SPACE_COPY).unlink(missing_ok=True)
    else:
        with whole_file(place / SPACE_COPY) as beside:
            beside.write_text(text, "utf-8")
    write_json(place / SWEEP.summary, summary)

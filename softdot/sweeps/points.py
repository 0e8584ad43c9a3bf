"""One point of a sweep in a worker, and many of them by an executor."""

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Future
from contextlib import nullcontext
from typing import Any

from foundation.errors import InputError
from foundation.executor import Executor, LostError, completed_calls
from softdot.config.schema import Config
from softdot.dask_cluster import AwayError
from softdot.executors import executor_for
from softdot.outcome import keep_outcome, outcome, outcome_key, stored_outcome
from softdot.progress import Logged, Progress

Record = dict[str, Any]

SOLVED, REFUSED, NOT_CONVERGED, CRASHED, LOST = "solved", "refused", "not-converged", "crashed", "lost"
"""The ways in which a point may end."""
STATUSES = (SOLVED, REFUSED, NOT_CONVERGED, CRASHED, LOST)
ACCIDENTS = (CRASHED, LOST)
"""Failures that are not the configuration's: such a point is tried again when the sweep is started again."""
CALL_KEYS = ("status", "reason", "seconds")
"""Keys that a record has beside those of the outcome."""


def solve_point(config: Config) -> Record:
    """The outcome of a press with its status, reason (None when solved) and seconds. Raises nothing."""
    start = time.perf_counter()
    return {**_attempt(config), "seconds": time.perf_counter() - start}


def _attempt(config: Config) -> Record:
    """The outcome of a press with its status and reason."""
    try:
        found = outcome(config)
    except InputError as error:
        return failed_record(REFUSED, str(error))
    except Exception as error:
        return failed_record(CRASHED, f"{type(error).__name__}: {error}")
    if found["solver"]["converged"]:
        return {"status": SOLVED, "reason": None, **found}
    return {**failed_record(NOT_CONVERGED, found["solver"]["failure"]), **found}


def failed_record(status: str, reason: str) -> Record:
    """A record without numbers; its reason is put on one line."""
    return {"status": status, "reason": " ".join(reason.split())}


Task = Callable[..., Record]


def solve_points(
    configs: Sequence[Config],
    progress: Progress | None = None,
    workers: int | None = None,
    executor: Executor | None = None,
) -> list[Record]:
    """The outcome of every configuration, in order, by an executor or by processes of this computer, one per core.

    workers : number of processes instead. Each outcome is a new dict with status ("solved", "refused", "not-converged",
    "crashed" or "lost"), reason (one line, None when solved), seconds, and all of softdot.outcome.outcome(config), as
    far as there is any. No point stops the others and nothing is raised for one. Equal configurations are solved once;
    stored outcomes need no worker. progress.step(done, count, reason or "") is called after each point.
    """
    progress = progress or Logged()
    keys = [outcome_key(config) for config in configs]
    distinct = dict(zip(keys, configs, strict=True))
    records = {key: solve_point(config) for key, config in distinct.items() if stored_outcome(config) is not None}
    missing = {key: config for key, config in distinct.items() if key not in records}
    with executor_for(workers=workers) if executor is None else nullcontext(executor) as on:
        for key, record in solve_all(on, missing):
            records[key] = record
            progress.step(len(records), len(distinct), record["reason"] or "")
    return [dict(records[key]) for key in keys]


def solve_all(executor: Executor, configs: Mapping[str, Config]) -> Iterator[tuple[str, Record]]:
    """Name and record of every configuration, in the order in which they end. What is solved is stored."""
    for name, record in records_as_completed(
        executor, solve_point, {name: (config,) for name, config in configs.items()}
    ):
        keep_outcome(configs[name], {key: value for key, value in record.items() if key not in CALL_KEYS})
        yield name, record


def records_as_completed(
    executor: Executor, task: Task, arguments: Mapping[str, tuple[Any, ...]]
) -> Iterator[tuple[str, Record]]:
    """Name and record of each call of a task, in the order in which the calls end. AwayError."""
    for name, future in completed_calls(executor, task, arguments):
        yield name, _record_of_future(future)


def _record_of_future(future: "Future[Any]") -> Record:
    """The result of a worker, or a record with the reason why there is none. AwayError."""
    try:
        return dict(future.result())
    except AwayError:
        raise
    except LostError as error:
        return failed_record(LOST, str(error))
    except Exception as error:
        return failed_record(CRASHED, f"{type(error).__name__}: {error}")

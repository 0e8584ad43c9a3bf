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
from softdot.outcome import keep_outcome, outcome, outcome_key, remembered
from softdot.progress import Logged, Progress

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
    for name, future in completed_calls(executor, task, arguments):
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

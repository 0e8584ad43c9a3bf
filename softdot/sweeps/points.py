"""One point of a sweep in a worker, and tasks through a cluster, each handed back as soon as it has ended."""

import time
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from geometry.base import InputError
from softdot.config import Config, config_from
from softdot.outcome import outcome

Record = dict[str, Any]

SOLVED, REFUSED, NOT_CONVERGED, CRASHED, LOST = "solved", "refused", "not-converged", "crashed", "lost"
STATUSES = (SOLVED, REFUSED, NOT_CONVERGED, CRASHED, LOST)
ACCIDENTS = (CRASHED, LOST)
"""Not the fault of the configuration: tried again when the sweep is started again."""

TINY = {
    "segment": {
        "effector": {"height_mm": 0.5},
        "medium1": {"thickness_mm": 0.5},
        "film": {"thickness_um": 100.0},
        "medium2": {"thickness_mm": 0.5},
    },
    "press": {"indentation_mm": 0.05, "load_steps": 1},
    "mesh": {"mesher": "layered", "element_size_mm": 1.0, "contact_element_size_mm": 1.0},
}


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


def warm_up_config() -> Config:
    """A press of seconds that has the kernels compiled by one worker before all of them need them."""
    return config_from(TINY)


AWAY = "the Dask scheduler disappeared; finished points are kept, start the sweep again"
Task = Callable[..., Record]


def solve_all(client: Any, configs: Mapping[str, Config]) -> Iterator[tuple[str, Record]]:
    """Name and record of every configuration, in the order in which they end."""
    return all_ended(client, solve_point, {name: (config,) for name, config in configs.items()}, AWAY)


def all_ended(
    client: Any, task: Task, arguments: Mapping[str, tuple[Any, ...]], away: str
) -> Iterator[tuple[str, Record]]:
    """Name and record of the task with each arguments, in the order in which they end.

    No more are under way than there are threads: when a worker dies, only what it worked on is suspected.
    InputError with the sentence away where the scheduler disappears.
    """
    from distributed import as_completed
    from distributed.client import ClosedClientError

    waiting = iter(arguments.items())
    names: dict[Any, str] = {}
    running = as_completed(loop=client.loop)  # type: ignore[no-untyped-call]

    def fill() -> None:
        """Keep every thread busy, and one task at least under way while the workers are being replaced."""
        threads = max(1, sum(client.nthreads().values()))
        while len(names) < threads and (following := next(waiting, None)) is not None:
            future = client.submit(task, *following[1], pure=False)
            names[future] = following[0]
            running.add(future)  # type: ignore[no-untyped-call]

    try:
        fill()
        for future in running:
            if future.status == "cancelled":
                raise InputError(away)
            yield names.pop(future), _record(future)
            fill()
    except (OSError, ClosedClientError):
        raise InputError(away) from None


def _record(future: Any) -> Record:
    """What the worker returned, or why it could not."""
    from distributed import KilledWorker

    error = future.exception()
    if error is None:
        return dict(future.result())
    if isinstance(error, KilledWorker):
        return failed(LOST, "its worker died each time, perhaps for lack of memory")
    return failed(CRASHED, f"{type(error).__name__}: {error}")

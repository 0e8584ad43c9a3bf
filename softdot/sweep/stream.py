"""Tasks through a Dask cluster, each handed back as soon as it has ended."""

from collections.abc import Callable, Iterator, Mapping
from typing import Any

from geometry.base import InputError
from softdot.config import Config
from softdot.sweep.point import CRASHED, LOST, Record, failed, solve_point

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

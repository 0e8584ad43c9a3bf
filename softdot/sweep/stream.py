"""Points through a Dask cluster, each handed back as soon as it is solved."""

from collections.abc import Iterator, Mapping
from typing import Any

from geometry.errors import InputError
from softdot.config import Config
from softdot.sweep.point import CRASHED, LOST, Record, failed, solve_point

AWAY = "the Dask scheduler went away; finished points are kept, start the sweep again"


def solve_all(client: Any, configs: Mapping[str, Config]) -> Iterator[tuple[str, Record]]:
    """Name and record of every configuration, in the order in which they end.

    No more points are under way than there are threads: when a worker dies, only what it solved is suspected.
    """
    from distributed import as_completed
    from distributed.client import ClosedClientError

    waiting = iter(configs.items())
    names: dict[Any, str] = {}
    running = as_completed(loop=client.loop)  # type: ignore[no-untyped-call]
    try:
        _fill(client, waiting, names, running)
        for future in running:
            yield names.pop(future), _record(future)
            _fill(client, waiting, names, running)
    except (OSError, ClosedClientError):
        raise InputError(AWAY) from None


def _fill(client: Any, waiting: Iterator[tuple[str, Config]], names: dict[Any, str], running: Any) -> None:
    """Keep every thread busy, and one point at least under way while the workers are being replaced."""
    threads = max(1, sum(client.nthreads().values()))
    while len(names) < threads and (following := next(waiting, None)) is not None:
        name, config = following
        future = client.submit(solve_point, config, pure=False)
        names[future] = name
        running.add(future)


def _record(future: Any) -> Record:
    """What the worker returned, or why it could not."""
    from distributed import KilledWorker

    if future.status == "cancelled":
        raise InputError(AWAY)
    error = future.exception()
    if error is None:
        return dict(future.result())
    if isinstance(error, KilledWorker):
        return failed(LOST, "its worker died each time; the memory may have been too small")
    return failed(CRASHED, f"{type(error).__name__}: {error}")

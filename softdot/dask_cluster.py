"""A Dask cluster that already runs, as an executor: its scheduler is asked, its workers must have this softdot."""

import asyncio
import re
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from functools import partial
from typing import Any

from foundation.errors import InputError
from foundation.executor import LostError
from foundation.source_hash import source_hash
from softdot.warm_up import warm_up

SILENT_LOG_LEVEL = 60  # above every level of Python's logging


class AwayError(InputError):
    """The scheduler does not answer any more."""

    def __init__(self) -> None:
        super().__init__("the Dask scheduler disappeared; what was finished is kept, start the same command again")


class Cluster:
    """The workers of a Dask cluster as an executor; a call whose worker dies is repeated by another one."""

    def __init__(self, client: Any) -> None:
        self._client = client

    @property
    def places(self) -> int:
        """Number of threads of all workers, at least one while they are being replaced. AwayError."""
        threads: dict[str, int] = _call_scheduler(self._client.nthreads)
        return max(1, sum(threads.values()))

    def submit(self, function: Callable[..., Any], /, *arguments: Any) -> "Future[Any]":
        """Call a function on a worker, see foundation.executor.Executor. AwayError, raised here or by the future."""
        future: Future[Any] = Future()
        future.set_running_or_notify_cancel()
        asked = _call_scheduler(self._client.submit, function, *arguments, pure=False)
        asked.add_done_callback(partial(_copy_result, future))
        return future


def _call_scheduler(ask: Callable[..., Any], *arguments: Any, **options: Any) -> Any:
    """The result of a call of the client. AwayError where the scheduler does not answer."""
    from distributed.client import ClosedClientError

    try:
        return ask(*arguments, **options)
    except (OSError, ClosedClientError):
        raise AwayError from None


def _copy_result(future: "Future[Any]", asked: Any) -> None:
    """Copy result or error of a future of Dask into one of Python."""
    from distributed import KilledWorker

    if asked.status == "cancelled":
        future.set_exception(AwayError())
        return
    error = asked.exception()
    if error is None:
        future.set_result(asked.result())
    else:
        future.set_exception(LostError() if isinstance(error, KilledWorker) else error)


CONNECT_S, WORKERS_S = 5, 10
"""Times to wait for an answer of the scheduler, and for its first worker."""
ADDRESS = re.compile(r"(tcp|tls)://(\[[0-9a-fA-F:.]+\]|[\w.-]+):(\d{1,5})")
"""The address of a scheduler: protocol, host and port."""


@contextmanager
def existing_cluster(address: str) -> Iterator[Cluster]:
    """The cluster of a scheduler that runs already. InputError when it does not answer or its workers do not fit."""
    from distributed import Client
    from distributed.utils import silence_logging_cmgr

    where = f"--scheduler '{address}'"
    match = ADDRESS.fullmatch(address)
    if match is None or int(match[3]) > 65535:
        raise InputError(f"{where}: must be tcp://HOST:PORT or tls://HOST:PORT, such as tcp://127.0.0.1:8786")
    _require_scheduler(address, where)
    with (
        silence_logging_cmgr(SILENT_LOG_LEVEL),
        Client(address, timeout=CONNECT_S, set_as_default=False) as client,  # type: ignore[no-untyped-call]
    ):
        _require_fitting_workers(client, where)
        cluster = Cluster(client)
        warm_up(cluster)
        yield cluster


def _require_scheduler(address: str, where: str) -> None:
    """InputError unless a Dask scheduler answers at an address; Dask's own client waits for ever on a silent server."""
    try:
        kind = asyncio.run(asyncio.wait_for(_server_kind(address), CONNECT_S))
    except Exception as error:  # a foreign server can answer anything
        reason = "" if isinstance(error, OSError) else f" ({type(error).__name__})"
        raise InputError(f"{where}: no Dask scheduler answers there within {CONNECT_S} s{reason}") from None
    if kind != "Scheduler":
        raise InputError(f"{where}: this is a Dask {str(kind).lower()}, not a scheduler")


async def _server_kind(address: str) -> Any:
    """The kind of server that answers at an address, in Dask's own word."""
    from distributed import Security
    from distributed.core import rpc

    arguments = Security().get_connection_args("client")  # type: ignore[no-untyped-call]
    async with rpc(address, connection_args=arguments) as server:  # type: ignore[no-untyped-call]
        return (await server.identity())["type"]


WORKER_MODULES = (
    "softdot.outcome",
    "softdot.arrays.kernel_presses",
    "softdot.arrays.presses",
    "softdot.reading.designs.operating",
    "softdot.reading.study_task",
    "softdot.tolerances.questions",
    "solve.tables.workers",
)
"""Modules whose functions workers are asked to call; a proof checks its own."""


def program_hashes() -> list[str]:
    """Hashes of the source of this softdot, by which it is compared with that of a worker."""
    return [source_hash(module) for module in WORKER_MODULES]


def _require_fitting_workers(client: Any, where: str) -> None:
    """InputError unless there are workers and each has this softdot."""
    try:
        client.wait_for_workers(1, timeout=WORKERS_S)
    except TimeoutError:
        raise InputError(f"{where}: this scheduler has no workers; start some with 'dask worker ADDRESS'") from None
    answers = client.run(program_hashes, on_error="return")
    for worker, answer in answers.items():
        if isinstance(answer, Exception):
            raise InputError(f"{where}: its worker {worker} cannot load softdot ({answer}); install it there")
        if answer != program_hashes():
            raise InputError(f"{where}: its worker {worker} has another softdot; install the same one there")

"""A Dask cluster that runs already: does it answer, and do its workers fit?"""

import asyncio
import re
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from geometry.base import InputError
from softdot.outcome import source_hash
from softdot.sweep.cluster import SILENT, warm_up

CONNECT_S, WORKERS_S = 5, 10
ADDRESS = re.compile(r"(tcp|tls)://(\[[0-9a-fA-F:.]+\]|[\w.-]+):(\d{1,5})")


@contextmanager
def existing_cluster(address: str) -> Iterator[Any]:
    """The cluster of a scheduler that runs already. InputError when it does not answer or its workers do not fit."""
    from distributed import Client
    from distributed.utils import silence_logging_cmgr

    where = f"--scheduler '{address}'"
    match = ADDRESS.fullmatch(address)
    if match is None or int(match[3]) > 65535:
        raise InputError(f"{where}: must be tcp://HOST:PORT or tls://HOST:PORT, such as tcp://127.0.0.1:8786")
    _require_scheduler(address, where)
    with (
        silence_logging_cmgr(SILENT),
        Client(address, timeout=CONNECT_S, set_as_default=False) as client,  # type: ignore[no-untyped-call]
    ):
        _require_fitting_workers(client, where)
        warm_up(client)
        yield client


def _require_scheduler(address: str, where: str) -> None:
    """Something at the address answers as a Dask scheduler does; Dask's own client waits for ever on a mute one."""
    try:
        kind = asyncio.run(asyncio.wait_for(_kind(address), CONNECT_S))
    except Exception as error:  # a foreign server can answer anything
        reason = "" if isinstance(error, OSError) else f" ({type(error).__name__})"
        raise InputError(f"{where}: no Dask scheduler answers there within {CONNECT_S} s{reason}") from None
    if kind != "Scheduler":
        raise InputError(f"{where}: this is a Dask {str(kind).lower()}, not a scheduler")


async def _kind(address: str) -> Any:
    """What a Dask server calls itself."""
    from distributed import Security
    from distributed.core import rpc

    arguments = Security().get_connection_args("client")  # type: ignore[no-untyped-call]
    async with rpc(address, connection_args=arguments) as server:  # type: ignore[no-untyped-call]
        return (await server.identity())["type"]


def _require_fitting_workers(client: Any, where: str) -> None:
    """Every worker has this softdot."""
    try:
        client.wait_for_workers(1, timeout=WORKERS_S)
    except TimeoutError:
        raise InputError(f"{where}: this scheduler has no workers; start some with 'dask worker ADDRESS'") from None
    answers = client.run(source_hash, on_error="return")
    for worker, answer in answers.items():
        if isinstance(answer, Exception):
            raise InputError(f"{where}: its worker {worker} cannot load softdot ({answer}); install it there")
        if answer != source_hash():
            raise InputError(f"{where}: its worker {worker} has another softdot; install the same one there")

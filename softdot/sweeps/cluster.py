"""Dask clusters: one of this computer, one process per core, each on one thread, or one that runs already."""

import asyncio
import os
import platform
import re
import signal
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from multiprocessing import resource_tracker
from pathlib import Path
from typing import Any

from geometry.base import InputError
from geometry.cache import source_hash
from geometry.environment import ONE_THREAD, usable_cores
from geometry.files import scratch_folder
from softdot.config import Config
from softdot.console import Logged, Progress
from softdot.outcome import outcome, outcome_key, remembered
from softdot.sweeps.points import Record, solve_all, solve_point, warm_up_config

SILENT = 60  # above every level of Python's logging
DEATHS = 1
"""A point whose worker has died more often than this is given up."""
SETTINGS = {
    "distributed.scheduler.allowed-failures": DEATHS,
    "distributed.scheduler.worker-ttl": None,  # a long factorisation keeps a worker from saying that it lives
    "distributed.worker.memory.pause": False,  # a paused worker with nothing to let go would pause for ever
    "distributed.worker.profile.enabled": False,
    # Dask would have glibc give memory back after every large array: 1.4 times the processor time of a small press
    "distributed.nanny.pre-spawn-environ.MALLOC_TRIM_THRESHOLD_": None,
}
NO_DASHBOARD = {"dashboard": False, "dashboard_address": "127.0.0.1:0"}
GRACE_S = 0.5


@contextmanager
def local_cluster(workers: int | None = None) -> Iterator[Any]:
    """One process per core, or as many as said, each on one thread with its share of the memory.

    A worker that dies is replaced. Every process has ended when the block ends.
    """
    import dask
    from distributed import Client, LocalCluster

    with ExitStack() as stack:
        stack.enter_context(dask.config.set(SETTINGS))
        stack.enter_context(_one_thread_each())
        folder = stack.enter_context(scratch_folder())  # else what a killed sweep leaves there stays for ever
        with _ctrl_c_for_us_alone():
            cluster = LocalCluster(  # type: ignore[no-untyped-call]
                n_workers=workers or usable_cores(),
                threads_per_worker=1,
                processes=True,
                silence_logs=SILENT,
                scheduler_kwargs=NO_DASHBOARD,
                local_directory=str(folder),
            )
            stack.enter_context(cluster)
            stack.callback(cluster.sync, _end_workers, cluster)
            client = stack.enter_context(Client(cluster, set_as_default=False))  # type: ignore[no-untyped-call]
        warm_up(client)
        yield client


async def _end_workers(cluster: Any) -> None:
    """Do not wait for the points that are under way, as Dask would for seconds."""
    await asyncio.gather(*(nanny.close(timeout=GRACE_S) for nanny in cluster.workers.values()))


@contextmanager
def _one_thread_each() -> Iterator[None]:
    """Processes started inside this block calculate on one thread: the workers share the cores, not their threads."""
    before = dict(os.environ)
    os.environ.update(ONE_THREAD)
    try:
        yield
    finally:
        os.environ.clear()
        os.environ.update(before)


@contextmanager
def _ctrl_c_for_us_alone() -> Iterator[None]:
    """Threads and processes started inside this block never see Ctrl-C; a replaced worker inherits that."""
    resource_tracker.ensure_running()  # else Python starts it later, and unblocks the signal
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def warm_up(client: Any) -> None:
    """Compile the kernels in one worker: several at once could spoil numba's cache of compiled code."""
    config = warm_up_config()
    if remembered(config) is None:
        client.submit(outcome, config, pure=False).exception()


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
    answers = client.run(source_hash, outcome.__module__, on_error="return")
    for worker, answer in answers.items():
        if isinstance(answer, Exception):
            raise InputError(f"{where}: its worker {worker} cannot load softdot ({answer}); install it there")
        if answer != source_hash(outcome.__module__):
            raise InputError(f"{where}: its worker {worker} has another softdot; install the same one there")


CPUINFO = Path("/proc/cpuinfo")


def hardware() -> dict[str, Any]:
    """Processor, cores that may be used, memory in GB, Python. Of this computer, whoever works elsewhere."""

    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    return {
        "processor": _processor(),
        "cores": usable_cores(),
        "memory_GB": memory / 1e9,
        "system": platform.platform(),
        "python": platform.python_version(),
    }


def _processor() -> str:
    lines = CPUINFO.read_text("utf-8").splitlines() if CPUINFO.exists() else []
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor()


def solve_points(
    configs: Sequence[Config], progress: Progress | None = None, workers: int | None = None
) -> list[dict[str, Any]]:
    """The outcome of every configuration, in order, solved on one process per core (or as many as workers).

    Each is a new dict with status ("solved", "refused", "not-converged", "crashed" or "lost"), reason (one line,
    None when solved), seconds, and all of softdot.outcome.outcome(config), as far as there is any. No point stops the
    others and nothing is raised for one. Equal configurations are solved once; outcomes that are remembered need no
    worker. progress.step(done, count, reason or "") is called after each point.
    A script needs `if __name__ == "__main__":` around the call.
    """
    progress = progress or Logged()
    keys = [outcome_key(config) for config in configs]
    distinct = dict(zip(keys, configs, strict=True))
    records = {key: solve_point(config) for key, config in distinct.items() if remembered(config) is not None}
    missing = {key: config for key, config in distinct.items() if key not in records}
    if missing:
        _solve(missing, records, progress, workers)
    return [dict(records[key]) for key in keys]


def _solve(missing: Mapping[str, Config], records: dict[str, Record], progress: Progress, workers: int | None) -> None:
    """Fill records with what is missing."""
    count = len(records) + len(missing)
    with local_cluster(workers) as client:
        for key, record in solve_all(client, missing):
            records[key] = record
            progress.step(len(records), count, record["reason"] or "")

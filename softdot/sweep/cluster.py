"""A Dask cluster of this computer: one process per core, each on one thread."""

import asyncio
import os
import signal
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from multiprocessing import resource_tracker
from typing import Any

from geometry.processes import ONE_THREAD, scratch_folder
from softdot.outcome import outcome, remembered
from softdot.sweep.point import warm_up_config

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


def usable_cores() -> int:
    """Cores that this process may use: affinity and the limits of a container count."""
    from dask.system import CPU_COUNT

    return int(CPU_COUNT)


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

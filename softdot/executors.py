"""Which executor the presses of a command go to: processes of this computer, one a core, or a Dask cluster."""

from collections.abc import Iterator
from contextlib import contextmanager

from foundation.executor import Executor, LocalProcesses
from foundation.thread_pools import usable_cores
from softdot.dask_cluster import existing_cluster
from softdot.warm_up import warm_up


@contextmanager
def executor_for(scheduler: str | None = None, workers: int | None = None) -> Iterator[Executor]:
    """Executor for the time of a block: the Dask cluster of a scheduler (tcp://HOST:PORT), or processes of this
    computer.

    workers : processes, one per core by default; they start with the first call. InputError for a scheduler that does
    not answer and for one whose workers do not fit.
    """
    if scheduler is None:
        with LocalProcesses(workers or usable_cores(), warm_up) as processes:
            yield processes
    else:
        with existing_cluster(scheduler) as cluster:
            yield cluster

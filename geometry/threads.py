"""Thread pools: as many threads as there are cores free to this process, asleep while they have no work.

The libraries read these variables once, when they are loaded. Each has a pool of its own: OpenBLAS under NumPy and
SciPy, libgomp under numba, libiomp under MKL. By default their threads spin for a while after each call, and so take
the cores from one another and from other programs; docs/speed.md has what that costs.
"""

import os

ASLEEP = {
    "OPENBLAS_THREAD_TIMEOUT": "4",  # 2^4 cycles, the least it takes; 2^26 by default
    "OMP_WAIT_POLICY": "PASSIVE",
    "KMP_BLOCKTIME": "0",  # MKL sets it by itself, and not to what OMP_WAIT_POLICY asks for
}
ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1")


def sleep_while_idle() -> None:
    """Before NumPy is loaded. What the user has set stays."""
    for name, value in ASLEEP.items():
        os.environ.setdefault(name, value)


def follow_free_cores() -> None:
    """Before numba and MKL are loaded; both follow OMP_NUM_THREADS where the user has set it."""
    threads = os.environ.setdefault("OMP_NUM_THREADS", str(usable_cores())).split(",")[0]
    if threads.isdecimal() and int(threads) > 0:
        os.environ.setdefault("NUMBA_NUM_THREADS", threads)


def usable_cores() -> int:
    """Cores that this process may use: affinity and the limits of a container count."""
    from dask.system import cpu_count

    return int(cpu_count())

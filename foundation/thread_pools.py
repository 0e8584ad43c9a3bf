"""Thread pools of the compiled libraries: as many threads as there are cores free to this process, asleep without work.

Each library has a pool of its own, and reads its size from the environment once, when it is loaded: OpenBLAS under
NumPy and SciPy, libiomp under MKL, and libgomp under parallel loops of numba, of which softdot has none (its kernels
run in threads of solve.compiled). By default their threads spin for a while after each call, and so take the cores from
one another and from other programs; docs/speed.md has what that costs. OpenBLAS gets one thread: its products are of
small or narrow matrices, thousands of them in a diagnosis, and waking a second thread takes longer than it saves.
"""

import os

POOL_VARIABLES = {
    "OPENBLAS_NUM_THREADS": "1",
    "OPENBLAS_THREAD_TIMEOUT": "4",  # 2^4 cycles, the least it takes; 2^26 by default
    "OMP_WAIT_POLICY": "PASSIVE",
    "KMP_BLOCKTIME": "0",  # MKL sets it by itself, and not to what OMP_WAIT_POLICY asks for
}
ONE_THREAD_VARIABLES = dict.fromkeys(
    ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1"
)


def quiet_pools() -> None:
    """Set the variables of all thread pools, before NumPy is loaded; those that the user has set stay."""
    for name, value in POOL_VARIABLES.items():
        os.environ.setdefault(name, value)


def follow_free_cores() -> None:
    """Set the threads of numba and MKL to the usable cores, before they are loaded; OMP_NUM_THREADS comes first."""
    if "OMP_NUM_THREADS" not in os.environ:  # counting takes a fifth of a second, which worker processes are spared
        os.environ["OMP_NUM_THREADS"] = str(usable_cores())
    threads = os.environ["OMP_NUM_THREADS"].split(",")[0]
    if threads.isdecimal() and int(threads) > 0:
        os.environ.setdefault("NUMBA_NUM_THREADS", threads)


def usable_cores() -> int:
    """Return the number of cores that this process may use: affinity and the limits of a container count."""
    from dask.system import cpu_count

    return int(cpu_count())

"""Thread pools of the compiled libraries: as many threads as there are cores free to this process, asleep without work.

Each library has a pool of its own, and reads its size from the environment once, when it is loaded: OpenBLAS under
NumPy and SciPy, libiomp under MKL, and libgomp under parallel loops of numba, of which softdot has none (its kernels
run in threads of solve.compiled). By default their threads spin for a while after each call, and so take the cores from
one another and from other programs; docs/speed.md has what that costs. OpenBLAS gets one thread: its products are of
small or narrow matrices, thousands of them in a diagnosis, and waking a second thread takes longer than it saves.
"""

import os

POOLS = {
    "OPENBLAS_NUM_THREADS": "1",
    "OPENBLAS_THREAD_TIMEOUT": "4",  # 2^4 cycles, the least it takes; 2^26 by default
    "OMP_WAIT_POLICY": "PASSIVE",
    "KMP_BLOCKTIME": "0",  # MKL sets it by itself, and not to what OMP_WAIT_POLICY asks for
}
ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1")


def quiet_pools() -> None:
    """Before NumPy is loaded. What the user has set stays."""
    for name, value in POOLS.items():
        os.environ.setdefault(name, value)


def follow_free_cores() -> None:
    """Before numba and MKL are loaded; both follow OMP_NUM_THREADS where the user has set it."""
    if "OMP_NUM_THREADS" not in os.environ:  # counting takes a fifth of a second, which worker processes are spared
        os.environ["OMP_NUM_THREADS"] = str(usable_cores())
    threads = os.environ["OMP_NUM_THREADS"].split(",")[0]
    if threads.isdecimal() and int(threads) > 0:
        os.environ.setdefault("NUMBA_NUM_THREADS", threads)


def usable_cores() -> int:
    """Cores that this process may use: affinity and the limits of a container count."""
    from dask.system import cpu_count

    return int(cpu_count())

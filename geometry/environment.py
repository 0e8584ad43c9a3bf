"""What the compiled libraries read from the environment, once, when they are loaded.

Thread pools: as many threads as there are cores free to this process, asleep while they have no work. Each library has
a pool of its own: OpenBLAS under NumPy and SciPy, libiomp under MKL, and libgomp under parallel loops of numba, of
which softdot has none (its kernels run in threads of solve.compiled). By default their threads spin
for a while after each call, and so take the cores from one another and from other programs; docs/speed.md has what that
costs. OpenBLAS gets one thread: its products are of small or narrow matrices, thousands of them in a diagnosis, and
waking a second thread takes longer than it saves.

Compiled kernels: numba keeps them, and compiles one anew when its own file changes, not when a file changes whose
pieces it calls. They are therefore kept in a folder that is named by these files. It lies in the source, as by numba's
default, but not in that of an installed package: kernels would stay behind when pip removes it, and the folders that
hold them would hide a source checkout that is installed afterwards.
"""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from hashlib import sha256
from pathlib import Path

POOLS = {
    "OPENBLAS_NUM_THREADS": "1",
    "OPENBLAS_THREAD_TIMEOUT": "4",  # 2^4 cycles, the least it takes; 2^26 by default
    "OMP_WAIT_POLICY": "PASSIVE",
    "KMP_BLOCKTIME": "0",  # MKL sets it by itself, and not to what OMP_WAIT_POLICY asks for
}
PIECES = (
    "solve/compiled.py",
    "solve/decay.py",
    "solve/tensors.py",
    "solve/fem/*.py",
    "solve/materials/*.py",
    "solve/reduced/table_reading.py",
    "solve/readout/filters.py",
    "diagnose/engines/coupon/*.py",
)
SAFE_PATH = "PYTHONSAFEPATH"
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


def keep_kernels_apart(package: Path) -> None:
    """Before numba is loaded: where the kernels of a program are kept, one of whose packages is this folder.

    What the user has set stays.
    """
    if "NUMBA_CACHE_DIR" in os.environ:
        return
    kept = package.parent / "solve" / "__pycache__"
    if {"site-packages", "dist-packages"} & set(package.parts):
        from platformdirs import user_cache_path

        kept = user_cache_path("softdot", appauthor=False)
    os.environ["NUMBA_CACHE_DIR"] = str(kept / "kernels" / _state_of_pieces(package.parent))


def _state_of_pieces(program: Path) -> str:
    """A name that changes with the files whose pieces are compiled into kernels of other files; some milliseconds."""
    sources = sorted(file for place in PIECES for file in program.glob(place))
    return sha256(b"".join(file.read_bytes() for file in sources)).hexdigest()[:12]


def own_python(*arguments: str) -> list[str]:
    """A command that runs this Python, to be started with own_path: the working folder holds no modules of ours."""
    return [sys.executable, "-P", *arguments]


def own_path() -> dict[str, str]:
    """The variable by which a child process finds the modules of this one, and none in its working folder."""
    program = str(Path(__file__).resolve().parents[1])
    folders = [folder for folder in sys.path if folder]
    return {"PYTHONPATH": os.pathsep.join([*folders, *({program} - set(folders))])}


@contextmanager
def without_working_folder() -> Iterator[None]:
    """Python processes that libraries start inside this block do not look for modules in the working folder."""
    before = os.environ.get(SAFE_PATH)
    os.environ[SAFE_PATH] = "1"
    try:
        yield
    finally:
        os.environ.pop(SAFE_PATH)
        if before is not None:
            os.environ[SAFE_PATH] = before


def usable_cores() -> int:
    """Cores that this process may use: affinity and the limits of a container count."""
    from dask.system import cpu_count

    return int(cpu_count())

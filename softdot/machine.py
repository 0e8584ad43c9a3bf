"""What a machine may lack: disk, memory, a system library; each is said in one sentence."""

import errno
import os
import re
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from geometry.base import InputError
from geometry.executor import LostError
from softdot.console import BAD_INPUT, NOT_CONVERGED

CLOSED = {errno.EROFS, errno.EACCES, errno.EPERM}
FULL = {
    errno.ENOSPC: "the disk is full",
    errno.EDQUOT: "the quota of the disk is used up",
    errno.EFBIG: "a limit of the size of files (ulimit -f) is reached",
}
OUT_OF_MEMORY = ("bad_alloc", "out of memory", "cannot allocate memory", "unable to allocate")
ADVICE = "use larger element sizes, or a machine or a job with more memory"

SPARE_B = 65536  # a disk with less than this has had no room for the last block of a file
PROBE_B = 2**22


def refuse_cut_files(folder: Path) -> None:
    """OSError where the disk under a folder is full, or a file in it has reached the limit of the size of files.

    Some libraries cut a file there and tell nobody.
    """
    if shutil.disk_usage(folder).free < SPARE_B:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(folder))
    limit = _largest_file_B()
    if limit is None:
        return
    for path in folder.rglob("*"):
        if path.is_file() and path.stat().st_size >= limit - 4096:
            raise OSError(errno.EFBIG, os.strerror(errno.EFBIG), str(path))


def refuse_full_disk(folder: Path) -> None:
    """OSError where a file of some megabytes cannot be written into a folder: asked after a library has failed."""
    refuse_cut_files(folder)
    probe = folder / ".probe"
    try:
        probe.write_bytes(bytes(PROBE_B))
    finally:
        probe.unlink(missing_ok=True)


def _largest_file_B() -> int | None:
    """The limit of the size of files (ulimit -f), None without one."""
    try:
        import resource
    except ImportError:  # not on Windows
        return None
    soft, _ = resource.getrlimit(resource.RLIMIT_FSIZE)
    return None if soft == resource.RLIM_INFINITY else soft


def without_room(error: BaseException) -> tuple[str, int] | None:
    """Sentence and exit status for an error that disk or memory is the cause of; None for any other.

    The causes of an error are looked at too, since libraries raise their own in place of the system's.
    """
    one: BaseException | None = error
    while one is not None:
        if isinstance(one, OSError) and one.errno in FULL:
            return f"'{one.filename or tempfile.gettempdir()}' cannot be written: {FULL[one.errno]}", BAD_INPUT
        if isinstance(one, OSError) and one.errno in CLOSED:
            return f"'{one.filename or 'output'}' cannot be written ({one.strerror})", BAD_INPUT
        if isinstance(one, MemoryError) or (isinstance(one, OSError) and one.errno == errno.ENOMEM):
            return f"out of memory: {ADVICE}", NOT_CONVERGED
        if isinstance(one, LostError):
            return f"a press was given up, {one}; what was solved is kept: {ADVICE}", NOT_CONVERGED
        if any(text in str(one).lower() for text in OUT_OF_MEMORY):
            return f"out of memory: {ADVICE}", NOT_CONVERGED
        one = one.__cause__ or one.__context__
    return None


BASE_GB = 0.5
"""Libraries and fields of a run on a small mesh."""
ADDRESSES_GB = 2.5
"""Addresses that the libraries reserve beside that (of ulimit -v): below 3 GB they cannot even be loaded."""
SOLID_GB, SOLID_ELEMENTS, EXPONENT = 4.6, 64_000, 1.2
"""Peak of the factor of a cube by docs/speed.md (0.73 GB of 13,182 elements, 4.6 GB of 63,888)."""
SLICE_GB = 1.2e-5
"""Of each element of a slice: a press of 11,016, 38,352 and 93,492 took 0.42, 0.69 and 1.25 GB."""
CGROUPS = "/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"


def needed_GB(elements: float, sliced: bool) -> float:
    """Rough peak memory of a run with so many tetrahedra."""
    factor = SLICE_GB * elements if sliced else SOLID_GB * (elements / SOLID_ELEMENTS) ** EXPONENT
    return BASE_GB + factor


def refuse_too_little_memory(elements: float, sliced: bool, key: str, value: float | str) -> None:
    """InputError where a run would need more memory than this process may have.

    key, value : the element size to enlarge, or "file" and its name.
    """
    told, larger = (f"'{value}'", "larger elements") if isinstance(value, str) else (f"{value:g}", "a larger size")
    need = needed_GB(elements, sliced)
    for what, limit, extra in _limits():
        if need + extra > limit:
            raise InputError(
                f"mesh.{key} = {told}: about {elements:.2g} elements need some {need + extra:.2g} GB of memory, "
                f"and {what} leaves {limit:.2g} GB; use {larger} or allow more memory"
            )


def refuse_no_room_for_libraries() -> None:
    """InputError where this process may have less memory than loading the libraries takes: they would fail midway."""
    for what, limit, extra in _limits():
        least = BASE_GB + extra
        if least > limit:
            raise InputError(f"{what} leaves {limit:.2g} GB of memory, and a run needs {least:.2g} GB at least")


def _limits() -> Iterator[tuple[str, float, float]]:
    """What limits the memory of this process, its GB, and what it counts beside the memory that is used."""
    if hasattr(os, "sysconf") and "SC_PHYS_PAGES" in os.sysconf_names:
        yield "this computer", 1e-9 * os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"), 0.0
    for name in CGROUPS:
        limit = _number(Path(name))
        if limit is not None:
            yield "the limit of this container or job (cgroup)", 1e-9 * limit, 0.0
    try:
        import resource
    except ImportError:  # not on Windows
        return
    soft, _ = resource.getrlimit(resource.RLIMIT_AS)
    if soft != resource.RLIM_INFINITY:
        yield "the limit of addresses (ulimit -v)", 1e-9 * soft, ADDRESSES_GB


def _number(path: Path) -> float | None:
    """The number in a file of the kernel; None where there is none, or "max"."""
    try:
        return float(path.read_text("ascii"))
    except (OSError, ValueError):
        return None


PACKAGES = {
    "libGL.so.1": "libgl1",
    "libX11.so.6": "libx11-6",
    "libEGL.so.1": "libegl1",
    "libgomp.so.1": "libgomp1",
    "libstdc++.so.6": "libstdc++6",
}
ALL_OF_THEM = "apt-get install -y libgl1 libegl1"


@contextmanager
def named_when_missing() -> Iterator[None]:
    """Turn the ImportError of a wheel that lacks a system library into an InputError with the remedy."""
    try:
        yield
    except ImportError as error:
        found = re.search(r"(lib[\w+.-]+?\.so[.\d]*): cannot open shared object", str(error))
        if found is None:
            raise
        library = found.group(1)
        package = PACKAGES.get(library, "the package that holds it")
        raise InputError(
            f"system library {library} is missing: install {package} (on Debian or Ubuntu '{ALL_OF_THEM}')"
        ) from error

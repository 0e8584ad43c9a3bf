"""The memory that a run needs, and the memory that this machine, its container or its limits allow."""

import os
from collections.abc import Iterator
from pathlib import Path

from foundation.errors import InputError

BASE_GB = 0.5
"""Memory of the libraries, and of the fields of a run on a small mesh."""
RESERVED_ADDRESSES_GB = 2.5
"""Addresses that the libraries reserve besides (for ulimit -v): below 3 GB they cannot even be loaded."""
SOLID_GB, SOLID_ELEMENTS, MEMORY_EXPONENT = 4.6, 64_000, 1.2
"""Peak of the factor of a cube by docs/speed.md (0.73 GB of 13,182 elements, 4.6 GB of 63,888)."""
SLICE_GB_PER_ELEMENT = 1.2e-5
"""Memory for each element of a slice: a press of 11,016, 38,352 and 93,492 took 0.42, 0.69 and 1.25 GB."""
CGROUP_FILES = "/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"
"""Files of the kernel with the limit of memory of a container, by version of cgroups."""


def needed_GB(elements: float, sliced: bool) -> float:
    """Rough peak memory, GB, of a run with a number of tetrahedra."""
    factor = SLICE_GB_PER_ELEMENT * elements if sliced else SOLID_GB * (elements / SOLID_ELEMENTS) ** MEMORY_EXPONENT
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
    """InputError where this process may have less memory than the libraries take, as loading them would fail midway."""
    for what, limit, extra in _limits():
        least = BASE_GB + extra
        if least > limit:
            raise InputError(f"{what} leaves {limit:.2g} GB of memory, and a run needs {least:.2g} GB at least")


def _limits() -> Iterator[tuple[str, float, float]]:
    """Name and GB of each limit on the memory of this process, and the GB that it counts besides the memory in use."""
    if hasattr(os, "sysconf") and "SC_PHYS_PAGES" in os.sysconf_names:
        yield "this computer", 1e-9 * os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"), 0.0
    for name in CGROUP_FILES:
        limit = _number(Path(name))
        if limit is not None:
            yield "the limit of this container or job (cgroup)", 1e-9 * limit, 0.0
    try:
        import resource
    except ImportError:  # not on Windows
        return
    soft, _ = resource.getrlimit(resource.RLIMIT_AS)
    if soft != resource.RLIM_INFINITY:
        yield "the limit of addresses (ulimit -v)", 1e-9 * soft, RESERVED_ADDRESSES_GB


def _number(path: Path) -> float | None:
    """The number in a file of the kernel; None where there is none, or "max"."""
    try:
        return float(path.read_text("ascii"))
    except (OSError, ValueError):
        return None

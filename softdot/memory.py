"""The memory that a run needs, and what this machine, its container or its limits leave."""

import os
from collections.abc import Iterator
from pathlib import Path

from foundation.errors import InputError

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

"""The computer on which a result was made."""

import os
import platform
from pathlib import Path
from typing import Any

from foundation.thread_pools import usable_cores

CPUINFO = Path("/proc/cpuinfo")


def hardware() -> dict[str, Any]:
    """Processor, usable cores, memory in GB and Python of this computer, also where others do the work."""

    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    return {
        "processor": _processor(),
        "cores": usable_cores(),
        "memory_GB": memory / 1e9,
        "system": platform.platform(),
        "python": platform.python_version(),
    }


def _processor() -> str:
    """The name of the processor."""
    lines = CPUINFO.read_text("utf-8").splitlines() if CPUINFO.exists() else []
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor()

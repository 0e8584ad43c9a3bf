"""What computer a result was made on."""

import os
import platform
from pathlib import Path
from typing import Any

from foundation.thread_pools import usable_cores

CPUINFO = Path("/proc/cpuinfo")


def hardware() -> dict[str, Any]:
    """Processor, cores that may be used, memory in GB, Python. Of this computer, whoever works elsewhere."""

    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    return {
        "processor": _processor(),
        "cores": usable_cores(),
        "memory_GB": memory / 1e9,
        "system": platform.platform(),
        "python": platform.python_version(),
    }


def _processor() -> str:
    lines = CPUINFO.read_text("utf-8").splitlines() if CPUINFO.exists() else []
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor()

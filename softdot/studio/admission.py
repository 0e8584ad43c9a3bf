"""How much heavy work runs at once: as many tasks as there are cores for them, and no more than fit into memory."""

import asyncio
import os
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

MEMORY = Path("/proc/meminfo")


def cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def free_GB() -> float:
    """Memory that is free on this machine; without a bound where the system does not tell."""
    try:
        rows = dict(line.split(":") for line in MEMORY.read_text("ascii").splitlines())
        return 1024 * float(rows["MemAvailable"].split()[0]) * 1e-9
    except (OSError, KeyError, ValueError):
        return float("inf")


class Admission:
    """A queue in front of heavy tasks, first come, first served. The first of all begins whatever it needs."""

    def __init__(self, most: int, free: Callable[[], float] = free_GB) -> None:
        self._most, self._free = most, free
        self._running = 0
        self._waiting: list[asyncio.Event] = []

    @asynccontextmanager
    async def place(self, need_GB: float, tell: Callable[[Any], None]) -> AsyncIterator[None]:
        """Room for one task. tell : hears that it waits, and for what."""
        turn = asyncio.Event()
        self._waiting.append(turn)
        try:
            while self._waiting[0] is not turn or not self._has_room(need_GB):
                words = "other work on this machine" if self._running < self._most else f"{self._running} other tasks"
                tell({"progress": {"stage": "waiting", "done": 0, "count": 0, "left_s": None, "text": words}})
                turn.clear()
                await turn.wait()
        finally:
            self._waiting.remove(turn)
            self._call_next()
        self._running += 1
        try:
            yield
        finally:
            self._running -= 1
            self._call_next()

    def _has_room(self, need_GB: float) -> bool:
        return self._running == 0 or (self._running < self._most and need_GB <= self._free())

    def _call_next(self) -> None:
        if self._waiting:
            self._waiting[0].set()

"""The default press beside other programs: python -m benchmarks.neighbours JSON.

Neighbours are busy loops, one core each. What is timed is the solution of two load steps in a process of its own, with
its kernels compiled and its mesh kept; the ratio is to the same with idle cores, measured in the same run.
"""

import json
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from benchmarks.timing import Table, file_argument, run_alone

BUSY = "while True: pass"
COUNTS, REPEATS = (0, 1, 2), 3


@contextmanager
def neighbours(count: int) -> Iterator[None]:
    """So many busy loops."""
    loops = [subprocess.Popen([sys.executable, "-c", BUSY]) for _ in range(count)]
    try:
        time.sleep(1.0)
        yield
    finally:
        for loop in loops:
            loop.kill()
            loop.wait()


def press(cache: str) -> float:
    """Seconds of the press, its mesh made before."""
    import os

    os.environ["SOFTDOT_CACHE"] = cache
    from softdot.case import Case

    case = Case(press={"load_steps": 2})
    _ = case.solved_mesh
    start = time.perf_counter()
    case.solve()
    return time.perf_counter() - start


def main(path: Path) -> None:
    """Measure what the file has not."""
    table = Table(path, "neighbours")
    if table.rows:
        return
    with tempfile.TemporaryDirectory() as cache:
        run_alone("neighbours", "press", cache)  # the mesh, and the kernels
        idle = None
        for count in COUNTS:
            with neighbours(count):
                seconds = statistics.median(run_alone("neighbours", "press", cache)["seconds"] for _ in range(REPEATS))
            idle = idle or seconds
            table.add({"busy loops": count, "press s": round(seconds, 2), "ratio": round(seconds / idle, 2)})


if __name__ == "__main__":
    if sys.argv[1:2] == ["press"]:
        print(json.dumps({"seconds": press(sys.argv[2])}))
    else:
        main(file_argument())

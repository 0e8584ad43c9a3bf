"""Heavy commands on a Dask cluster of two workers, one of which is killed half way: python -m benchmarks.killed_worker
[COMMAND…].

COMMAND : array, diagnose, kit, paper; all if not given. Each is run on this computer alone first, then with
--scheduler, both from an empty cache; the workers have a cache of their own, as on other computers. One worker is
killed, as hard as can be, when half of the presses are there. Said are the largest difference of any number, the
seconds of both, and processes that were left; it fails where numbers differ or a process is left. Designs are coarse.
"""

import json
import math
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import psutil

from examples.recordings.leaky_amplifier import RIG, make
from foundation.thread_pools import ONE_THREAD_VARIABLES
from solve.mechanisms import MECHANISMS

TOLERANCE = 1e-6  # relative: threads and paths of Newton's method differ, its equilibria do not
APART = frozenset({"timing_s", "solve_s", "seconds", "newton_iterations", "max_relative_residual", "processes"})
"""What may differ: times, and what depends on the number of threads or on where a press begins."""
TINY_ARRAY = """
segment = { length_mm = 2.3, width_mm = 2.3, section = "solid", boundary = "free" }
array = { columns = 2, rows = 1, shared = ["film", "medium1", "medium2"] }
dot = { shape = "cap", standard = "marburg-medium" }
press = { indentation_mm = 0.2, load_steps = 2 }
mesh = { element_size_mm = 1.6, contact_element_size_mm = 0.6 }
"""
TINY_KIT = """
press = { indentation_mm = 0.1, load_steps = 2 }
mesh = { element_size_mm = 0.6, contact_element_size_mm = 0.3, mesher = "layered" }
"""
COARSE_RIG = RIG.replace("[readout]", "[mesh]\nelement_size_mm = 1.0\ncontact_element_size_mm = 0.4\n\n[readout]")
CANDIDATES = ("charge-leakage", "property-error", "viscoelasticity")
RUNS = {"slow, 0.15 mm": (0.15, 0.5, 1.0), "slow, 0.2 mm": (0.2, 0.5, 1.0), "quick, 0.2 mm": (0.2, 0.1, 0.5)}
COARSE_PAPER = """
import sys
from softdot import cli
from softdot.sweeps import points
solve = points.solve_points
def coarse(configs, *others, **named):
    meshes = [one.mesh.scale_sizes(4.0).model_copy(update={"mesher": "layered"}) for one in configs]
    larger = [one.model_copy(update={"mesh": mesh}) for one, mesh in zip(configs, meshes)]
    return solve(larger, *others, **named)
points.solve_points = coarse
sys.exit(cli.main(sys.argv[1:]))
"""
"""The whole study, on elements four times as large. The few presses that it meshes with pytetwild, which makes another
mesh each time, are meshed as the others.
"""
SOFTDOT = [sys.executable, "-m", "softdot.cli"]


@dataclass(frozen=True)
class Trial:
    """command : without its options; kept : files of the cache, one a press; summary : of the output."""

    command: list[str]
    kept: str
    summary: str


def trial(name: str, folder: Path) -> Trial:
    """One of TRIALS, its input written into a folder."""
    if name == "diagnose":
        make(folder / "recording", 1, COARSE_RIG, RUNS, 500.0, 6.0)
        without = (option for name in MECHANISMS if name not in CANDIDATES for option in ("--without", name))
        command = [*SOFTDOT, "diagnose", str(folder / "recording"), "--fast-model-only", *without]
        return Trial(command, "press-table-*", "verdict.json")
    if name == "paper":
        return Trial([sys.executable, "-c", COARSE_PAPER, "paper"], "outcome-*", "paper.json")
    tiny = folder / f"{name}.toml"
    tiny.write_text(TINY_ARRAY if name == "array" else TINY_KIT, "utf-8")
    if name == "array":
        return Trial([*SOFTDOT, "array", str(tiny), "--kernel"], "[ak]*-*", "array.json")
    return Trial([*SOFTDOT, "kit", str(tiny)], "response-*", "kit.json")


TRIALS = ("array", "diagnose", "kit", "paper")


class Workers:
    """Two workers of a scheduler, each a process of one thread that nobody replaces."""

    def __init__(self, folder: Path) -> None:
        self._file, self.cache = folder / "scheduler.json", folder / "cache of the workers"
        place = ["--scheduler-file", str(self._file), "--no-dashboard"]
        own = {**os.environ, **ONE_THREAD_VARIABLES, "SOFTDOT_CACHE": str(self.cache)}
        log = (folder / "cluster.txt").open("w")
        base = [sys.executable, "-m"]
        scheduler = [*base, "distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", "0", *place]
        worker = [*base, "distributed.cli.dask_worker", "--no-nanny", "--nthreads", "1", *place]
        worker += ["--local-directory", str(folder)]
        self.scheduler = subprocess.Popen(scheduler, env=own, stderr=log, stdout=log)
        self.workers = [subprocess.Popen(worker, env=own, stderr=log, stdout=log) for _ in range(2)]

    @property
    def address(self) -> str:
        """Of the scheduler, once it has one."""
        while not self._file.exists() or not (told := self._file.read_text("utf-8")):
            time.sleep(0.1)
        return str(json.loads(told)["address"])

    def kill_one(self) -> None:
        """As hard as can be."""
        self.workers[0].send_signal(signal.SIGKILL)
        self.workers[0].wait()

    def end(self) -> None:
        """All of them."""
        for process in (*self.workers, self.scheduler):
            process.kill()
            process.wait()


@contextmanager
def two_workers(folder: Path) -> Iterator[Workers]:
    """For the time of a block."""
    found = Workers(folder)
    try:
        yield found
    finally:
        found.end()


def run(one: Trial, out: Path, cache: Path, more: list[str], half: int = 0, workers: Workers | None = None) -> float:
    """Seconds of a command; a worker is killed when half presses are there. SystemExit where it fails."""
    own, begun = {**os.environ, "SOFTDOT_CACHE": str(cache)}, time.perf_counter()
    running = subprocess.Popen([*one.command, "-o", str(out), "--quiet", *more], env=own)
    while running.poll() is None:
        time.sleep(0.05)
        if workers is not None and workers.workers[0].poll() is None and len(list(cache.glob(one.kept))) >= half:
            workers.kill_one()
    if running.returncode:
        raise SystemExit(f"{' '.join(one.command)} ended with {running.returncode}")
    return time.perf_counter() - begun


def largest_difference(one: Any, other: Any, place: str = "", size: float = 0.0) -> tuple[float, str]:
    """Of any two numbers, relative to the larger of them or of a list of theirs, and its place; infinite where more
    differs.
    """
    if isinstance(one, dict) and isinstance(other, dict) and one.keys() == other.keys():
        keys = sorted(one.keys() - APART)
        return max((largest_difference(one[key], other[key], f"{place}.{key}") for key in keys), default=(0.0, place))
    if isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        size = max((abs(x) for x in (*one, *other) if isinstance(x, float)), default=0.0)
        each = enumerate(zip(one, other, strict=True))
        return max((largest_difference(*two, f"{place}[{n}]", size) for n, two in each), default=(0.0, place))
    if isinstance(one, float) and isinstance(other, float):
        return abs(one - other) / max(abs(one), abs(other), size, 1e-300), place
    return (0.0, place) if one == other else (math.inf, f"{place}: {one!r} or {other!r}")


def left() -> list[str]:
    """Commands of the processes below this one."""
    return [" ".join(child.cmdline()) for child in psutil.Process().children(recursive=True)]


def tried(name: str, folder: Path) -> bool:
    """Run one command both ways and say what came out; whether all is as it must be."""
    one, alone, there = trial(name, folder), folder / "alone", folder / "on the cluster"
    alone_s = run(one, alone, folder / "cache alone", [])
    presses = len(list((folder / "cache alone").glob(one.kept)))
    with two_workers(folder) as workers:
        seconds = run(one, there, folder / "cache", ["--scheduler", workers.address], presses // 2, workers)
        killed = workers.workers[0].poll() is not None
        stray = [command for command in left() if "dask" not in command]
    stray += left()
    found = (json.loads((out / one.summary).read_text("utf-8")) for out in (alone, there))
    difference, place = largest_difference(*found)
    print(
        f"{name}: {presses} presses; {alone_s:.0f} s on this computer, {seconds:.0f} s on two workers, "
        f"{'one' if killed else 'none'} of them killed half way; largest difference {difference:.1e}"
        f"{f' at {place[1:]}' if difference else ''}; "
        f"{len(stray)} processes left",
        flush=True,
    )
    return killed and difference < TOLERANCE and not stray


def main(names: list[str]) -> None:
    """SystemExit where one of them is not as it must be."""
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # so that the cluster ends with this process
    good = True
    for name in names or TRIALS:
        with tempfile.TemporaryDirectory() as folder:
            good &= tried(name, Path(folder))
    if not good:
        raise SystemExit("numbers differ, no worker was killed, or a process was left")


if __name__ == "__main__":
    main(sys.argv[1:])

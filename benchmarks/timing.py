"""Repeated timings, and what they were measured on."""

import importlib.metadata
import json
import os
import platform
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

PACKAGES = ("softdot", "numpy", "scipy", "numba", "pypardiso", "mkl", "ngsolve", "felupe", "scikit-fem")
REPEATS = 5


class Phases:
    """Seconds of named phases, several times over."""

    def __init__(self) -> None:
        self.seconds: dict[str, list[float]] = {}

    def __call__(self, name: str, work: Callable, *arguments):
        """Do the work and note how long it took."""
        start = time.perf_counter()
        answer = work(*arguments)
        self.seconds.setdefault(name, []).append(time.perf_counter() - start)
        return answer

    def medians(self) -> dict[str, float]:
        """Median of each phase, and of their sum where every repetition has all of them."""
        repeats = max(len(values) for values in self.seconds.values())
        repeated = [values for values in self.seconds.values() if len(values) == repeats]
        result = {name: statistics.median(values) for name, values in self.seconds.items()}
        return {**result, "total": statistics.median(map(sum, zip(*repeated, strict=True)))}


def hardware() -> dict:
    """Processor, cores, memory, load before the run, and versions."""
    cpu = next((line for line in _lines("/proc/cpuinfo") if line.startswith("model name")), platform.processor())
    memory = next((line for line in _lines("/proc/meminfo") if line.startswith("MemTotal")), "0 0")
    installed = {d.metadata["Name"].lower() for d in importlib.metadata.distributions()}
    return {
        "cpu": cpu.split(":")[-1].strip(),
        "cores": os.cpu_count(),
        "memory_GB": round(int(memory.split()[1]) / 1e6, 1),
        "load_before": round(os.getloadavg()[0], 2),
        "python": platform.python_version(),
        "versions": {p: importlib.metadata.version(p) for p in PACKAGES if p in installed},
    }


def _lines(path: str) -> list[str]:
    return Path(path).read_text(encoding="utf-8").splitlines() if Path(path).exists() else []


def file_argument(number: int = 1) -> Path:
    """The file that a benchmark is called with. SystemExit with one sentence where it is missing."""
    if len(sys.argv) <= number:
        program = Path(sys.argv[0]).stem
        raise SystemExit(f"benchmarks.{program}: name its file: python -m benchmarks.{program} docs/speed.json")
    return Path(sys.argv[number])


def run_alone(program: str, *arguments: object) -> dict:
    """The JSON that a program of this folder prints last, from a process of its own. SystemExit when it fails."""
    command = [sys.executable, "-m", f"benchmarks.{program}", *map(str, arguments)]
    tools = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")])  # NGSolve's compiler
    done = subprocess.run(
        command, capture_output=True, encoding="utf-8", cwd=Path(__file__).parents[1], env={**os.environ, "PATH": tools}
    )
    if done.returncode:
        raise SystemExit(f"{' '.join(command)}\n{done.stderr}")
    return json.loads(done.stdout.splitlines()[-1])


class Table:
    """Rows in one section of a JSON file, written as soon as they are known."""

    def __init__(self, path: Path, section: str) -> None:
        self._path, self._section = path, section
        everything = self._read()
        self.rows: list[dict] = everything.get(section, {}).get("rows", [])
        self._head = everything.get(section, {}).get("measured_on") or hardware()

    def _read(self) -> dict:
        return json.loads(self._path.read_text(encoding="utf-8")) if self._path.exists() else {}

    def add(self, row: dict) -> None:
        """Append, write and show."""
        self.rows.append(row)
        everything = self._read()
        everything[self._section] = {"measured_on": self._head, "rows": self.rows}
        self._path.write_text(json.dumps(everything, indent=1) + "\n", "utf-8")
        print(json.dumps(row), flush=True)

    def has(self, **keys: object) -> bool:
        """Whether a row with these values is there."""
        return any(all(row.get(name) == value for name, value in keys.items()) for row in self.rows)

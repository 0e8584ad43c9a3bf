"""First and further diagnosis of a rig: python -m benchmarks.diagnosis JSON [RIG…].

RIG : slice, dome; both if not given. Six runs of 10 s at 1 kHz of a press whose charge leaks, with an empty cache, then
another such recording of the same rig. Each is the whole command, with its presses of the full model. Memory is that
of the command and its workers together. Rows that the file has are not measured again.
"""

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import psutil

from benchmarks.timing import Table, file_argument
from examples.recordings.leaky_amplifier import RIG, SIZES_MM, make

DOME = """format = "softdot-recording/1"

[segment]
boundary = "elastic"
side_stiffness_N_per_mm3 = 5.0

[segment.effector]
shape = "dome"
diameter_mm = 2.0
height_mm = 0.8

[segment.medium1]
thickness_mm = 0.8
material = "dragon-skin-30"

[segment.film]
thickness_um = 28.0

[segment.medium2]
thickness_mm = 2.0
material = "ecoflex-00-50"

[dot]
standard = "ada"

[readout]
input_resistance_MOhm = 10000.0
input_capacitance_pF = 100.0

"""
RIGS = {"slice": (RIG, SIZES_MM), "dome": (DOME, (0.5, 0.12))}
RUNS = {
    "slow, 0.15 mm": (0.15, 0.5, 1.0),  # depth in mm, rise and hold in s
    "slow, 0.2 mm": (0.2, 0.5, 1.0),
    "slow, long hold": (0.2, 0.5, 4.0),
    "quick, 0.15 mm": (0.15, 0.1, 0.5),
    "quick, 0.2 mm": (0.2, 0.1, 0.5),
    "quick, long hold": (0.2, 0.1, 4.0),
}
LOOK_S = 0.2  # between two looks at the memory


def diagnosed(recording: Path, cache: Path) -> tuple[float, float]:
    """Seconds and the largest memory in GB of one diagnosis. SystemExit when it fails."""
    command = [sys.executable, "-m", "softdot.cli", "diagnose", str(recording)]
    own = {**os.environ, "SOFTDOT_CACHE": str(cache)}
    start, most = time.perf_counter(), 0
    with subprocess.Popen([*command, "-o", str(recording.with_name("out"))], env=own) as running:
        while running.poll() is None:
            most = max(most, _memory(running.pid))
            time.sleep(LOOK_S)
    if running.returncode:
        raise SystemExit(f"softdot diagnose ended with {running.returncode}")
    return time.perf_counter() - start, 1e-9 * most


def _memory(pid: int) -> int:
    """Bytes of a process and of all that it started; none where one of them just ended."""
    try:
        first = psutil.Process(pid)
        return sum(process.memory_info().rss for process in (first, *first.children(recursive=True)))
    except psutil.NoSuchProcess:
        return 0


def measured(name: str) -> dict:
    """First and further diagnosis of one rig."""
    rig, sizes_mm = RIGS[name]
    row: dict = {"rig": name}
    with tempfile.TemporaryDirectory() as folder:
        for seed, which in enumerate(("first", "further"), start=1):
            recording = Path(folder) / which / "recording"
            recording.parent.mkdir()
            make(recording, seed, rig, RUNS, 1000.0, 10.0, sizes_mm)
            seconds, memory = diagnosed(recording, Path(folder) / "cache")
            row |= {f"{which}_seconds": round(seconds, 1), f"{which}_GB": round(memory, 2)}
    return {**row, "first/further": round(row["first_seconds"] / row["further_seconds"], 1)}


def main(path: Path, names: list[str]) -> None:
    """Measure what the file has not."""
    table = Table(path, "diagnosis")
    for name in names or list(RIGS):
        if not table.has(rig=name):
            table.add(measured(name))


if __name__ == "__main__":
    main(file_argument(), sys.argv[2:])

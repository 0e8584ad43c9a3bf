"""This version against an earlier one: python -m benchmarks.against_itself JSON [CASE…].

Both versions do the same work in turn: whole commands, from the start of Python to the last file, with an empty cache
of results. Their kernels are compiled before, by commands that are not counted, but for cold cases. Beside the clock,
which other programs share, the processor time of the command and of the processes that it starts is told. The earlier
one is checked out of the project's own history beside it. Rows that the file has are not measured again.
"""

import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmarks.diagnosis import RIGS, RUNS
from benchmarks.timing import Table, file_argument
from examples.recordings.leaky_amplifier import make

ROOT = Path(__file__).parents[1]
EARLIER = "225864b"
DEFAULT = (ROOT / "softdot" / "config" / "default.toml").read_text("utf-8")
OFF_AXIS = DEFAULT.replace("[dot]\n", "[dot]\noffset_mm = [0.05, 0.05]\n")
COARSE = OFF_AXIS + "\n[mesh]\nelement_size_mm = 1.0\ncontact_element_size_mm = 0.5\n"


@dataclass(frozen=True)
class Timed:
    """Commands that share a cache; each of them is counted as a part of its own."""

    name: str
    parts: dict[str, tuple[str, ...]]
    """Arguments of each part; {work} is a folder with the recordings and configurations."""
    at_most: dict[str, float]
    """Ratio that was aimed at."""
    cold: bool = False
    """Whether the kernels are compiled in it."""


def diagnoses(rig: str, first: float, further: float) -> Timed:
    """A first diagnosis of a rig, and that of another recording of it."""
    parts = {which: ("diagnose", f"{{work}}/{rig}-{which}") for which in ("first", "further")}
    return Timed(f"diagnosis-{rig}", parts, {"first": first, "further": further})


def single(name: str, at_most: float, *arguments: str, cold: bool = False) -> Timed:
    """One command."""
    return Timed(name, {"all": arguments}, {"all": at_most}, cold)


TIMED = (
    single("default", 0.55, "run"),
    single("default-cold", 0.45, "run", cold=True),
    single("dome", 0.6, "run", f"{ROOT}/examples/dome.toml"),
    single("off-axis", 0.6, "run", "{work}/off-axis.toml"),
    single("plane-strain", 1.0, "run", f"{ROOT}/examples/paper-plane-strain.toml"),
    diagnoses("slice", 1.0, 1.0),
    single("kit", 0.5, "kit"),
    diagnoses("dome", 1.0, 1.0),
    single("paper", 0.6, "paper"),
)


@contextmanager
def checked_out(commit: str, folder: Path) -> Iterator[Path]:
    """A work tree of an earlier commit, for as long as it is needed."""
    git = ["git", "-C", str(ROOT), "worktree"]
    subprocess.run([*git, "add", "--quiet", "--detach", str(folder), commit], check=True)
    try:
        yield folder
    finally:
        subprocess.run([*git, "remove", "--force", str(folder)], check=True)


def seconds(
    source: Path, arguments: tuple[str, ...], work: Path, cache: Path, kernels: Path | None = None
) -> tuple[float, float]:
    """How long one command of a version takes, by the clock and of the processors; kernels : where they are kept, other
    than beside those of the other commands. SystemExit when it fails.
    """
    own = {
        **os.environ,
        "PYTHONPATH": str(source),
        "SOFTDOT_CACHE": str(cache),
        "NUMBA_CACHE_DIR": str(kernels or work / "kernels" / source.name),
    }
    told = [one.format(work=work) for one in arguments]
    with tempfile.TemporaryDirectory(dir=work) as out:
        command = [sys.executable, "-m", "softdot.cli", *told, "-o", str(Path(out) / "out")]
        start, busy = time.perf_counter(), processor_seconds()
        done = subprocess.run(command, env=own, cwd=out, capture_output=True, encoding="utf-8")
        taken = time.perf_counter() - start, processor_seconds() - busy
    if done.returncode:
        raise SystemExit(f"{source.name}: {' '.join(command)}\n{done.stderr}")
    return taken


def processor_seconds() -> float:
    """Of all processes that this one has started and that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def measured(case: Timed, versions: dict[str, Path], work: Path) -> Iterator[dict[str, Any]]:
    """One row a part: seconds of both versions, and their ratio."""
    with tempfile.TemporaryDirectory(dir=work) as kept:
        for part, arguments in case.parts.items():
            row: dict[str, Any] = {"earlier": EARLIER, "case": case.name, "part": part}
            for version, source in versions.items():
                kernels = Path(kept) / f"kernels-{version}" if case.cold else None
                taken = seconds(source, arguments, work, Path(kept) / version, kernels)
                row[f"{version}_s"], row[f"{version}_processor_s"] = (round(one, 1) for one in taken)
            yield {**row, "ratio": round(row["now_s"] / row["then_s"], 3), "aim": case.at_most[part]}


def prepare(work: Path, versions: dict[str, Path]) -> None:
    """Configurations and recordings, and the kernels of both versions."""
    (work / "off-axis.toml").write_text(OFF_AXIS, "utf-8")
    (work / "coarse.toml").write_text(COARSE, "utf-8")
    for source in versions.values():
        for arguments in (("run", "{work}/coarse.toml"), ("run", f"{ROOT}/examples/dome.toml")):
            seconds(source, arguments, work, work / "warm" / source.name)


def recorded(rig: str, work: Path) -> None:
    """Two recordings of a rig, in folders of their own."""
    text, sizes_mm = RIGS[rig]
    for seed, which in enumerate(("first", "further"), start=1):
        make(work / f"{rig}-{which}", seed, text, RUNS, 1000.0, 10.0, sizes_mm)


def main(path: Path, names: list[str]) -> None:
    """Measure what the file has not."""
    table = Table(path, "against itself")
    asked = [one for one in TIMED if one.name in (names or [one.name])]
    missing = [one for one in asked if not table.has(earlier=EARLIER, case=one.name)]
    with tempfile.TemporaryDirectory() as folder, checked_out(EARLIER, Path(folder) / EARLIER) as earlier:
        work, versions = Path(folder), {"then": earlier, "now": ROOT}
        prepare(work, versions)
        for case in missing:
            if case.name.startswith("diagnosis"):
                recorded(case.name.split("-")[1], work)
            for row in measured(case, versions, work):
                table.add(row)


if __name__ == "__main__":
    main(file_argument(), sys.argv[2:])

"""A diagnosis isolated in a process and a folder of its own, which is handed nothing but one recording."""

import json
import os
import subprocess
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from foundation.child_processes import python_command
from foundation.scratch_folders import scratch_folder
from foundation.thread_pools import ONE_THREAD_VARIABLES

KEPT = ("PATH", "LANG", "LC_ALL", "LD_LIBRARY_PATH")
LINES = 3
PROGRAM = "softdot.cli"  # by name: what diagnoses stands above this package


@dataclass(frozen=True)
class Heard:
    """What came out. verdict : None without one; reason : why; next_presses : file -> text of waveforms."""

    verdict: Mapping[str, Any] | None
    reason: str
    seconds: float
    next_presses: Mapping[str, str] = field(default_factory=dict)


def diagnose_isolated(files: Mapping[str, str], cache: Path, limit_s: float, options: tuple[str, ...] = ()) -> Heard:
    """Diagnose a recording, name -> text of its files, in a process of its own and within a limit of time in s."""
    with scratch_folder() as scratch:
        folder = scratch.resolve()
        recording = folder / "recording"
        recording.mkdir()
        (folder / "tmp").mkdir()
        for file, text in files.items():
            (recording / file).write_text(text, "utf-8")
        guard = python_command("-m", "softdot.studies.proof.guard", str(os.getpid()), str(folder), str(cache), PROGRAM)
        begun = time.perf_counter()
        try:
            ended = subprocess.run(
                [*guard, "diagnose", "recording", "-o", "verdict", "--json", *options],
                cwd=folder,
                env=environment(folder, cache),
                capture_output=True,
                encoding="utf-8",
                timeout=limit_s,
                check=False,
            )
        except subprocess.TimeoutExpired:
            return Heard(None, f"no verdict within {limit_s:g} s", time.perf_counter() - begun)
        return _heard(ended, folder, time.perf_counter() - begun)


def _heard(ended: "subprocess.CompletedProcess[str]", folder: Path, seconds: float) -> Heard:
    verdict = folder / "verdict" / "verdict.json"
    if not verdict.exists():
        last = " | ".join(ended.stderr.strip().splitlines()[-LINES:])
        return Heard(None, f"exit {ended.returncode}: {last}", seconds)
    waves = {wave.name: wave.read_text("utf-8") for wave in verdict.parent.glob("next-press*.csv")}
    return Heard(json.loads(verdict.read_text("utf-8")), "", seconds, waves)


def environment(folder: Path, cache: Path) -> dict[str, str]:
    """Environment of a diagnosis, into which no variable of the generator gets: no seed, no folder of recordings, no
    cache of its presses.

    Kernels that are not kept beside the source are compiled once for the cache of the diagnoses.
    """
    program = Path(__file__).resolve().parents[3]
    kept = {name: os.environ[name] for name in KEPT if name in os.environ}
    apart = {"NUMBA_CACHE_DIR": str(cache / "kernels")} if "NUMBA_CACHE_DIR" in os.environ else {}
    return {
        **kept,
        **apart,
        **ONE_THREAD_VARIABLES,
        "HOME": str(folder),
        "TMPDIR": str(folder / "tmp"),
        "PYTHONPATH": str(program),
        "SOFTDOT_CACHE": str(cache),
        "MPLCONFIGDIR": str(folder / "tmp"),
    }

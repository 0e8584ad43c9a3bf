"""Commands killed and interrupted at random instants: nothing is left running, nothing half written."""

import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.softdot.interrupts import heard

pytestmark = [pytest.mark.evidence, pytest.mark.skipif(not Path("/proc/self/environ").exists(), reason="needs /proc")]
KILLS = 10  # of each signal for each of the commands: 60 in all
AFTER_S = 3.0
SLICE = """
[segment]
section = "{section}"
[segment.effector]
height_mm = 0.5
[segment.medium1]
thickness_mm = 0.5
[segment.film]
thickness_um = 100.0
[segment.medium2]
thickness_mm = {height}
[dot]
shape = "{dot}"
[press]
indentation_mm = 0.05
load_steps = 2
[mesh]
element_size_mm = 0.7
contact_element_size_mm = 0.7
"""


def config(section: str, dot: str, height: float) -> str:
    return SLICE.format(section=section, dot=dot, height=height)


def alive(mark: str) -> list[str]:
    """Command lines of the living processes that carry the mark in their environment."""
    found = []
    for place in Path("/proc").glob("[0-9]*"):
        try:
            if mark.encode() in (place / "environ").read_bytes() and place.name != str(os.getpid()):
                found.append((place / "cmdline").read_bytes().replace(b"\0", b" ").decode(errors="replace"))
        except OSError:
            continue
    return [one for one in found if one.strip()]  # a zombie has no command line


class Bench:
    """A folder with a cache, a temporary folder and an output of its own."""

    def __init__(self, folder: Path, command: str) -> None:
        self.folder, self.command = folder, command
        self.out, self.tmp, self.mark = folder / "out", folder / "tmp", f"attack-{os.urandom(8).hex()}"
        self.tmp.mkdir()
        self.random = random.Random(command)
        self.environment = {
            **os.environ, "SOFTDOT_CACHE": str(folder / "cache"), "TMPDIR": str(self.tmp), "SOFTDOT_ATTACK": self.mark,
            "OMP_NUM_THREADS": "1", "MKL_NUM_THREADS": "1",
        }  # fmt: skip

    def start(self) -> "subprocess.Popen[bytes]":
        """The command on another design each time, so that nothing is remembered."""
        height = round(self.random.uniform(0.4, 0.6), 6)
        file = self.folder / "mine.toml"
        file.write_text(config(*self._shape, height), "utf-8")
        arguments = [self.command, str(file), "-o", str(self.out)]
        return subprocess.Popen(
            [sys.executable, "-m", "softdot.cli", *arguments], env=self.environment, stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE, start_new_session=True, preexec_fn=heard,
        )  # fmt: skip

    @property
    def _shape(self) -> tuple[str, str]:
        return ("solid", "cap") if self.command == "kit" else ("plane-strain", "ridge")

    def leftovers(self) -> list[str]:
        """What lies beside the output and in the temporary folder."""
        beside = [path.name for path in self.folder.iterdir() if path.name.startswith(".")]
        return beside + [path.name for path in self.tmp.iterdir() if path.name.startswith("softdot")]


class SolidBench(Bench):
    """As Bench, with pytetwild in a child process."""

    @property
    def _shape(self) -> tuple[str, str]:
        return ("solid", "cap")


def whole(out: Path, summary: str) -> dict:
    """The summary of a folder; every file that its kind of product always has is there."""
    found = json.loads((out / summary).read_text(encoding="utf-8"))
    assert (out / ("kit.html" if summary == "kit.json" else "report.html")).stat().st_size > 1000
    return found


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGINT], ids=["kill", "interrupt"])
@pytest.mark.parametrize(
    ("name", "kind", "summary"),
    [("run", Bench, "summary.json"), ("run", SolidBench, "summary.json"), ("kit", Bench, "kit.json")],
    ids=["slice", "solid", "kit"],
)
def test_nothing_is_left_of_a_command_that_ends_at_any_instant(name, kind, summary, how, tmp_path):
    bench = kind(tmp_path, name)
    begun = time.monotonic()
    first = bench.start()
    assert first.wait(300) in (0, 3), first.stderr.read().decode()
    took = time.monotonic() - begun
    bench.random.seed(f"{name} {how}")
    for _ in range(KILLS):
        before = whole(bench.out, summary)
        process = bench.start()
        time.sleep(bench.random.uniform(0.8, min(took, 8.0)))
        process.send_signal(how)
        said = process.communicate(timeout=60)[1].decode()
        deadline = time.monotonic() + AFTER_S
        while (left := alive(bench.mark)) and time.monotonic() < deadline:
            time.sleep(0.1)
        assert left == []
        assert whole(bench.out, summary)["format"] == before["format"]
        if how == signal.SIGINT:
            assert "Traceback" not in said
            # 0 and 3: it had ended by then; -2, which a shell shows as 130: Python had not begun, or ran text as code
            assert process.returncode in (130, -2, 0, 3)
            assert bench.leftovers() == []
    last = bench.start()
    assert last.wait(300) in (0, 3), last.stderr.read().decode()
    assert bench.leftovers() == []
    shutil.rmtree(bench.folder)


def test_the_second_of_two_commands_is_refused_in_one_sentence(tmp_path):
    bench = Bench(tmp_path, "run")
    first = bench.start()
    while not list(tmp_path.glob(".out.softdot")):
        time.sleep(0.05)
        assert first.poll() is None
    second = bench.start()
    said = second.communicate(timeout=60)[1].decode()
    assert second.returncode == 2
    assert said.startswith(f"softdot: output '{bench.out}': another softdot process is writing it")
    assert first.wait(300) == 0
    whole(bench.out, "summary.json")

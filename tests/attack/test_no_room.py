"""Twelve machines with too little room: one sentence that names what ran out, and the earlier result untouched."""

import os
import re
import resource
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pytest

from tests.cases import for_each

pytestmark = [pytest.mark.evidence, pytest.mark.skipif(sys.platform != "linux", reason="limits of Linux")]
TINY = (Path(__file__).parent / "tiny.toml").read_text("utf-8")
KB, MB = 1024, 1024**2


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    """A folder with the result of an earlier run, and the bytes of its summary."""
    folder = tmp_path_factory.mktemp("earlier")
    (folder / "tiny.toml").write_text(TINY, "utf-8")
    done = run(folder)
    assert done.returncode == 0, done.stderr
    return folder, (folder / "out" / "summary.json").read_bytes()


def run(
    folder: Path, limit=None, design="tiny.toml", within=(), **environment: str
) -> "subprocess.CompletedProcess[str]":
    """softdot run of a design, under a limit of resources, within what another command opens, with other variables."""
    own = {**os.environ, "OMP_NUM_THREADS": "1", "MKL_NUM_THREADS": "1", **environment}
    command = [*within, sys.executable, "-m", "softdot.cli", "run", "-q", design, "-o", "out"]
    preset = None if limit is None else lambda: resource.setrlimit(*limit)
    return subprocess.run(
        command, cwd=folder, env=own, capture_output=True, encoding="utf-8", timeout=300, check=False, preexec_fn=preset
    )


def sentence(done: "subprocess.CompletedProcess[str]") -> str:
    """The one sentence of softdot; libraries and warnings may say their own before."""
    assert done.returncode in (2, 3), done.stderr
    assert "Traceback" not in done.stderr
    said = [line for line in done.stderr.splitlines() if re.match("softdot: (?!warning: )", line)]
    assert len(said) == 1
    return said[0]


@for_each("size", [1 * KB, 5 * KB, 20 * KB, 60 * KB, 200 * KB], ids=lambda size: f"{size // KB} KB")
def test_a_limit_of_the_size_of_files(size, result):
    folder, before = result
    assert "a limit of the size of files" in sentence(run(folder, (resource.RLIMIT_FSIZE, (size, size))))
    assert (folder / "out" / "summary.json").read_bytes() == before
    assert not list(folder.glob(".*"))


@for_each("size", [600 * MB, 1000 * MB, 2000 * MB, 2800 * MB], ids=lambda size: f"{size // MB} MB")
def test_little_memory(size, result):
    folder, before = result
    assert "memory" in sentence(run(folder, (resource.RLIMIT_AS, (size, size))))
    assert (folder / "out" / "summary.json").read_bytes() == before
    assert not list(folder.glob(".*"))


class SmallDisk(NamedTuple):
    """place : where it is within; within : the command that goes there; seen : the same place from outside."""

    place: Path
    within: tuple[str, ...]
    seen: Path


@pytest.fixture
def small_disk(tmp_path):
    """A file system of 300 KB that only processes within a namespace of its own see, which any user may mount."""
    place = tmp_path / "disk"
    place.mkdir()
    root = os.geteuid() == 0
    new = ["unshare", "--mount", *([] if root else ["--user", "--map-root-user"])]
    mount = f"mount -t tmpfs -o size=300k none '{place}' && echo mounted && exec cat"
    with subprocess.Popen([*new, "sh", "-c", mount], stdin=-1, stdout=-1, encoding="utf-8") as holder:
        if holder.stdout.readline() != "mounted\n":
            pytest.skip("this machine lets none but root mount a file system: user namespaces are forbidden")
        enter = (
            "nsenter",
            f"--target={holder.pid}",
            "--mount",
            *(() if root else ("--user", "--preserve-credentials")),
        )
        yield SmallDisk(place, (*enter, "env", f"--chdir={place}"), Path(f"/proc/{holder.pid}/root{place}"))
        holder.stdin.close()


@pytest.mark.parametrize("full", ["output", "nearly full output", "TMPDIR"])
def test_a_full_disk(full, small_disk, result, tmp_path):
    folder, before = result
    if full == "TMPDIR":
        (small_disk.seen / "filler").write_bytes(bytes(290 * KB))
        (folder / "solid.toml").write_text(
            TINY.replace('"plane-strain"', '"solid"').replace('"ridge"', '"cap"'), "utf-8"
        )
        variables = {"TMPDIR": str(small_disk.place), "SOFTDOT_CACHE": str(tmp_path / "cache")}
        within = (*small_disk.within[:-1], f"--chdir={folder}")
        assert "disk is full" in sentence(run(folder, None, "solid.toml", within, **variables))
        assert (folder / "out" / "summary.json").read_bytes() == before
        return
    (small_disk.seen / "tiny.toml").write_text(TINY, "utf-8")
    if full == "nearly full output":
        (small_disk.seen / "filler").write_bytes(bytes(200 * KB))
    assert "disk is full" in sentence(run(tmp_path, within=small_disk.within))
    assert not (small_disk.seen / "out").exists()
    assert not list(small_disk.seen.glob(".*"))

"""Twelve machines with too little room: one sentence that names what ran out, and the earlier result untouched."""

import os
import re
import resource
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = [pytest.mark.slow, pytest.mark.skipif(sys.platform != "linux", reason="limits of Linux")]
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


def run(folder: Path, limit=None, **environment: str) -> "subprocess.CompletedProcess[str]":
    """softdot run of the same design, under a limit of resources and with other variables."""
    own = {**os.environ, "OMP_NUM_THREADS": "1", "MKL_NUM_THREADS": "1", **environment}
    command = [sys.executable, "-m", "softdot.cli", "run", "-q", "tiny.toml", "-o", "out"]
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


@pytest.mark.parametrize("size", [1 * KB, 5 * KB, 20 * KB, 60 * KB, 200 * KB], ids=lambda size: f"{size // KB} KB")
def test_a_limit_of_the_size_of_files(size, result):
    folder, before = result
    assert "a limit of the size of files" in sentence(run(folder, (resource.RLIMIT_FSIZE, (size, size))))
    assert (folder / "out" / "summary.json").read_bytes() == before
    assert not list(folder.glob(".*"))


@pytest.mark.parametrize("size", [600 * MB, 1000 * MB, 2000 * MB, 2800 * MB], ids=lambda size: f"{size // MB} MB")
def test_little_memory(size, result):
    folder, before = result
    assert "memory" in sentence(run(folder, (resource.RLIMIT_AS, (size, size))))
    assert (folder / "out" / "summary.json").read_bytes() == before
    assert not list(folder.glob(".*"))


@pytest.fixture
def small_disk(tmp_path):
    """A file system of 300 KB; needs root."""
    place = tmp_path / "disk"
    place.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=300k", "none", str(place)]
    done = subprocess.run(mount, check=False, capture_output=True)
    if done.returncode != 0:
        pytest.skip("a file system can be mounted by root only")
    yield place
    subprocess.run(["umount", "-l", str(place)], check=True)


@pytest.mark.parametrize("full", ["output", "nearly full output", "TMPDIR"])
def test_a_full_disk(full, small_disk, result, tmp_path):
    folder, before = result
    if full == "TMPDIR":
        (small_disk / "filler").write_bytes(bytes(290 * KB))
        (folder / "solid.toml").write_text(
            TINY.replace('"plane-strain"', '"solid"').replace('"ridge"', '"cap"'), "utf-8"
        )
        command = [sys.executable, "-m", "softdot.cli", "run", "-q", "solid.toml", "-o", "out"]
        own = {**os.environ, "TMPDIR": str(small_disk), "SOFTDOT_CACHE": str(tmp_path / "cache")}
        done = subprocess.run(
            command, cwd=folder, env=own, capture_output=True, encoding="utf-8", timeout=300, check=False
        )
        assert "disk is full" in sentence(done)
        assert (folder / "out" / "summary.json").read_bytes() == before
        return
    (small_disk / "tiny.toml").write_text(TINY, "utf-8")
    if full == "nearly full output":
        (small_disk / "filler").write_bytes(bytes(200 * KB))
    assert "disk is full" in sentence(run(small_disk))
    assert not (small_disk / "out").exists()
    assert not list(small_disk.glob(".*"))

"""Threads sleep while they wait, no more of them than cores that are free; kernels are kept where they belong."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from foundation.kernel_folder import SHARED_KERNEL_SOURCES, set_kernel_folder

ROOT = Path(__file__).parents[2]
SAID = """
import os
{first}
import softdot
import solve
import numba
print(numba.config.NUMBA_NUM_THREADS, os.environ["OMP_NUM_THREADS"])
"""


def threads(first="", **environment):
    """Of numba and OpenMP in a new process."""
    own = {name: value for name, value in os.environ.items() if not name.endswith("_NUM_THREADS")}
    command = [sys.executable, "-c", SAID.format(first=first)]
    done = subprocess.run(command, env={**own, **environment}, capture_output=True, encoding="utf-8")
    assert done.returncode == 0, done.stderr
    return done.stdout.split()


@pytest.mark.skipif(not hasattr(os, "sched_setaffinity"), reason="this system has no affinity of processes")
def test_a_process_on_one_core_has_one_thread():
    core = min(os.sched_getaffinity(0))
    assert threads(f"os.sched_setaffinity(0, {{{core}}})") == ["1", "1"]


def test_what_the_user_sets_stays_and_numba_follows_it():
    assert threads(OMP_NUM_THREADS="1") == ["1", "1"]
    assert threads(OMP_NUM_THREADS="1", NUMBA_NUM_THREADS="2") == ["2", "1"]


def test_dense_products_are_done_by_one_thread_unless_the_user_says_otherwise():
    said = "import softdot, os; print(os.environ['OPENBLAS_NUM_THREADS'])"
    own = {name: value for name, value in os.environ.items() if not name.endswith("_NUM_THREADS")}
    for stated, found in (({}, "1"), ({"OPENBLAS_NUM_THREADS": "2"}, "2")):
        done = subprocess.run([sys.executable, "-c", said], env=own | stated, capture_output=True, encoding="utf-8")
        assert done.stdout.strip() == found


@pytest.mark.process
def test_a_pool_that_waits_takes_no_time():
    """All three pools work, then wait: hardly any of 0.2 s of waiting is spent on a core."""
    code = """
import softdot, solve, os, time
import numpy as np
from numba import njit, prange
from pypardiso import spsolve
from scipy.sparse import eye_array

@njit(parallel=True)
def total(values):
    result = 0.0
    for n in prange(len(values)):
        result += values[n]
    return result

def work():
    a = np.ones((400, 400))
    total((a @ a).ravel())
    spsolve(eye_array(2000, format="csr") * 2.0, np.ones(2000))

work()
spent = 0.0
for _ in range(5):
    work()
    before = sum(os.times()[:2])
    time.sleep(0.04)
    spent += sum(os.times()[:2]) - before
print(spent)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, encoding="utf-8", env=free())
    assert done.returncode == 0, done.stderr
    assert float(done.stdout) <= 0.05


def free():
    """Two threads whatever these tests run with."""
    own = {name: value for name, value in os.environ.items() if not name.endswith("_NUM_THREADS")}
    return own | {"OMP_NUM_THREADS": "2", "OPENBLAS_NUM_THREADS": "2"}


@pytest.mark.parametrize("place", ["lib/python3.11/site-packages", "src/softdot"])
def test_kernels_are_kept_where_pip_leaves_nothing_behind_and_what_the_user_set_stays(place, monkeypatch):
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    set_kernel_folder(Path(place) / "foundation")
    assert Path(os.environ["NUMBA_CACHE_DIR"]).is_relative_to(place) == ("site-packages" not in place)
    monkeypatch.setenv("NUMBA_CACHE_DIR", "mine")
    set_kernel_folder(Path(place) / "foundation")
    assert os.environ["NUMBA_CACHE_DIR"] == "mine"


@pytest.mark.parametrize(
    "name", ["solve/compiled.py", "solve/fem/stiffness_blocks.py", "solve/materials/invariants.py"]
)
def test_kernels_are_compiled_anew_when_a_piece_of_them_changes(name, tmp_path, monkeypatch):
    def kept():
        monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
        set_kernel_folder(tmp_path / "foundation")
        return os.environ["NUMBA_CACHE_DIR"]

    piece = tmp_path / name
    piece.parent.mkdir(parents=True)
    piece.write_text("half = 0.5", "utf-8")
    first = kept()
    assert first == kept()
    piece.write_text("half = 0.4", "utf-8")
    assert first != kept()


def test_every_piece_that_another_file_calls_is_among_those_that_name_the_folder():
    """Files from which a file with kernels takes compiled functions."""
    kernels = "@nb.njit", "@in_threads", "@piece", "@register_jitable"
    sources = {
        file: file.read_text("utf-8")
        for top in ("solve", "diagnose", "softdot")
        for file in ROOT.glob(f"{top}/**/*.py")
    }
    compiled = {file.relative_to(ROOT) for file, text in sources.items() if any(mark in text for mark in kernels)}
    taken = {
        Path(*module.split(".")).with_suffix(".py")
        for file in compiled
        for module in re.findall(r"^from ([\w.]+) import", (ROOT / file).read_text("utf-8"), re.MULTILINE)
    }
    named = {file.relative_to(ROOT) for place in SHARED_KERNEL_SOURCES for file in ROOT.glob(place)}
    assert taken & compiled <= named

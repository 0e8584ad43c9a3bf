"""A real interrupt of a real process, by Ctrl-C or by a system that shuts down."""

import signal
import subprocess
import sys
import time

import pytest

from tests.softdot.interrupts import heard

SLOW_RUN = """
import sys, time
from pathlib import Path
from softdot.case import Case
from softdot import run_folder
Case.checked_design = property(lambda self: (None, []))
def slow(case, folder, progress, *others):
    progress.stage("mesh")
    (folder / "half").write_text("half")
    Path("begun").touch()
    time.sleep(60)
run_folder._fill_folder = slow
from softdot.cli import main
sys.exit(main(["run", "-o", "out"]))
"""


@pytest.mark.process
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupted_process_exits_130_and_leaves_nothing(tmp_path, number):
    process = subprocess.Popen(
        [sys.executable, "-c", SLOW_RUN], cwd=tmp_path, stderr=subprocess.PIPE, encoding="utf-8", env=_environment(),
        preexec_fn=heard,
    )  # fmt: skip
    while not (tmp_path / "begun").exists():
        assert process.poll() is None, process.stderr.read()
        time.sleep(0.02)
    process.send_signal(number)
    _, complaint = process.communicate(timeout=20)
    assert process.returncode == 130
    assert complaint.endswith("\nsoftdot: interrupted, nothing was written\n")
    assert [path.name for path in tmp_path.iterdir()] == ["begun"]


INTERRUPTED_IMPORT = """
import os, signal
from pathlib import Path
os.kill(os.getpid(), signal.SIGINT)
for _ in range(1000):
    pass
Path("imported").touch()
def command(chosen):
    import time
    time.sleep(60)
"""


def test_an_import_is_finished_before_ctrl_c_is_answered(tmp_path):
    """VTK crashes where one of its libraries cannot be imported by another."""
    (tmp_path / "interrupted_import.py").write_text(INTERRUPTED_IMPORT, "utf-8")
    program = (
        "import sys; from softdot import cli; cli.import_module = lambda _: __import__('interrupted_import');"
        "sys.exit(cli.main(['run', '-o', 'out']))"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=tmp_path, env=_environment(), capture_output=True, encoding="utf-8",
        timeout=20, preexec_fn=heard, check=False,
    )  # fmt: skip
    assert (done.returncode, done.stderr) == (130, "softdot: interrupted, nothing was written\n")
    assert (tmp_path / "imported").exists()


def _environment():
    import os

    return {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}

"""Children end with a parent that is killed, also where it is killed while they are still starting."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

pytestmark = pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="needs /proc")
CHILD = """
import sys, time
{wait}
from foundation.child_processes import end_with_parent
end_with_parent(int(sys.argv[1]))
open(sys.argv[2], "w").close()
time.sleep(60)
"""
PARENT = """
import os, subprocess, sys, time
command = [sys.executable, "-c", sys.argv[1], str(os.getpid()), sys.argv[2]]
child = subprocess.Popen(command, stdout=subprocess.DEVNULL, start_new_session=True)
print(child.pid, flush=True)
time.sleep(60)
"""


def running(number: int) -> bool:
    try:
        return Path(f"/proc/{number}/stat").read_text(encoding="utf-8").rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


@pytest.mark.parametrize("starting", [True, False])
def test_a_child_ends_with_a_parent_that_is_killed(starting, tmp_path):
    """starting : the parent is gone before the child has said whose child it is."""
    begun = tmp_path / "begun"
    code = CHILD.format(wait="time.sleep(0.5)" if starting else "pass")
    own = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    command = [sys.executable, "-c", PARENT, code, str(begun)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, encoding="utf-8", env=own) as parent:
        child = int(parent.stdout.readline())
        while not starting and not begun.exists() and running(child):
            time.sleep(0.02)
        parent.kill()
    deadline = time.monotonic() + 10.0
    while running(child) and time.monotonic() < deadline:
        time.sleep(0.05)
    left = running(child)
    if left:
        os.kill(child, signal.SIGKILL)
    assert not left
    assert begun.exists() != starting

"""A real ParaView opens what we write."""

import os
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from export.vtu import write_results
from geometry.dot import DotShape
from mesh.types import TetMesh
from solve.result import PressResult

NEEDED = ["pvpython"] if os.environ.get("DISPLAY") else ["pvpython", "Xvfb"]
MISSING = [tool for tool in NEEDED if shutil.which(tool) is None]


@pytest.fixture
def display() -> Iterator[str]:
    """A display: Debian's ParaView draws through X only. The server tells its number once it is ready."""
    if "Xvfb" not in NEEDED:
        yield os.environ["DISPLAY"]
        return
    read, write = os.pipe()
    command = ["Xvfb", "-displayfd", str(write), "-noreset", "-screen", "0", "1024x768x24"]
    server = subprocess.Popen(command, pass_fds=[write], stderr=subprocess.DEVNULL)
    os.close(write)
    with os.fdopen(read) as number:
        yield f":{number.readline().strip()}"
    server.terminate()
    server.wait()


def pvpython(display: str, script: Path, *arguments: Path) -> "subprocess.CompletedProcess[str]":
    """A script run by ParaView's Python."""
    return subprocess.run(
        ["pvpython", "--force-offscreen-rendering", script, *arguments],
        capture_output=True, encoding="utf-8", timeout=240, check=False, env={**os.environ, "DISPLAY": display},
    )  # fmt: skip


@pytest.mark.press
@pytest.mark.skipif(bool(MISSING), reason=f"not installed: {', '.join(MISSING)}")
def test_paraview_opens_times_fields_and_draws(
    segment: TetMesh, press: PressResult, dot: DotShape, tmp_path: Path, display: str
) -> None:
    write_results(segment, press, dot, tmp_path / "results")
    script, picture = Path(__file__).with_name("paraview_check.py"), tmp_path / "paraview.png"
    run = pvpython(display, script, tmp_path / "results", picture)
    assert run.returncode == 0, run.stderr
    assert "opened 4" in run.stdout
    assert np.asarray(Image.open(picture).convert("L")).std() > 10


@pytest.mark.press
@pytest.mark.skipif(bool(MISSING), reason=f"needs Debian's {' and '.join(MISSING)}")
def test_the_script_beside_the_results_draws_them(
    segment: TetMesh, press: PressResult, dot: DotShape, tmp_path: Path, display: str
) -> None:
    write_results(segment, press, dot, tmp_path / "results")
    run = pvpython(display, tmp_path / "results" / "show_in_paraview.py")
    assert run.returncode == 0, run.stderr
    picture = np.asarray(Image.open(tmp_path / "results" / "paraview.png").convert("RGB")).astype(float)
    assert (np.ptp(picture, axis=2) > 60).mean() > 0.03  # coloured, not blank

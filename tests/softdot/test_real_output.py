"""One real run, read back by the programs that its files are written for."""

import os
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import trimesh
from PIL import Image

from geometry.assembly import build_parts
from geometry.dot_at_rest import resolve_dot
from mesh.options import MeshOptions
from softdot import run_config
from softdot.config.loading import load_config
from softdot.config.schema import Config
from solve.model import Press

DEPTH_MM, LOAD_STEPS = 0.2, 2
SCRIPT = Path(__file__).with_name("paraview_real_output.py")
NEEDED = ["pvpython"] if os.environ.get("DISPLAY") else ["pvpython", "Xvfb"]
MISSING = [tool for tool in NEEDED if shutil.which(tool) is None]
SLICER = shutil.which("prusa-slicer")

pytestmark = pytest.mark.process


def coarse_default() -> Config:
    """What `softdot run` does without a configuration, on a coarse mesh and not so deep."""
    mesh_options = MeshOptions(element_size_mm=0.9, contact_element_size_mm=0.3, mesher="layered")
    press = Press(indentation_mm=DEPTH_MM, load_steps=LOAD_STEPS)
    return load_config().model_copy(update={"mesh": mesh_options, "press": press})


@pytest.fixture(scope="module")
def out(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("real") / "out"
    assert run_config(coarse_default(), folder)["solver"]["converged"]
    return folder


@pytest.fixture(scope="module")
def parts():
    config = coarse_default()
    return build_parts(config.segment, resolve_dot(config.dot, config.segment))


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


@pytest.mark.skipif(bool(MISSING), reason=f"not installed: {', '.join(MISSING)}")
def test_paraview_finds_steps_and_fields_and_draws_the_press(out: Path, tmp_path: Path, display: str) -> None:
    """The script checks what ParaView reads; here the picture shows a segment of several colours."""
    picture = tmp_path / "paraview.png"
    run = subprocess.run(
        ["pvpython", "--force-offscreen-rendering", SCRIPT, out / "results", picture, str(DEPTH_MM), str(LOAD_STEPS)],
        capture_output=True, encoding="utf-8", timeout=240, check=False, env={**os.environ, "DISPLAY": display},
    )  # fmt: skip
    assert run.returncode == 0, run.stderr
    assert "all as expected" in run.stdout
    assert np.asarray(Image.open(picture).convert("L")).std() > 10


def test_step_file_has_every_part_with_its_volume(out: Path, parts) -> None:
    from build123d import import_step

    found = {child.label: child.volume for child in import_step(out / "cad" / "segment.step").children}
    assert found == pytest.approx({part.label: part.volume_mm3 for part in parts}, rel=1e-6)


def test_layers_have_the_volume_of_their_box(out: Path) -> None:
    """Length times width times thickness, from the STL files."""
    heights = {"effector": 1.0, "medium1": 0.5, "film": 0.028, "medium2": 2.0}
    found = {name: trimesh.load(out / "cad" / f"{name}.stl").volume for name in heights}
    assert found == pytest.approx({name: 2.5 * 2.5 * height for name, height in heights.items()}, rel=1e-5)


def test_every_stl_is_a_volume(out: Path, parts) -> None:
    surfaces = {path.stem: trimesh.load(path) for path in (out / "cad").glob("*.stl")}
    assert set(surfaces) == {part.label for part in parts}
    assert [name for name, surface in surfaces.items() if not surface.is_volume] == []


@pytest.mark.skipif(SLICER is None, reason="PrusaSlicer is not installed")
def test_slicer_finds_every_printable_part_and_the_3mf_manifold(out: Path, parts) -> None:
    printable = [part.label for part in parts if part.printable]
    assert "dot" in printable
    for name in printable:
        assert manifold_answers(out / "cad" / f"{name}.stl") == ["yes"], name
    assert manifold_answers(out / "cad" / "segment.3mf") == ["yes"] * len(parts)


def manifold_answers(path: Path) -> list[str]:
    """PrusaSlicer's word on each object of a file."""
    command = ["prusa-slicer", "--info", path]
    done = subprocess.run(command, capture_output=True, encoding="utf-8", timeout=120, check=True)
    lines = [line.split(" = ") for line in done.stdout.splitlines()]
    return [line[1].strip() for line in lines if line[0].strip() == "manifold"]

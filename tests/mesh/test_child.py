"""The child process around pytetwild never outlives its parent's call."""

import os
import time
from pathlib import Path

import numpy as np
import pytest
from mesh_samples import dot, options, segment

import mesh
from foundation.worker_process import WorkerProcess
from mesh import tetwild_process as child
from mesh.types import MeshingError


def children() -> set[int]:
    """Process numbers of the running children of this process."""
    found = set()
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = stat.read_text(encoding="utf-8").rsplit(")", 1)[1].split()
        except OSError:
            continue
        if int(fields[1]) == os.getpid() and fields[0] != "Z":
            found.add(int(stat.parent.name))
    return found


linux = pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="needs /proc")


@linux
def test_timeout_is_one_sentence_and_leaves_no_process(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("SOFTDOT_CACHE", str(tmp_path))
    before = children()
    of = segment()
    with pytest.raises(MeshingError, match=r"mesh\.timeout_s = 0\.4 s: raise it, coarsen") as caught:
        mesh.build(of, dot(of), options("pytetwild", contact_element_size_mm=0.03, timeout_s=0.4))
    assert "\n" not in str(caught.value)
    assert children() == before
    assert not list(tmp_path.iterdir())


def exits_with(status: int) -> None:
    print("a")
    print("no room", flush=True)
    os._exit(status)


def dies_by(number: int) -> None:
    os.kill(os.getpid(), number)


def is_no_surface() -> None:
    print("chatter", flush=True)
    raise ValueError("no surface")


@linux
def test_interrupt_kills_the_child(monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    before = children()
    monkeypatch.setattr(WorkerProcess, "call", interrupted)
    with pytest.raises(KeyboardInterrupt):
        child._call_mesher(30.0, time.sleep, 60.0)
    assert children() == before


@linux
@pytest.mark.parametrize(
    ("function", "argument", "said"),
    [(exits_with, (3,), "failed with exit code 3: no room"), (dies_by, (9,), "ended by signal 9, as a system does"),
     (is_no_surface, (), "failed: ValueError: no surface")],
)  # fmt: skip
def test_a_failing_child_is_one_sentence_and_shows_nothing(function, argument, said, capfd) -> None:
    with pytest.raises(MeshingError, match=said):
        child._call_mesher(30.0, function, *argument)
    shown = capfd.readouterr()
    assert shown.out + shown.err == ""


@pytest.mark.press
def test_a_cube_is_filled() -> None:
    corners = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    points, tets = child.tetrahedralize(
        60.0,
        vertices=corners,
        faces=faces,
        bg_vertices=10.0 * np.vstack([np.zeros(3), np.eye(3)]) - 2.0,
        bg_tets=np.array([[0, 1, 2, 3]]),
        bg_values=np.full(4, 0.5),
        edge_length=0.5,
        epsilon=1e-3,
        stop_energy=10.0,
        coarsen=False,
    )
    middle = points[tets].mean(axis=1)
    inside = ((middle > 0) & (middle < 1)).all(axis=1)
    corner = points[tets[inside]]
    assert np.abs(np.linalg.det(corner[:, 1:] - corner[:, :1])).sum() / 6 == pytest.approx(1.0, rel=0.02)

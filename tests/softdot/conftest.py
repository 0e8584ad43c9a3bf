"""A pipeline whose stages are replaced by quick stand-ins, and a way to call the command line."""

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import pytest

from geometry import assembly
from softdot import run_folder, second_process
from softdot.case import Case
from softdot.commands import run
from softdot.tolerances import uncertainty
from tests.softdot.stand_ins import AtOnce, cap_of_height, one_tetrahedron, result_of

MINIMAL = """
[segment.medium1]
thickness_mm = 0.5
[segment.film]
thickness_um = 28.0
[segment.medium2]
thickness_mm = 2.0
"""


@pytest.fixture
def write_config(tmp_path: Path) -> Callable[[str], Path]:
    """Write a configuration file: the needed thicknesses, then more text."""

    def write(more: str, base: str = MINIMAL) -> Path:
        path = tmp_path / "segment.toml"
        path.write_text(base + more, "utf-8")
        return path

    return write


@pytest.fixture
def stages(monkeypatch: pytest.MonkeyPatch) -> SimpleNamespace:
    """Stand-ins for all stages; tests set .solve or .mesh to what they need."""

    def file_writer(name: str) -> Callable[..., list[Path]]:
        def write(*args: object, **_: object) -> list[Path]:
            folder = next(arg for arg in args if isinstance(arg, Path))
            folder.mkdir(exist_ok=True)
            (folder / name).write_text("stand-in", "utf-8")
            return [folder / name]

        return write

    def written(*args: object) -> None:
        folder = next(arg for arg in args if isinstance(arg, Path))
        file_writer("segment.pvd")(folder / "results")
        file_writer("force.png")(folder / "pictures")
        (folder / "report.html").write_text("stand-in", "utf-8")

    fakes = SimpleNamespace(
        checked_design=lambda *_: (cap_of_height(0.5), []),
        parts=lambda *_: [],
        write_cad=file_writer("segment.step"),
        mesh=lambda *_: one_tetrahedron(),
        mesh_quality=lambda case: {"tetrahedra": len(case.mesh.tets), "symmetry_planes": []},
        solve=lambda *_: result_of([0.0, 0.15, 0.3]),
        uncertainty=lambda *_: {},
        write_outputs=written,
    )

    def called(name: str) -> Callable[..., object]:
        return lambda *args, **_: getattr(fakes, name)(*args)  # looked up each time: a test can exchange one

    monkeypatch.setattr(assembly, "build_parts", called("parts"))
    for name in ("checked_design", "mesh", "mesh_quality"):
        monkeypatch.setattr(Case, name, property(called(name)))
    monkeypatch.setattr(Case, "solve", called("solve"))
    monkeypatch.setattr(second_process, "write_cad", called("write_cad"))
    monkeypatch.setattr(run_folder, "write_outputs", called("write_outputs"))
    for module in (run_folder, run):
        monkeypatch.setattr(module, "SecondProcess", AtOnce)
    monkeypatch.setattr(run_folder, "draw", lambda *_: {})
    monkeypatch.setattr(uncertainty, "fill_cache", lambda _: None)
    monkeypatch.setattr(uncertainty, "uncertainty", called("uncertainty"))
    return fakes

"""A pipeline whose rooms are replaced by quick stand-ins, and a way to call the command line."""

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import pytest

from softdot import stages
from tests.softdot.stand_ins import cap_of_height, one_tetrahedron, result_of

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
def rooms(monkeypatch: pytest.MonkeyPatch) -> SimpleNamespace:
    """Stand-ins for all rooms; tests set .press or .build_mesh to what they need."""

    def file_writer(name: str) -> Callable[..., list[Path]]:
        def write(*args: object, **_: object) -> list[Path]:
            folder = next(arg for arg in args if isinstance(arg, Path))
            folder.mkdir(exist_ok=True)
            (folder / name).write_text("stand-in")
            return [folder / name]

        return write

    fakes = SimpleNamespace(
        check=lambda *_: (cap_of_height(0.5), []),
        build_parts=lambda *_: [],
        write_cad=file_writer("segment.step"),
        build_mesh=lambda *_: one_tetrahedron(),
        mesh_quality=lambda *_: {"tetrahedra": 1},
        press=lambda *_: result_of([0.0, 0.15, 0.3]),
        readout_voltage=lambda *_: None,
        uncertainty=lambda *_: {},
        write_results=file_writer("segment.pvd"),
        write_pictures=file_writer("force.png"),
        write_report=lambda *args: args[-1].write_text("stand-in"),
    )
    for name in vars(fakes):
        # looked up at each call, so that a test can exchange one
        monkeypatch.setattr(stages, name, lambda *args, _name=name: getattr(fakes, _name)(*args), raising=False)
    return fakes

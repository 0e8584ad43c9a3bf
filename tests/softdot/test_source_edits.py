"""What softdot keeps on disk is made anew when the source that it depends on is edited, and only then."""

import ast
import shutil
from pathlib import Path

import pytest

from foundation import source_hash as hashes
from mesh.build import mesh_key as mesh_key
from mesh.options import MeshOptions
from softdot.case import Case
from softdot.outcome import outcome_key
from softdot.prepared_press import press_key
from tests.cases import for_each

PROGRAM = hashes.PROGRAM_FOLDER
PACKAGES = ("foundation", "geometry", "mesh", "solve", "export", "diagnose", "softdot")


@pytest.fixture(scope="module")
def copied(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the program, to be edited."""
    folder = tmp_path_factory.mktemp("program")
    for name in PACKAGES:
        shutil.copytree(PROGRAM / name, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
    return folder


@pytest.fixture
def kept(copied: Path, monkeypatch: pytest.MonkeyPatch):
    """The names under which a mesh, a press and an outcome are kept, as the copied program now stands."""
    monkeypatch.setattr(hashes, "PROGRAM_FOLDER", copied)
    case = Case(segment={"section": "plane-strain"}, mesh={"mesher": "layered", "element_size_mm": 1.0})
    tet_mesh = case.mesh

    def names() -> dict[str, str]:
        forget()
        return {
            "mesh": mesh_key(case.model.segment, case.dot, MeshOptions()),
            "press": press_key(case, tet_mesh),
            "outcome": outcome_key(case.config),
        }

    yield names
    forget()


def forget() -> None:
    """What a process has read of its own sources, which do not change while it runs."""
    hashes.source_hash.cache_clear()
    hashes._source_and_imports.cache_clear()


@pytest.mark.process
@for_each(
    ("edited", "made_anew"),
    [
        ("geometry/stack.py", {"mesh", "press", "outcome"}),
        ("mesh/tetwild.py", {"mesh", "press", "outcome"}),
        ("solve/terms/contact.py", {"press", "outcome"}),
        ("solve/mechanisms/boundaries/friction.py", {"press", "outcome"}),
        ("solve/mechanisms/circuit/saturation.py", {"press", "outcome"}),
        ("solve/materials/library.toml", {"press", "outcome"}),
        ("softdot/checks.py", {"outcome"}),
        ("softdot/tolerances/uncertainty.py", {"outcome"}),
        ("softdot/studies/proof/trial.py", set()),
    ],
)
def test_an_edited_source_makes_anew_what_depends_on_it(edited, made_anew, copied, kept):
    path, before = copied / edited, kept()
    text = path.read_text("utf-8")
    path.write_text(text + "\n# edited\n", "utf-8")
    after = kept()
    path.write_text(text, "utf-8")
    assert {name for name in before if after[name] != before[name]} == made_anew
    assert kept() == before


@pytest.mark.process
def test_no_import_of_this_program_is_overlooked():
    """Against Python's own syntax tree, for every module."""
    for path in (path for package in PACKAGES for path in (PROGRAM / package).rglob("*.py")):
        source = path.read_text("utf-8")
        nodes = [node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.ImportFrom) and node.module]
        meant = {node.module for node in nodes} | {f"{node.module}.{one.name}" for node in nodes for one in node.names}
        assert meant <= hashes.imported_names(source), path


def test_a_package_that_is_newer_than_the_installation_counts(tmp_path):
    """Of a working copy; where other distributions lie beside it, only its own packages count."""
    for name in ("foundation", "numpy"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "py.typed").touch()
    assert "numpy" not in hashes._package_names(tmp_path)
    (tmp_path / "pyproject.toml").touch()
    assert set(hashes._package_names(tmp_path)) == {"foundation", "numpy"}

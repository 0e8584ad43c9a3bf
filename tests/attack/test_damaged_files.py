"""What softdot keeps on disk, damaged a thousand times: no exception escapes, and nothing damaged is believed."""

import logging
from pathlib import Path

import numpy as np
import pytest

from foundation.cache import recall, remember
from mesh.build import cached_mesh
from mesh.types import LinearMesh
from softdot.config.loading import config_from
from softdot.sweeps import folder as sweep_folder
from solve.solution.checkpoint import read_archive, write_archive

DAMAGED = 1000
LAYERS = {"medium1": {"thickness_mm": 0.5}, "film": {"thickness_um": 28}, "medium2": {"thickness_mm": 2}}
CONFIG = config_from({"segment": LAYERS})


def a_mesh() -> LinearMesh:
    """Twenty tetrahedra at random places."""
    random = np.random.default_rng(1)
    return LinearMesh(random.random((40, 3)), random.integers(0, 40, (20, 4)), np.zeros(20, int), ("medium2",))


def mesh_answer() -> object:
    """The mesh as plain data; None where it was made anew."""
    anew = []

    def make() -> LinearMesh:
        anew.append(1)
        return a_mesh()

    found = cached_mesh("attack", make)
    return None if anew else (found.points_mm.tolist(), found.tets.tolist(), found.region_names)


def archive_answer(folder: Path) -> object:
    found = read_archive(folder / "archive.npz", {})
    return None if found is None else (found[0], found[1].tolist())


KINDS = {
    "mesh": (lambda _: mesh_answer(), lambda _: mesh_answer()),
    "outcome": (
        lambda _: remember("outcome-1", {"reaction_force_N": [0.0, 1.206], "solver": {"converged": True}}),
        lambda _: recall("outcome-1"),
    ),
    "checkpoint": (
        lambda folder: write_archive(folder / "archive.npz", ["key", np.arange(50.0)]),
        archive_answer,
    ),
    "point": (
        lambda folder: (
            (folder / "points").mkdir(exist_ok=True),
            sweep_folder.store_record(folder, CONFIG, {"status": "solved"}),
        ),
        lambda folder: sweep_folder.stored_record(folder, CONFIG),
    ),
}


def damage(content: bytes, random: np.random.Generator) -> bytes:
    """One bit flipped, one byte changed, the end cut off, a part doubled, or another content altogether."""
    at, bad = int(random.integers(len(content))), bytearray(content)
    match random.integers(5):
        case 0:
            bad[at] ^= 1 << int(random.integers(8))
        case 1:
            bad[at] = (bad[at] + int(random.integers(1, 256))) % 256
        case 2:
            return content[:at]
        case 3:
            return content[:at] + content[at // 2 :]
        case _:
            return (b"{}", b"", b"null", b"[" * 5000, b"PK\x05\x06" + bytes(18))[int(random.integers(5))]
    return bytes(bad)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """An empty cache and output folder."""
    monkeypatch.setenv("SOFTDOT_CACHE", str(tmp_path))
    return tmp_path


def the_file(folder: Path) -> Path:
    (file,) = [path for path in folder.rglob("*") if path.is_file()]
    return file


@pytest.mark.press
@pytest.mark.parametrize("kind", KINDS)
def test_damage_is_noticed_and_told_once(kind, folder, caplog):
    write, read = KINDS[kind]
    write(folder)
    file = the_file(folder)
    good, truth = file.read_bytes(), read(folder)
    assert truth is not None
    random = np.random.default_rng(2026)
    for _ in range(DAMAGED // len(KINDS)):
        bad = damage(good, random)
        file.write_bytes(bad)
        with caplog.at_level(logging.WARNING, logger="softdot"):
            caplog.clear()
            found = read(folder)
        if found is None:
            assert len(caplog.records) == 1
            assert not file.exists() or kind == "mesh"  # a mesh was made anew at once
        else:  # white space of a JSON file may change and nothing else
            assert found == truth
        file.write_bytes(good)
        assert read(folder) == truth


@pytest.mark.parametrize("name", ["a file", "below a file"])
def test_a_cache_folder_that_cannot_be_one_is_refused_before_any_work(name, tmp_path, monkeypatch, capfd):
    from softdot.cli import main

    (tmp_path / "file").write_text("", "utf-8")
    place = tmp_path / "file" if name == "a file" else tmp_path / "file" / "cache"
    monkeypatch.setenv("SOFTDOT_CACHE", str(place))
    assert main(["run", "-o", str(tmp_path / "out")]) == 2
    said = capfd.readouterr().err
    assert said.startswith(f"softdot: SOFTDOT_CACHE = '{place}': cannot be used as the folder of the cache")
    assert said.count("\n") == 1
    assert not (tmp_path / "out").exists()

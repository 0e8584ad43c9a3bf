"""The cache of meshes: what hits, what misses, what damage does."""

from pathlib import Path

import numpy as np
import pytest
from mesh_samples import dot, options, segment

from geometry.parameters import Medium
from mesh.build import cached_mesh, mesh_key
from mesh.types import LinearMesh
from tests.cases import for_each

ONE = LinearMesh(np.vstack([np.zeros(3), np.eye(3)]), np.array([[0, 1, 2, 3]]), np.array([0]), ("medium2",))


@pytest.fixture
def store(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    monkeypatch.setenv("SOFTDOT_CACHE", str(tmp_path / "deep" / "cache"))
    return tmp_path / "deep" / "cache"


def never() -> LinearMesh:
    raise AssertionError("made again")


def test_a_mesh_is_made_once(store: Path) -> None:
    cached_mesh("abc", lambda: ONE)
    again = cached_mesh("abc", never)
    np.testing.assert_array_equal(again.points_mm, ONE.points_mm)
    np.testing.assert_array_equal(again.tets, ONE.tets)
    assert again.region_names == ("medium2",)
    assert [p.name for p in store.iterdir()] == ["mesh-abc.npz"]


@pytest.mark.usefixtures("store")
def test_of_two_that_mesh_at_once_both_go_on_with_the_first() -> None:
    """A mesher may make another mesh at each call, and two presses on two meshes would differ by more than a slope."""
    other = LinearMesh(2.0 * ONE.points_mm, ONE.tets, ONE.region, ONE.region_names)

    def slower() -> LinearMesh:
        cached_mesh("abc", lambda: ONE)
        return other

    np.testing.assert_array_equal(cached_mesh("abc", slower).points_mm, ONE.points_mm)
    np.testing.assert_array_equal(cached_mesh("abc", never).points_mm, ONE.points_mm)


@for_each("damage", [b"", b"not a mesh", None])
def test_a_damaged_file_is_a_miss_and_is_replaced(store: Path, damage: bytes | None) -> None:
    cached_mesh("abc", lambda: ONE)
    file = store / "mesh-abc.npz"
    file.write_bytes(file.read_bytes()[:-200] if damage is None else damage)
    assert cached_mesh("abc", lambda: ONE) is ONE
    cached_mesh("abc", never)


@pytest.mark.usefixtures("store")
def test_node_numbers_out_of_range_are_a_miss() -> None:
    wrong = LinearMesh(ONE.points_mm, ONE.tets + 1, ONE.region, ONE.region_names)
    cached_mesh("abc", lambda: wrong)
    assert cached_mesh("abc", lambda: ONE) is ONE


def test_an_unwritable_cache_does_no_harm(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("", "utf-8")
    monkeypatch.setenv("SOFTDOT_CACHE", str(tmp_path / "file"))
    assert cached_mesh("abc", lambda: ONE) is ONE


def test_key_follows_what_shapes_the_mesh_and_nothing_else() -> None:
    of = segment()
    name = mesh_key(of, dot(of), options("pytetwild"))
    same = of.model_copy(update={"boundary": "free", "side_stiffness_N_per_mm3": 1.0})
    assert mesh_key(same, dot(of), options("pytetwild", timeout_s=1.0)) == name
    others = [
        mesh_key(of.model_copy(update={"medium2": Medium(thickness_mm=1.6)}), dot(of), options("pytetwild")),
        mesh_key(of, dot(of, x_mm=0.1), options("pytetwild")),
        mesh_key(of, dot(of), options("pytetwild", element_size_mm=0.4)),
        mesh_key(segment("dome"), dot(of), options("pytetwild")),
    ]
    assert len({name, *others}) == 5

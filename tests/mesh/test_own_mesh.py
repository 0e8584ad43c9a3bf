"""A user's own mesh: what is taken from the file and what is made."""

from pathlib import Path

import numpy as np
import pytest
from mesh_samples import built, dot, segment_of
from own_files import gmsh_22, linear, written

import mesh
from foundation.errors import InputError
from mesh.files.formats import REGION_NUMBERS, write_mesh
from mesh.files.user_mesh import file_contents, user_mesh
from mesh.options import MeshOptions
from mesh.quality import measure_quality

BLOCK, SLICE = "block solid layered", "block plane-strain layered"


@pytest.mark.press
@pytest.mark.parametrize("name", ["cylinder solid layered", BLOCK, SLICE])
def test_four_node_tetrahedra_become_the_mesh_that_the_mesher_makes_of_them(name: str, tmp_path: Path) -> None:
    """Names in capitals, as Abaqus writes them; mid-side nodes on the round skin."""
    of = built(name)
    found = user_mesh(linear(of, tmp_path / "mine.inp", tuple(n.upper() for n in of.region_names)), segment_of(name))
    assert np.array_equal(found.tets, of.tets)
    assert np.allclose(found.points_mm, of.points_mm, rtol=0, atol=1e-15)
    assert {key: len(facets) for key, facets in found.facets.items()} == {k: len(f) for k, f in of.facets.items()}
    quality = measure_quality(found, segment_of(name))
    assert quality.straight_edges == 0
    assert quality.inverted == 0


def test_the_order_of_nodes_and_elements_does_not_matter(tmp_path: Path) -> None:
    of, rng = built(BLOCK), np.random.default_rng(1)
    new, order = rng.permutation(len(of.points_mm) + 5), rng.permutation(len(of.tets))  # five nodes of no element
    points = np.full((len(new), 3), 77.0)
    points[new[: len(of.points_mm)]] = of.points_mm
    file = written(points, new[of.tets][order], of.region[order], of.region_names, tmp_path / "mine.inp")
    found = user_mesh(file, segment_of(BLOCK))
    assert len(found.points_mm) == len(of.points_mm)
    assert found.tets[:, :4].max() < found.tets[:, 4:].min()
    for name, facets in of.facets.items():
        assert len(found.facets[name]) == len(facets)
        assert np.allclose(found.points_mm[found.facets[name]].sum(axis=(0, 1)), of.points_mm[facets].sum(axis=(0, 1)))


def test_build_takes_the_file_and_not_the_mesher(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    linear(built(BLOCK), tmp_path / "mine.inp")
    made = mesh.build(segment_of(BLOCK), dot(segment_of(BLOCK)), MeshOptions(file="mine.inp"))
    assert np.array_equal(made.tets, built(BLOCK).tets)


def test_a_surface_that_the_file_names_counts_alone(tmp_path: Path) -> None:
    of = built(BLOCK)
    top = of.facets["contact"][of.points_mm[of.facets["contact"]][:, :, 2].min(axis=1) > 2.8]
    assert 0 < len(top) < len(of.facets["contact"])
    path = gmsh_22(of, {"contact": top, "film-top": of.facets["film-top"][:1]}, tmp_path / "mine.msh")
    found = user_mesh(path, segment_of(BLOCK))
    assert len(found.facets["contact"]) == len(top)
    assert len(found.facets["base"]) == len(of.facets["base"])
    assert len(found.facets["film-top"]) == len(of.facets["film-top"])  # regions say where the film is
    with pytest.raises(InputError, match=r"surface 'base': 1 of its 1 triangles are not faces of elements where"):
        user_mesh(gmsh_22(of, {"base": top[:1]}, tmp_path / "wrong.msh"), segment_of(BLOCK))


def test_the_content_includes_the_files_that_a_file_names(tmp_path: Path) -> None:
    write_mesh(built(SLICE), ["xdmf"], tmp_path)
    before = file_contents(str(tmp_path / "segment.xdmf"))
    (tmp_path / "segment.h5").write_bytes(b"changed")
    assert file_contents(str(tmp_path / "segment.xdmf")) != before
    (tmp_path / "main.inp").write_text("*HEADING\n*INCLUDE, INPUT=nodes.inp\n", "utf-8")
    (tmp_path / "nodes.inp").write_text("*NODE\n", "utf-8")
    assert file_contents(str(tmp_path / "main.inp")).endswith(b"*NODE\n")
    assert file_contents(str(tmp_path / "none.inp")) == b""


def test_numbers_of_parts_do_not_change() -> None:
    """Files without names, XDMF, are read by them."""
    assert REGION_NUMBERS == {"medium2": 1, "film": 2, "medium1": 3, "effector": 4}

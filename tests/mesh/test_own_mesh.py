"""A user's own mesh: what is taken from the file, what is made, and each refusal in one sentence."""

from collections.abc import Callable
from pathlib import Path

import meshio
import numpy as np
import pytest
from mesh_samples import built, dot, options, segment, segment_of

import mesh
from geometry.base import InputError
from mesh.formats import REGIONS, write_mesh
from mesh.outline import curved_surface, outline
from mesh.own import own_mesh
from mesh.own_file import contents
from mesh.quality import measure
from mesh.types import TetMesh

BLOCK, SLICE = "block solid layered", "block plane-strain layered"


def written(points: np.ndarray, tets: np.ndarray, region: np.ndarray, names: tuple[str, ...], path: Path) -> str:
    """An .inp file as another mesher may write it: element sets for the parts and no surfaces."""
    kind = {4: "tetra", 10: "tetra10"}[tets.shape[1]]
    sets = {name: [np.flatnonzero(region == number)] for number, name in enumerate(names)}
    meshio.abaqus.write(path, meshio.Mesh(points, [(kind, tets)], cell_sets=sets))
    return str(path)


def linear(of: TetMesh, path: Path, names: tuple[str, ...] | None = None) -> str:
    return written(of.points_mm, of.tets[:, :4], of.region, names or of.region_names, path)


@pytest.mark.parametrize("name", ["cylinder solid layered", BLOCK, SLICE])
def test_four_node_tetrahedra_become_the_mesh_that_the_mesher_makes_of_them(name: str, tmp_path: Path) -> None:
    """Names in capitals, as Abaqus writes them; mid-side nodes on the round skin."""
    of = built(name)
    found = own_mesh(linear(of, tmp_path / "mine.inp", tuple(n.upper() for n in of.region_names)), segment_of(name))
    assert np.array_equal(found.tets, of.tets)
    assert np.allclose(found.points_mm, of.points_mm, rtol=0, atol=1e-15)
    assert {key: len(facets) for key, facets in found.facets.items()} == {k: len(f) for k, f in of.facets.items()}
    quality = measure(found, segment_of(name))
    assert quality.straight_edges == 0
    assert quality.inverted == 0


def test_the_order_of_nodes_and_elements_does_not_matter(tmp_path: Path) -> None:
    of, rng = built(BLOCK), np.random.default_rng(1)
    new, order = rng.permutation(len(of.points_mm) + 5), rng.permutation(len(of.tets))  # five nodes of no element
    points = np.full((len(new), 3), 77.0)
    points[new[: len(of.points_mm)]] = of.points_mm
    file = written(points, new[of.tets][order], of.region[order], of.region_names, tmp_path / "mine.inp")
    found = own_mesh(file, segment_of(BLOCK))
    assert len(found.points_mm) == len(of.points_mm)
    assert found.tets[:, :4].max() < found.tets[:, 4:].min()
    for name, facets in of.facets.items():
        assert len(found.facets[name]) == len(facets)
        assert np.allclose(found.points_mm[found.facets[name]].sum(axis=(0, 1)), of.points_mm[facets].sum(axis=(0, 1)))


def test_build_takes_the_file_and_not_the_mesher(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    linear(built(BLOCK), tmp_path / "mine.inp")
    made = mesh.build(segment_of(BLOCK), dot(segment_of(BLOCK)), options("pytetwild", file="mine.inp"))
    assert np.array_equal(made.tets, built(BLOCK).tets)


def test_a_surface_that_the_file_names_counts_alone(tmp_path: Path) -> None:
    of = built(BLOCK)
    top = of.facets["contact"][of.points_mm[of.facets["contact"]][:, :, 2].min(axis=1) > 2.8]
    assert 0 < len(top) < len(of.facets["contact"])
    path = gmsh_22(of, {"contact": top, "film-top": of.facets["film-top"][:1]}, tmp_path / "mine.msh")
    found = own_mesh(path, segment_of(BLOCK))
    assert len(found.facets["contact"]) == len(top)
    assert len(found.facets["base"]) == len(of.facets["base"])
    assert len(found.facets["film-top"]) == len(of.facets["film-top"])  # regions say where the film is
    with pytest.raises(InputError, match=r"surface 'base': 1 of its 1 triangles are not faces of elements where"):
        own_mesh(gmsh_22(of, {"base": top[:1]}, tmp_path / "wrong.msh"), segment_of(BLOCK))


def gmsh_22(of: TetMesh, surfaces: dict[str, np.ndarray], path: Path) -> str:
    """The older format 2.2, whose groups meshio gives as numbers and names."""
    cells = [("tetra10", of.tets), *(("triangle6", facets) for facets in surfaces.values())]
    tags = [of.region + 1, *(np.full(len(facets), 50 + i) for i, facets in enumerate(surfaces.values()))]
    names = {name: np.array([i + 1, 3]) for i, name in enumerate(of.region_names)}
    names |= {name: np.array([50 + i, 2]) for i, name in enumerate(surfaces)}
    whole = meshio.Mesh(of.points_mm, cells, cell_data={"gmsh:physical": tags}, field_data=names)
    meshio.gmsh.write(path, whole, "2.2", binary=False)
    return str(path)


Change = Callable[[TetMesh, Path], str]


def moved(shift: tuple[float, float, float], factor: float = 1.0) -> Change:
    return lambda of, path: written(factor * of.points_mm + shift, of.tets, of.region, of.region_names, path)


def inverted(of: TetMesh, path: Path) -> str:
    tets = of.tets[:, :4].copy()
    tets[:3] = tets[:3, [0, 1, 3, 2]]
    return written(of.points_mm, tets, of.region, of.region_names, path)


def doubled(of: TetMesh, path: Path) -> str:
    """Medium 1 and effector with nodes of their own."""
    above = of.region > 1
    return written(
        np.vstack([of.points_mm, of.points_mm]),
        np.where(above[:, None], of.tets + len(of.points_mm), of.tets),
        of.region,
        of.region_names,
        path,
    )


def with_a_hole(of: TetMesh, path: Path) -> str:
    kept = np.arange(len(of.tets)) != of.region_tets("medium2")[0]
    return written(of.points_mm, of.tets[kept], of.region[kept], of.region_names, path)


def half_named(of: TetMesh, path: Path) -> str:
    region = of.region.copy()
    region[:7] = 99
    return written(of.points_mm, of.tets, region, of.region_names, path)


def twice(of: TetMesh, path: Path) -> str:
    return written(of.points_mm, np.vstack([of.tets, of.tets]), np.tile(of.region, 2), of.region_names, path)


def of_hexahedra(of: TetMesh, path: Path) -> str:
    meshio.abaqus.write(path, meshio.Mesh(of.points_mm, [("hexahedron", of.tets[:, :8])]))
    return str(path)


BAD: list[tuple[Change, str]] = [
    (lambda of, path: linear(of, path, ("medium2", "foil", "medium1", "effector")), "has no film; its parts must be"),
    (inverted, "3 of 7200 elements are inverted or flat; every element must have a positive volume"),
    (moved((0.0, 0.0, 0.5)), "medium2 reaches from 0.5 to 2 mm in z, it must as in the configuration reach from 0 to"),
    (moved((0.0, 0.0, 0.0), 1e-3), "medium2 reaches from -0.00125 to 0.00125 mm in x, it must as in the configuration"),
    (doubled, "belong to one element only; neighbouring parts must share the nodes of their interface"),
    (with_a_hole, "medium2 has a volume of"),
    (half_named, "7 of 7200 tetrahedra are not in exactly one of the parts medium2, film, medium1, effector"),
    (twice, "medium2 has a volume of 15 mm³, it must as in the configuration have 7.5 mm³"),
    (of_hexahedra, "holds hexahedron; all must be tetrahedra with 4 nodes, or all with 10"),
]


@pytest.mark.parametrize(("change", "said"), BAD)
def test_a_mesh_that_is_not_of_the_segment_is_refused(change: Change, said: str, tmp_path: Path) -> None:
    file = change(built(BLOCK), tmp_path / "mine.inp")
    with pytest.raises(InputError) as caught:
        own_mesh(file, segment_of(BLOCK))
    assert str(caught.value).startswith(f"mesh.file = '{file}': ")
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_part_that_the_segment_does_not_have_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="has effector, which the segment has not; its parts must be medium2, film, "):
        own_mesh(linear(built(BLOCK), tmp_path / "mine.inp"), segment("none"))


def test_a_bulging_skin_and_a_thick_slice_are_refused(tmp_path: Path) -> None:
    of, stack = built("cylinder solid layered"), outline(segment("cylinder"))
    surface = curved_surface(stack)
    assert surface is not None
    points = of.points_mm.copy()
    on_skin = np.flatnonzero(surface.holds(points) & (np.abs(points[:, 0]) > 0.3) & (np.abs(points[:, 1]) > 0.3))
    points[on_skin, :2] *= 1.01
    file = written(points, of.tets[:, :4], of.region, of.region_names, tmp_path / "bulge.inp")
    with pytest.raises(InputError, match="outside the round skin of the configuration"):
        own_mesh(file, segment("cylinder"))
    with pytest.raises(InputError, match="needs one layer of elements in y"):
        own_mesh(linear(built(BLOCK), tmp_path / "solid.inp"), segment("block", "plane-strain"))


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("none.msh", None, "there is no such file"),
        ("mine.vtk", "# vtk", r"must end with \.msh \(Gmsh\), \.inp \(Abaqus, CalculiX\) or \.xdmf"),
        ("mine.msh", "$MeshFormat\n9.9 0 8\n$EndMeshFormat\n", "meshio cannot read it as a mesh of this format"),
        ("mine.msh", "nonsense", "meshio cannot read it as a mesh of this format"),
        ("mine.inp", "", "meshio cannot read it|holds no solid elements"),
        ("mine.inp", "*NODE\n1, 0, 0\n*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n", "meshio cannot read it"),
        ("mine.xdmf", "<Xdmf Version='3.0'><Domain>", "meshio cannot read it as a mesh of this format"),
        ("mine.xdmf", "<html/>", "meshio cannot read it as a mesh of this format"),
    ],
)
def test_what_is_no_mesh_is_refused(name: str, text: str | None, said: str, tmp_path: Path) -> None:
    if text is not None:
        (tmp_path / name).write_text(text)
    with pytest.raises(InputError, match=rf"^mesh\.file = '.*{name}': .*({said})"):
        own_mesh(str(tmp_path / name), segment())


def test_the_content_includes_the_files_that_a_file_names(tmp_path: Path) -> None:
    write_mesh(built(SLICE), ["xdmf"], tmp_path)
    before = contents(str(tmp_path / "segment.xdmf"))
    (tmp_path / "segment.h5").write_bytes(b"changed")
    assert contents(str(tmp_path / "segment.xdmf")) != before
    (tmp_path / "main.inp").write_text("*HEADING\n*INCLUDE, INPUT=nodes.inp\n")
    (tmp_path / "nodes.inp").write_text("*NODE\n")
    assert contents(str(tmp_path / "main.inp")).endswith(b"*NODE\n")
    assert contents(str(tmp_path / "none.inp")) == b""


def test_numbers_of_parts_do_not_change() -> None:
    """Files without names, XDMF, are read by them."""
    assert REGIONS == {"medium2": 1, "film": 2, "medium1": 3, "effector": 4}

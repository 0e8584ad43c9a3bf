"""A mesh file that is not one of the configured segment is refused, each time in one sentence."""

from collections.abc import Callable
from pathlib import Path

import meshio
import numpy as np
import pytest
from mesh_samples import built, segment, segment_of
from own_files import linear, written

from foundation.errors import InputError
from mesh.files.formats import write_mesh
from mesh.files.user_mesh import user_mesh
from mesh.outline import curved_surface, stack_outline
from mesh.types import TetMesh

BLOCK, SLICE = "block solid layered", "block plane-strain layered"
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


def middles_apart(of: TetMesh, path: Path) -> str:
    """Every element has mid-side nodes of its own, at the same places."""
    own = len(of.points_mm) + np.arange(6 * len(of.tets)).reshape(-1, 6)
    points = np.vstack([of.points_mm, of.points_mm[of.tets[:, 4:]].reshape(-1, 3)])
    return written(points, np.hstack([of.tets[:, :4], own]), of.region, of.region_names, path)


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
    (inverted, "3 of {tets} elements are inverted or flat; every element must have a positive volume"),
    (moved((0.0, 0.0, 0.5)), "medium2 reaches from 0.5 to 2 mm in z, it must as in the configuration reach from 0 to"),
    (moved((0.0, 0.0, 0.0), 1e-3), "medium2 reaches from -0.00125 to 0.00125 mm in x, it must as in the configuration"),
    (doubled, "belong to one element only; neighbouring parts must share the nodes of their interface"),
    (with_a_hole, "medium2 has a volume of"),
    (half_named, "7 of {tets} tetrahedra are not in exactly one of the parts medium2, film, medium1, effector"),
    (twice, "medium2 has a volume of 15 mm³, it must as in the configuration have 7.5 mm³"),
    (of_hexahedra, "TYPE = C3D8RH is not read; all solids must be tetrahedra, C3D4 or C3D10"),
    (middles_apart, "mid-side nodes are not shared by the elements of their edge"),
]


@pytest.mark.press
@pytest.mark.parametrize(("change", "said"), BAD)
def test_a_mesh_that_is_not_of_the_segment_is_refused(change: Change, said: str, tmp_path: Path) -> None:
    file = change(built(BLOCK), tmp_path / "mine.inp")
    said = said.format(tets=len(built(BLOCK).tets))
    with pytest.raises(InputError) as caught:
        user_mesh(file, segment_of(BLOCK))
    assert str(caught.value).startswith(f"mesh.file = '{file}': ")
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)


def test_parts_of_a_slice_with_nodes_of_their_own_are_refused(tmp_path: Path) -> None:
    """All corners of a slice lie on one of its two faces, which makes none of its inner faces a side."""
    with pytest.raises(InputError, match="belong to one element only; neighbouring parts must share the nodes"):
        user_mesh(doubled(built(SLICE), tmp_path / "mine.inp"), segment_of(SLICE))


def test_a_crack_that_reaches_the_skin_is_refused(tmp_path: Path) -> None:
    """Elements on one side of a plane have nodes of their own on the top of medium 1, beside the effector."""
    of, stack = built(SLICE), stack_outline(segment_of(SLICE), slice_mm=built(SLICE).thickness_mm)
    tets, points = of.tets[:, :4], of.points_mm
    apart = (np.abs(points[:, 2] - stack.medium1_top) < 1e-9) & (points[:, 0] > stack.effector_half_x + 1e-9)
    beyond = points[tets].mean(axis=1)[:, 0] > np.median(points[apart, 0])
    own = np.where(apart[tets] & beyond[:, None], tets + len(points), tets)
    file = written(np.vstack([points] * 2), own, of.region, of.region_names, tmp_path / "mine.inp")
    with pytest.raises(InputError, match="faces inside the segment, such as one of medium1"):
        user_mesh(file, segment_of(SLICE))


def test_a_part_that_the_segment_does_not_have_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="has effector, which the segment has not; its parts must be medium2, film, "):
        user_mesh(linear(built(BLOCK), tmp_path / "mine.inp"), segment("none"))


@pytest.mark.press
def test_a_bulging_skin_and_a_thick_slice_are_refused(tmp_path: Path) -> None:
    of, stack = built("cylinder solid layered"), stack_outline(segment("cylinder"))
    surface = curved_surface(stack)
    assert surface is not None
    points = of.points_mm.copy()
    on_skin = np.flatnonzero(surface.holds(points) & (np.abs(points[:, 0]) > 0.3) & (np.abs(points[:, 1]) > 0.3))
    points[on_skin, :2] *= 1.01
    file = written(points, of.tets[:, :4], of.region, of.region_names, tmp_path / "bulge.inp")
    with pytest.raises(InputError, match="outside the round skin of the configuration"):
        user_mesh(file, segment("cylinder"))
    with pytest.raises(InputError, match="needs one layer of elements in y"):
        user_mesh(linear(built(BLOCK), tmp_path / "solid.inp"), segment("block", "plane-strain"))


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("none.msh", None, "there is no such file"),
        ("mine.vtk", "# vtk", r"must end with \.msh \(Gmsh\), \.inp \(Abaqus, CalculiX\) or \.xdmf"),
        ("mine.msh", "$MeshFormat\n9.9 0 8\n$EndMeshFormat\n", "meshio cannot read it as a mesh of this format"),
        ("mine.msh", "nonsense", "meshio cannot read it as a mesh of this format"),
        ("mine.inp", "", "holds no solid elements"),
        ("mine.inp", "*NODE\n1, 0, 0\n*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n", "has node 2, which is not there"),
        ("mine.xdmf", "<Xdmf Version='3.0'><Domain>", "meshio cannot read it as a mesh of this format"),
        ("mine.xdmf", "<html/>", "meshio cannot read it as a mesh of this format"),
    ],
)
def test_what_is_no_mesh_is_refused(name: str, text: str | None, said: str, tmp_path: Path) -> None:
    if text is not None:
        (tmp_path / name).write_text(text, "utf-8")
    with pytest.raises(InputError, match=rf"^mesh\.file = '.*{name}': .*({said})"):
        user_mesh(str(tmp_path / name), segment())


def test_a_gmsh_file_with_elements_of_no_group_says_how_to_save_it(tmp_path: Path) -> None:
    (path,) = write_mesh(built(SLICE), ["msh"], tmp_path)
    path.write_text(
        path.read_text(encoding="utf-8").replace("\n11 0 0 0 0 0 0 1 11 0\n", "\n11 0 0 0 0 0 0 0 0\n"), "utf-8"
    )
    with pytest.raises(InputError, match="elements of no physical group; save only those of physical groups"):
        user_mesh(str(path), segment_of(SLICE))

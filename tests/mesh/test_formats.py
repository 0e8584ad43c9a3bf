"""The mesh in the files of other codes, and back: nodes, parts and named surfaces are kept."""

import re
from pathlib import Path

import meshio
import numpy as np
import pytest
from mesh_samples import built, segment_of
from scipy.spatial import cKDTree

from mesh.files.formats import REGION_NUMBERS, SURFACE_NUMBERS, facet_owners, write_mesh
from mesh.files.user_mesh import user_mesh
from mesh.types import TET_FACES, TetMesh

ALL = ("msh", "inp", "xdmf")
SLICE = "block plane-strain layered"
NAMES = ("none solid layered", "cylinder solid layered", SLICE, "dome solid pytetwild")


@pytest.mark.parametrize("extension", ALL)
@pytest.mark.parametrize("name", [SLICE, *(pytest.param(n, marks=pytest.mark.press) for n in NAMES if n != SLICE)])
def test_a_file_gives_the_same_mesh_back(name: str, extension: str, tmp_path: Path) -> None:
    before = built(name)
    (path,) = write_mesh(before, [extension], tmp_path)
    after = user_mesh(str(path), segment_of(name))
    away, old = cKDTree(before.points_mm).query(after.points_mm)
    assert away.max() <= (1e-13 if extension == "inp" else 0.0)  # its numbers have 14 digits
    assert np.array_equal(np.sort(old), np.arange(len(before.points_mm)))
    assert after.region_names == before.region_names
    assert with_region(before.tets, before.region) == with_region(old[after.tets], after.region)
    assert after.facets.keys() == before.facets.keys()
    for surface, facets in before.facets.items():
        assert rows(old[after.facets[surface]]) == rows(facets)
    assert np.allclose(before.points_mm[before.twin[old]][:, [0, 2]], after.points_mm[after.twin][:, [0, 2]], 0, 1e-13)
    assert len(np.unique(after.twin)) == len(np.unique(before.twin))
    assert after.thickness_mm == pytest.approx(before.thickness_mm, rel=1e-13)


def rows(array: np.ndarray) -> set[tuple[int, ...]]:
    return {tuple(row) for row in array.tolist()}


def with_region(tets: np.ndarray, region: np.ndarray) -> set[tuple[int, ...]]:
    return rows(np.column_stack([region, tets]))


@pytest.mark.parametrize("name", NAMES)
def test_every_gmsh_group_has_its_entity_and_its_elements(name: str, tmp_path: Path) -> None:
    """Read from the text, as the format describes it, without meshio."""
    mesh = built(name)
    (path,) = write_mesh(mesh, ["msh"], tmp_path)
    part = sections(path.read_text(encoding="utf-8"))
    assert part["MeshFormat"] == ["4.1 0 8"]
    stated = {line.split()[2].strip('"'): tuple(map(int, line.split()[:2])) for line in part["PhysicalNames"][1:]}
    surfaces = {key: facets for key, facets in mesh.facets.items() if len(facets)}
    assert stated == {n: (3, REGION_NUMBERS[n]) for n in mesh.region_names} | {
        n: (2, SURFACE_NUMBERS[n]) for n in surfaces
    }
    assert list(map(int, part["Entities"][0].split())) == [0, 0, len(surfaces), len(mesh.region_names)]
    entities = [line.split() for line in part["Entities"][1:]]
    assert [(row[0], row[7:9]) for row in entities] == [(row[0], ["1", row[0]]) for row in entities]
    heads = [tuple(map(int, line.split())) for line in part["Elements"][1:] if len(line.split()) == 4]
    sizes = {REGION_NUMBERS[n]: (3, 11, len(mesh.region_tets(n))) for n in mesh.region_names}
    sizes |= {SURFACE_NUMBERS[n]: (2, 9, len(facets)) for n, facets in surfaces.items()}
    assert {tag: (dimension, kind, count) for dimension, tag, kind, count in heads} == sizes


def sections(text: str) -> dict[str, list[str]]:
    found = re.findall(r"^\$(\w+)\n(.*?)\n\$End\1$", text, re.DOTALL | re.MULTILINE)
    return {name: body.splitlines() for name, body in found}


def test_an_entity_gets_a_node_where_all_of_its_nodes_are_shared(tmp_path: Path) -> None:
    """One element whose faces are all named: the part has no node of its own."""
    points = np.vstack([np.zeros(3), np.eye(3)])
    points = np.vstack(
        [points, [(points[a] + points[b]) / 2 for a, b in ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))]]
    )
    tets = np.arange(10)[None]
    facets = {name: tets[0, TET_FACES[number]][None] for number, name in enumerate(("base", "contact", "side-film"))}
    one = TetMesh(points, tets, np.zeros(1, int), ("film",), facets, np.arange(10), 1.0)
    (path,) = write_mesh(one, ["msh"], tmp_path)
    assert set(meshio.gmsh.read(path).cell_sets) >= {"film", "base", "contact", "side-film"}
    assert sections(path.read_text(encoding="utf-8"))["Entities"][0] == "0 0 3 1"


def test_abaqus_surfaces_name_the_faces_that_look_outward(tmp_path: Path) -> None:
    mesh = built("cylinder solid layered")
    (path,) = write_mesh(mesh, ["inp"], tmp_path)
    text = path.read_text(encoding="utf-8")
    assert "*ELEMENT, TYPE=C3D10\n" in text
    numbers = re.findall(r"-?\d[\d.e+-]*", text[text.index("*NODE") : text.index("*ELEMENT")])
    assert max(map(len, numbers)) <= 20  # what Abaqus and CalculiX read
    assert "mm; with forces in N, stresses are in MPa" in text
    corners = np.array([(1, 2, 3), (1, 4, 2), (2, 4, 3), (3, 4, 1)]) - 1  # faces of C3D10 in Abaqus' manual
    for name, facets in mesh.facets.items():
        body = re.search(rf"^\*SURFACE, NAME={name}, TYPE=ELEMENT\n((?:\d+, S\d\n?)*)", text, re.MULTILINE)
        element, face = np.array([re.findall(r"\d+", line) for line in body[1].splitlines()], int).T - 1
        theirs = mesh.tets[element[:, None], corners[face]]
        assert np.array_equal(np.sort(theirs, axis=1), np.sort(facets[:, :3], axis=1))
    sets = meshio.abaqus.read(path).point_sets
    assert {name: set(nodes.tolist()) for name, nodes in sets.items()} == {
        **{name: set(facets.ravel().tolist()) for name, facets in mesh.facets.items() if len(facets)},
        "all": set(range(len(mesh.points_mm))),
    }


def test_a_facet_that_looks_inward_has_no_owner() -> None:
    mesh = built("none solid layered")
    with pytest.raises(ValueError, match="no outward face"):
        facet_owners(mesh.tets, mesh.facets["base"][:, [0, 2, 1]])


def test_xdmf_has_the_surfaces_in_a_file_of_their_own(tmp_path: Path) -> None:
    mesh = built("block plane-strain layered")
    write_mesh(mesh, ["xdmf"], tmp_path)
    found = meshio.xdmf.read(tmp_path / "segment_surfaces.xdmf")
    (number,) = found.cell_data["surface"]
    for name, facets in mesh.facets.items():
        assert np.array_equal(found.cells[0].data[number == SURFACE_NUMBERS[name]], facets)

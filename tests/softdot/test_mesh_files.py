"""softdot run writes the mesh for other codes, and takes the user's own."""

import json

import meshio
import pytest

from softdot.cli import main
from tests.softdot.complaints import complaints


@pytest.mark.usefixtures("stages")
def test_each_format_that_is_asked_for_is_written(tmp_path):
    out = tmp_path / "out"
    assert main(["run", "-o", str(out), "--mesh-format", "msh", "--mesh-format", "inp", "--mesh-format", "msh"]) == 0
    assert {path.name for path in (out / "mesh").iterdir()} == {"segment.msh", "segment.inp"}
    assert meshio.gmsh.read(out / "mesh/segment.msh").cells_dict["tetra10"].shape == (1, 10)
    assert main(["run", "-o", str(out)]) == 0  # the folder of the earlier run is softdot's own
    assert not (out / "mesh").exists()


@pytest.mark.usefixtures("stages")
def test_another_format_is_refused_with_the_ones_there_are(tmp_path, capsys):
    assert main(["run", "-o", str(tmp_path / "out"), "--mesh-format", "vtk"]) == 2
    said = capsys.readouterr().err
    assert "--mesh-format = 'vtk': there is no such format; known are inp, msh, xdmf" in said
    assert len(said.splitlines()) == 1
    assert not (tmp_path / "out").exists()


def test_an_own_mesh_that_is_missing_is_refused_before_any_work(tmp_path, capfd):
    assert main(["run", "-o", str(tmp_path / "out"), "--set", 'mesh.file="none.msh"']) == 2
    said = complaints(capfd.readouterr().err)
    assert said == "softdot: mesh.file = 'none.msh': there is no such file\n"
    assert not (tmp_path / "out").exists()


def test_check_counts_the_elements_of_an_own_mesh_and_tells_its_mistakes(tmp_path, write_config, capsys):
    config, coarse = write_config(""), ("mesher=layered", "element_size_mm=1.0", "contact_element_size_mm=1.0")
    from mesh.files.formats import write_mesh
    from softdot.case import Case

    tet_mesh = Case.load(config, [f"mesh.{setting}" for setting in coarse]).mesh
    (path,) = write_mesh(tet_mesh, ["msh"], tmp_path)
    assert main(["check", str(config), "--json", "--set", f'mesh.file="{path}"']) == 0
    assert json.loads(capsys.readouterr().out)["expected"]["tetrahedra"] == pytest.approx(len(tet_mesh.tets), rel=0.05)
    shorter = ["--set", f'mesh.file="{path}"', "--set", "segment.length_mm=2.4"]
    assert main(["check", str(config), *shorter]) == 2
    said = complaints(capsys.readouterr().err)
    assert "medium2 reaches from -1.25 to 1.25 mm in x, it must as in the configuration reach from -1.2 to 1.2" in said

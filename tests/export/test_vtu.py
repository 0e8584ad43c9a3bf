"""The ParaView files say what the solver computed, in millimetres, megapascals and picocoulombs."""

import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from pathlib import Path

import meshio
import numpy as np
import pytest
import pyvista
from pressed_box import DEPTHS_MM, HEIGHT_MM

from export.vtu import write_results
from geometry.dot import DotShape
from mesh.types import TetMesh
from solve.result import PressResult
from tests.cases import for_each


@pytest.fixture(scope="module")
def results(segment: TetMesh, press: PressResult, dot: DotShape, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("out") / "results"
    write_results(segment, press, dot, folder)
    return folder


def times(pvd: Path) -> list[float]:
    return [float(row.attrib["timestep"]) for row in ElementTree.parse(pvd).iter("DataSet")]


@for_each("name", ["segment", "film", "contact", "dot"])
def test_time_of_a_collection_is_the_indentation(results: Path, name: str) -> None:
    assert times(results / f"{name}.pvd") == pytest.approx(DEPTHS_MM)
    assert pyvista.get_reader(results / f"{name}.pvd").time_values == pytest.approx(DEPTHS_MM)


def test_segment_is_made_of_quadratic_tetrahedra(results: Path, segment: TetMesh) -> None:
    grid = pyvista.read(results / "segment_0003.vtu")
    assert set(grid.celltypes) == {24}
    (block,) = meshio.read(results / "segment_0003.vtu").cells
    assert block.type == "tetra10"
    np.testing.assert_array_equal(block.data, segment.tets)
    assert grid.volume == pytest.approx(2.5 * 2.5 * HEIGHT_MM, rel=1e-6)


def test_segment_fields_are_in_their_units(results: Path, segment: TetMesh, press: PressResult) -> None:
    fields = press.steps[3].fields
    data = meshio.read(results / "segment_0003.vtu")
    np.testing.assert_allclose(data.point_data["displacement_mm"], fields.displacement_m * 1000)
    np.testing.assert_allclose(data.cell_data["cauchy_stress_MPa"][0], fields.cauchy_stress_Pa / 1e6)
    np.testing.assert_allclose(data.cell_data["von_mises_MPa"][0], fields.von_mises_Pa / 1e6)
    np.testing.assert_allclose(data.cell_data["pressure_MPa"][0], fields.pressure_Pa / 1e6)
    np.testing.assert_allclose(data.cell_data["max_stretch"][0], fields.max_stretch)
    np.testing.assert_array_equal(data.cell_data["region"][0], segment.region)


def test_regions_are_named(results: Path, segment: TetMesh) -> None:
    field_data = pyvista.read(results / "segment_0000.vtu").field_data
    assert [int(field_data[f"region_{name}"][0]) for name in segment.region_names] == [0, 1, 2, 3]


def test_stress_components_are_named_in_vtk_order(results: Path) -> None:
    array = pyvista.read(results / "segment_0001.vtu").cell_data.GetArray("cauchy_stress_MPa")
    assert [array.GetComponentName(i) for i in range(6)] == ["XX", "YY", "ZZ", "XY", "YZ", "XZ"]


def test_points_are_undeformed_and_warp_onto_the_deformed_shape(results: Path, segment: TetMesh) -> None:
    grid = pyvista.read(results / "segment_0003.vtu")
    np.testing.assert_allclose(grid.points, segment.points_mm)
    assert grid.warp_by_vector("displacement_mm").bounds[5] == pytest.approx(HEIGHT_MM)
    middle = np.linalg.norm(grid.points - [0, 0, HEIGHT_MM], axis=1).argmin()
    assert grid["displacement_mm"][middle, 2] == pytest.approx(-0.3)


def test_film_file_holds_the_film_only(results: Path, press: PressResult) -> None:
    fields = press.steps[3].fields
    film = pyvista.read(results / "film_0003.vtu")
    assert set(film.celltypes) == {24}
    assert film.volume == pytest.approx(2.5 * 2.5 * 0.028, rel=1e-6)
    np.testing.assert_allclose(film["film_strain"], fields.film_strain)
    np.testing.assert_allclose(film["film_stress_MPa"], fields.film_stress_Pa / 1e6)
    assert film["displacement_mm"].shape == (film.n_points, 3)


def test_one_coulomb_per_square_metre_is_a_million_picocoulomb_per_square_millimetre(
    results: Path, press: PressResult
) -> None:
    charge = press.steps[3].fields.charge_density_C_per_m2
    written = meshio.read(results / "film_0003.vtu").cell_data["charge_density_pC_per_mm2"][0]
    picocoulomb_per_coulomb, square_millimetres_per_square_metre = 1e12, 1e6
    np.testing.assert_allclose(written, charge * picocoulomb_per_coulomb / square_millimetres_per_square_metre)


def test_contact_file_holds_quadratic_triangles(results: Path, press: PressResult) -> None:
    skin = pyvista.read(results / "contact_0003.vtu")
    fields = press.steps[3].fields
    assert set(skin.celltypes) == {22}
    assert skin.area == pytest.approx(2.5 * 2.5, rel=1e-6)
    assert skin["gap_mm"].sum() == pytest.approx(fields.gap_m.sum() * 1000)
    assert skin["contact_pressure_MPa"].max() == pytest.approx(fields.contact_pressure_Pa.max() / 1e6)
    deepest = skin["contact_pressure_MPa"].argmax()
    assert np.linalg.norm(skin.points[deepest, :2]) < 0.5


def test_dot_stands_where_it_is_pressed(results: Path) -> None:
    for step, depth in enumerate(DEPTHS_MM):
        assert pyvista.read(results / f"dot_{step:04d}.vtp").bounds[4] == pytest.approx(HEIGHT_MM - depth)


def test_slide_at_constant_depth_counts_steps(
    segment: TetMesh, press: PressResult, dot: DotShape, tmp_path: Path
) -> None:
    slide = replace(press, steps=(press.steps[0], press.steps[3], press.steps[3]))
    write_results(segment, slide, dot, tmp_path / "results")
    assert times(tmp_path / "results" / "segment.pvd") == [0.0, 1.0, 2.0]


def test_failure_leaves_the_former_results_untouched(
    segment: TetMesh, press: PressResult, dot: DotShape, tmp_path: Path
) -> None:
    folder = tmp_path / "results"
    folder.mkdir()
    (folder / "mine.txt").write_text("kept", "utf-8")
    broken = replace(press.steps[1], fields=replace(press.steps[1].fields, max_stretch=np.ones(3)))
    with pytest.raises(ValueError, match="length"):
        write_results(segment, replace(press, steps=(press.steps[0], broken)), dot, folder)
    assert [path.name for path in tmp_path.rglob("*")] == ["results", "mine.txt"]


def test_files_are_compressed(results: Path) -> None:
    head = (results / "segment_0003.vtu").read_bytes()[:300]
    assert b"vtkZLibDataCompressor" in head

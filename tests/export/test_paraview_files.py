"""Named parts with nodal fields, and the script that opens them in a real ParaView."""

from pathlib import Path

import numpy as np
import pytest
import pyvista

from export.vtu import write_results
from geometry.dot import DotShape
from mesh.types import TetMesh
from solve.result import PressResult


@pytest.fixture
def results(tmp_path: Path, segment: TetMesh, press: PressResult, dot: DotShape) -> Path:
    write_results(segment, press, dot, tmp_path / "results")
    return tmp_path / "results"


def test_each_part_is_a_block_of_its_name_with_its_own_nodes(results: Path, segment: TetMesh) -> None:
    blocks = pyvista.read(results / "parts_0003.vtm")
    assert blocks.keys() == list(segment.region_names)
    for number, name in enumerate(segment.region_names):
        assert blocks[name].n_cells == (segment.region == number).sum()
        assert {"displacement_mm", "nodal_von_mises_MPa", "nodal_green_lagrange_strain"} <= set(blocks[name].point_data)


def test_nodal_stress_keeps_the_jump_between_film_and_media(results: Path) -> None:
    blocks, whole = pyvista.read(results / "parts_0003.vtm"), pyvista.read(results / "segment_0003.vtu")
    film = whole.cell_data["region"] == 1
    highest = whole.cell_data["von_mises_MPa"][~film].max()
    assert blocks["medium1"].point_data["nodal_von_mises_MPa"].max() <= highest * (1 + 1e-12)
    assert blocks["film"].point_data["nodal_von_mises_MPa"].max() > 10 * highest


def test_nodal_charge_density_is_within_that_of_the_elements(results: Path) -> None:
    film = pyvista.read(results / "film_0003.vtu")
    cells = film.cell_data["charge_density_pC_per_mm2"]
    nodes = film.point_data["nodal_charge_density_pC_per_mm2"]
    assert cells.min() - 1e-12 <= nodes.min() < nodes.max() <= cells.max() + 1e-12
    assert np.ptp(nodes) > 0.3 * np.ptp(cells)


def test_the_script_has_no_mark_left_and_is_python(results: Path) -> None:
    script = (results / "show_in_paraview.py").read_text("utf-8")
    assert "@" not in script
    compile(script, "show_in_paraview.py", "exec")

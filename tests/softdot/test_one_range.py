"""One film strain, stress and charge density in summary, picture, 3D view and ParaView files."""

from dataclasses import replace

import numpy as np
import pytest

from export.film_maps import film_figure
from export.nodal_values import largest_principal
from export.viewer_data import viewer_data
from export.vtu import write_results
from geometry.parameters import Film, Medium, Segment
from softdot.summary import film
from solve.film_means import film_peak
from tests.export.pressed_box import box_dot, box_mesh, made_up_press

SEGMENT = Segment(
    film=Film(thickness_um=28.0), medium1=Medium(thickness_mm=0.5), medium2=Medium(thickness_mm=2.0), boundary="clamped"
)


def from_side(points: np.ndarray) -> np.ndarray:
    """Distance in mm from the nearest held side."""
    return np.minimum(SEGMENT.length_mm / 2 - np.abs(points[:, 0]), SEGMENT.width_mm / 2 - np.abs(points[:, 1]))


@pytest.fixture(scope="module")
def pressed():
    """A press with 50 times the strain, stress and charge in the cells at the held sides."""
    tet_mesh = box_mesh(36)
    result = made_up_press(tet_mesh)
    last = result.steps[-1]
    centre = tet_mesh.points_mm[tet_mesh.tets[last.fields.film_tets, :4]].mean(axis=1)
    rim = np.where(from_side(centre) < 0.07, 50.0, 1.0)
    level = 0.01 * np.exp(-0.5 * (centre[:, :2] ** 2).sum(axis=1)) * rim
    strain = level[:, None] * [1.0, 0.2, -0.5, 0.0, 0.0, 0.0]
    fields = replace(last.fields, film_strain=strain, film_stress_Pa=2e9 * strain, charge_density_C_per_m2=1e-2 * level)
    steps = (*result.steps[:-1], replace(last, fields=fields))
    return tet_mesh, replace(result, steps=steps, film_peak=film_peak((steps[-1],), tet_mesh, SEGMENT))


@pytest.fixture(scope="module")
def stated(pressed):
    return film(pressed[1])


def test_the_rim_is_no_part_of_the_headline(stated):
    assert stated["max_principal_strain"] == pytest.approx(0.01, rel=0.05)
    assert stated["rim_principal_strain"] > 2 * stated["max_principal_strain"]
    assert stated["rim_distance_mm"] == pytest.approx(0.14)


def test_the_3d_view_ends_at_the_headline_strain(pressed, stated):
    tet_mesh, result = pressed
    assert viewer_data(tet_mesh, result, box_dot())["strainTop"] == stated["max_principal_strain"]


def test_the_film_picture_ends_at_the_headline_values(pressed, stated):
    tet_mesh, result = pressed
    figure = film_figure(tet_mesh, result.steps[-1], result.film_peak)
    figure.draw_without_rendering()
    strain, charge = (axes.collections[0] for axes in figure.axes[:2])
    assert strain.get_clim() == pytest.approx((0.0, 100 * stated["max_principal_strain"]))
    assert charge.get_clim()[1] == pytest.approx(stated["charge_density_pC_per_mm2"][1])
    assert strain.colorbar.extend == "max"


@pytest.mark.press
def test_cells_of_paraview_away_from_held_sides_reach_the_headline_values(pressed, stated, tmp_path):
    import pyvista

    tet_mesh, result = pressed
    write_results(tet_mesh, result, box_dot(), tmp_path / "results")
    grid = pyvista.read(max((tmp_path / "results").glob("film_*.vtu")))
    away = from_side(grid.cell_centers().points) >= stated["rim_distance_mm"]
    strain = largest_principal(np.asarray(grid.cell_data["film_strain"]))
    stress = largest_principal(np.asarray(grid.cell_data["film_stress_MPa"]))
    charge = np.asarray(grid.cell_data["charge_density_pC_per_mm2"])
    assert strain[away].max() == pytest.approx(stated["max_principal_strain"])
    assert stress[away].max() == pytest.approx(stated["max_principal_stress_MPa"])
    assert charge[away].max() == pytest.approx(stated["charge_density_pC_per_mm2"][1])
    assert strain.max() == pytest.approx(stated["rim_principal_strain"])

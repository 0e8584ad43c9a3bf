"""Film quantities are means through the thickness, and the largest is told away from held rims."""

from dataclasses import replace

import numpy as np
import pytest

from geometry.parameters import Film, Medium, Segment
from mesh.options import MeshOptions
from mesh.types import TetMesh
from solve.film_means import RIM_THICKNESSES, film_columns, film_peak
from solve.model import Press
from tests.cases import for_each
from tests.export.pressed_box import box_mesh, made_up_press
from tests.pressing import press_segment
from tests.solve import segments

THICKNESS_MM = 0.028


def segment(**changes) -> Segment:
    layers = {"medium1": Medium(thickness_mm=0.5), "medium2": Medium(thickness_mm=2.0)}
    return Segment(film=Film(thickness_um=28.0), **layers, **changes)


def centroids(tet_mesh: TetMesh) -> np.ndarray:
    return tet_mesh.points_mm[tet_mesh.tets[tet_mesh.region_tets("film"), :4]].mean(axis=1)


@for_each("rows", [6, 1], ids=["solid", "slice"])
def test_pure_bending_about_the_middle_has_no_mean_strain(rows):
    """A plate bent to the curvature k is strained by k z; the mean over -t/2 to t/2 is zero, the surface k t/2."""
    tet_mesh = box_mesh(6, 2.5 if rows > 1 else 0.4, rows)
    middle = 2.0 + THICKNESS_MM / 2
    strain = 3.0 * (centroids(tet_mesh)[:, 2] - middle)
    mean = film_columns(tet_mesh).mean(strain)
    assert np.abs(strain).max() > 0.2 * 3.0 * THICKNESS_MM / 2
    assert np.abs(mean).max() < 1e-12


def test_stretch_that_is_even_through_the_thickness_is_kept():
    tet_mesh = box_mesh()
    columns = film_columns(tet_mesh)
    tensor = np.tile([0.01, -0.002, -0.003, 0.0, 0.0, 0.001], (len(columns.column), 1))
    np.testing.assert_allclose(columns.mean(tensor), tensor, rtol=1e-12)


def test_the_integral_over_the_film_is_kept():
    columns = film_columns(box_mesh())
    density = np.random.default_rng(0).random(len(columns.column))
    assert columns.volume @ columns.mean(density) == pytest.approx(columns.volume @ density)


@pytest.fixture
def press_with_rim():
    """A press whose strain, stress and charge are 100 times as large in the cells at the sides."""
    tet_mesh = box_mesh(36)
    result = made_up_press(tet_mesh)
    x, y, _ = np.abs(centroids(tet_mesh)).T
    rim = np.maximum(x, y) > 1.25 - THICKNESS_MM * RIM_THICKNESSES / 2
    factor = np.where(rim, 100.0, 1.0)
    last = result.steps[-1]
    flat = np.full((len(rim), 6), [0.01, 0, 0, 0, 0, 0]) * factor[:, None]
    fields = replace(last.fields, film_strain=flat, film_stress_Pa=2e9 * flat, charge_density_C_per_m2=1e-6 * factor)
    return tet_mesh, (replace(last, fields=fields),)


def test_a_singular_rim_is_told_apart(press_with_rim):
    tet_mesh, steps = press_with_rim
    peak = film_peak(steps, tet_mesh, segment(boundary="clamped"))
    assert (peak.strain, peak.rim_strain) == pytest.approx((0.01, 1.0))
    assert (peak.stress_Pa, peak.rim_stress_Pa) == pytest.approx((2e7, 2e9))
    assert peak.charge_density_C_per_m2 == pytest.approx((1e-6, 1e-6))
    assert peak.rim_distance_m == pytest.approx(5 * 28e-6)


@for_each("sides", [{"boundary": "free"}, {"boundary": "clamped", "held_layers": ("medium1",)}])
def test_a_film_whose_sides_are_not_held_has_no_rim(press_with_rim, sides):
    tet_mesh, steps = press_with_rim
    peak = film_peak(steps, tet_mesh, segment(**sides))
    assert peak.rim_distance_m == 0.0
    assert peak.strain == peak.rim_strain == pytest.approx(1.0)


@pytest.mark.press
def test_the_headline_strain_does_not_depend_on_the_mesh():
    """Of a clamped slice, on elements of the whole, half and a quarter of the size, crowded at the film."""
    slice_ = segments.segment(section="plane-strain", boundary="clamped")
    dot, found = segments.ridge(slice_), []
    for size in (0.1, 0.05, 0.025):
        options = MeshOptions(
            mesher="layered", element_size_mm=3 * size, contact_element_size_mm=3 * size, film_element_size_mm=size
        )
        tet_mesh = segments.coarse_mesh(slice_, dot, options)
        pressed = press_segment(slice_, segments.materials(), dot, Press(load_steps=2), tet_mesh)
        found.append(pressed.film_peak.strain)
    assert found == pytest.approx([found[-1]] * 3, rel=0.01)

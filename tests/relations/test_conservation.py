"""What a written result integrates to, by VTK: contact traction to the force, charge density to the charge."""

import numpy as np
import pytest
import pyvista

from export.vtu import write_results
from softdot import Case

COARSE = {"mesher": "layered", "element_size_mm": 0.8, "contact_element_size_mm": 0.3}
SLICE = {"segment": {"section": "plane-strain"}, "dot": {"shape": "ridge"}, "mesh": {"mesher": "layered"}}
FILM_MM = 0.028
PRESSES = {
    "quarter": {},
    "slice, dragged with friction": {
        **SLICE,
        "press": {"indentation_mm": 0.1, "load_steps": 2, "path_xy_mm": [[0.05, 0.0]]},
        "mechanisms": [{"name": "friction", "component": "dot", "parameters": {"coefficient": 0.4}}],
    },
}


@pytest.fixture(scope="module", params=PRESSES.values(), ids=PRESSES)
def pressed(request):
    return Case(**{"press": {"indentation_mm": 0.2, "load_steps": 2}, "mesh": COARSE, **request.param}).press()


def integrated(path, name):
    """Integral of a field over the cells of a file, mm and MPa or pC/mm2."""
    return pyvista.read(path).integrate_data()[name][0]


def test_traction_of_the_contact_is_the_force_and_charge_density_the_charge(pressed, tmp_path):
    result = pressed.result
    write_results(result.tet_mesh, result, pressed.case.dot, tmp_path)
    last, number = result.steps[-1], len(result.steps) - 1
    force_N = integrated(tmp_path / f"contact_{number:04d}.vtu", "contact_traction_MPa")
    share = (
        np.prod(np.ptp(result.tet_mesh.points_mm, axis=0)[:2]) / 2.5**2
    )  # a slice is written as thin as it is solved
    expected_N = -share * last.dot_force_N  # what the segment does to the dot, the other way round
    np.testing.assert_allclose(force_N, expected_N, rtol=1e-6, atol=1e-6 * abs(expected_N[2]))
    charge_pC = integrated(tmp_path / f"film_{number:04d}.vtu", "charge_density_pC_per_mm2") / FILM_MM
    assert charge_pC == pytest.approx(share * pressed.film_charge_pC[-1], rel=1e-6)


def test_a_mesh_in_python_is_the_one_of_the_files(pressed, tmp_path):
    result = pressed.result
    write_results(result.tet_mesh, result, pressed.case.dot, tmp_path)
    written, given = pyvista.read(tmp_path / f"segment_{len(result.steps) - 1:04d}.vtu"), pressed.to_pyvista()
    np.testing.assert_allclose(given.points, written.points, atol=1e-9)
    np.testing.assert_allclose(given["displacement_mm"], written["displacement_mm"], atol=1e-9)

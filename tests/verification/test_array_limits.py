"""Arrays whose answer is known: one segment alone in the limits, mirror images, conservation of charge and work."""

from dataclasses import replace

import numpy as np
import pytest

from mesh.array.mesh import array_mesh
from mesh.symmetry import mirrored_mesh
from softdot.case import Case
from solve.setup import discretise
from tests.cases import for_each
from tests.verification.array_cases import array, solved
from tests.verification.energies import follow
from tests.verification.row import agrees

HELD = ("effector", "medium1", "film")
FINE = {"element_size_mm": 0.6, "contact_element_size_mm": 0.2}


def lone(boundary, mesh=None, **segment):
    """Force (N) and charge (pC) of one segment of 2.3 mm by the mesher and the pipeline of one segment."""
    case = Case(
        segment={"length_mm": 2.3, "width_mm": 2.3, "boundary": boundary, **segment},
        press={"indentation_mm": 0.2, "load_steps": 2},
        mesh=mesh or {"mesher": "layered", **FINE},
    )
    pressed = case.press()
    assert pressed.converged, pressed.failure
    return pressed.reaction_force_N[-1], pressed.film_charge_pC[-1]


def agrees_with_lone(name, case, boundary):
    """Force and charge of the pressed segment within 1 %, charge of the other below 0.1 % of it."""
    press = solved(case.press_over(case.layout.places[0])).steps[-1]
    force_N, charge_pC = lone(boundary)
    charges_pC = 1e12 * press.film_charge_C
    agrees(f"{name}, force (N)", press.reaction_force_N, force_N, 0.01)
    agrees(f"{name}, charge (pC)", charges_pC[0], charge_pC, 0.01)
    assert abs(charges_pC[1]) < 1e-3 * charges_pC[0]


@pytest.mark.press
def test_a_groove_as_wide_as_the_gap_leaves_free_segments():
    """Only medium 2 runs through, and a groove takes all but 0.1 mm of it, which the base holds."""
    groove = {"layer": "medium2", "width_mm": 2.7, "depth_mm": 1.9}
    agrees_with_lone("wide groove", array(mesh=FINE, pitch_mm=5.0, shared=["medium2"], grooves=[groove]), "free")


@pytest.mark.press
def test_a_rigid_grid_leaves_clamped_segments():
    """The grid holds what the case of one segment holds; the sides of medium 2 are free in both."""
    agrees_with_lone("rigid grid", array(mesh=FINE, shared=["film"], grid_layers=list(HELD)), "clamped")


@pytest.mark.press
def test_a_press_and_its_mirror_image():
    """On a mesh that is its own image, the press of the last segment is the image of that of the first."""
    case = array()
    first, last = (case.press_over(place) for place in case.layout.places)
    mesh = mirrored_mesh(array_mesh(case.layout, first.dot, case.config.mesh, (0, 1))).tet_mesh
    one, other = (solved(press, mesh).steps[-1] for press in (first, last))
    np.testing.assert_allclose(other.film_charge_C[::-1], one.film_charge_C, rtol=1e-6)
    assert other.reaction_force_N == pytest.approx(one.reaction_force_N, rel=1e-6)


@pytest.mark.press
def test_half_an_array_is_the_whole():
    """The press of a row is its own image in y = 0; a half of the mesh gives what all of it gives."""
    press = array().press_over(array().layout.places[0])
    assert press.planes == (1,)
    half, whole = (solved(press, mesh).steps[-1] for mesh in (press.solved_mesh, press.mesh))
    np.testing.assert_allclose(half.film_charge_C, whole.film_charge_C, rtol=1e-6)


@pytest.mark.press
def test_dots_of_a_cell_press_by_their_own_heights():
    """Islands: the dot that is 0.06 mm lower presses its segment as one dot does that is pressed 0.06 mm less."""
    dots = {"cell": "⠉", "standard": "marburg-medium", "cell_heights_mm": [0.5, 0.44]}
    pair = array(shared=[], pitch_mm=2.5, tables={"dot": dots})
    both, deep = (solved(press).steps[-1] for press in (pair.press_by_cell(), pair.press_over(pair.layout.places[0])))
    less = array(shared=[], pitch_mm=2.5, press={"indentation_mm": pair.config.press.indentation_mm - 0.06})
    shallow = solved(less.press_over(less.layout.places[1])).steps[-1]
    np.testing.assert_allclose(both.film_charge_C, [deep.film_charge_C[0], shallow.film_charge_C[1]], rtol=5e-3)
    assert both.reaction_force_N == pytest.approx(deep.reaction_force_N + shallow.reaction_force_N, rel=5e-3)


@pytest.mark.press
def test_electrodes_share_the_charge_of_the_film():
    """Electrodes without a gap collect together what one electrode over everything does."""
    case = array(segment={"length_mm": 2.5, "width_mm": 2.5}, shared=["effector", "medium1", "film", "medium2"])
    press = case.press_over(case.layout.places[0])
    separate = solved(press).steps[-1].film_charge_C
    film = press.model.segment.film.model_copy(update={"electrodes": ()})
    press.model = replace(press.model, segment=press.model.segment.model_copy(update={"film": film}))
    together = solved(press).steps[-1].film_charge_C
    assert len(separate) == 2
    assert separate.sum() == pytest.approx(together[0], rel=1e-9)


@pytest.mark.press
@for_each("shape", ["dome", "cylinder"])
def test_round_effectors_are_those_of_one_segment(shape):
    """Extruded here, meshed by pytetwild there."""
    effector = {"shape": shape, "diameter_mm": 1.6, "height_mm": 0.5, "material": "rubber"}
    sizes = {"element_size_mm": 0.45, "contact_element_size_mm": 0.15}
    alone = array(columns=1, segment={"effector": effector}, mesh=sizes, shared=[])
    press = solved(alone.press_over(alone.layout.places[0])).steps[-1]
    force_N, charge_pC = lone("free", mesh={**sizes, "mesher": "pytetwild"}, effector=effector)
    agrees(f"{shape}, force (N)", press.reaction_force_N, force_N, 0.01)
    agrees(f"{shape}, charge (pC)", 1e12 * press.film_charge_C[0], charge_pC, 0.015)


@pytest.mark.press
def test_rows_and_columns_are_alike_for_a_film_that_is():
    """Film of equal constants along and across, two by two segments: a neighbour in x reads as one in y."""
    film = {"my-film": {"model": "piezoelectric-film", "d31_pC_per_N": 20.0, "d32_pC_per_N": 20.0}}
    tables = {"materials": film}
    case = array(2, 2, segment={"film": {"material": "my-film"}}, tables=tables, mesh={"contact_element_size_mm": 0.2})
    charge = solved(case.press_over(case.layout.places[0])).steps[-1].film_charge_C
    assert charge[1] == pytest.approx(charge[2], abs=5e-3 * charge[0])


@pytest.mark.press
def test_the_dot_does_the_work_that_the_array_stores():
    """Over twelve steps the work of the dot is the elastic energy, within 1 %: the rule of the trapezoid ends there."""
    press = array(press={"load_steps": 12}).press_over(array().layout.places[0])
    setup = discretise(press.model, press.solved_mesh, press.dot)
    assert follow(setup, setup.targets(False)).error < 0.01


@pytest.mark.press
def test_electrodes_behind_amplifiers_of_their_own_act_back_one_by_one():
    """Islands: the pressed one is the lone segment behind the same amplifier, the other reads nothing."""
    tables = {
        "materials": {"pvdf": {"coupling": "two-way"}},
        "readout": {"input_resistance_MOhm": 1.0, "input_capacitance_pF": 50.0},
    }
    pair, one = array(shared=[], tables=tables), array(columns=1, shared=[], tables=tables)
    assert pair.press_over(pair.layout.places[0]).model.separate_channels
    both, alone = (solved(case.press_over(case.layout.places[0])).steps[-1] for case in (pair, one))
    assert both.film_charge_C[0] == pytest.approx(alone.film_charge_C[0], rel=5e-3)
    assert abs(both.film_charge_C[1]) < 1e-6 * abs(both.film_charge_C[0])

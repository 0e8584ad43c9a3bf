"""Which presses of an array are solved, and how the others follow from them."""

import numpy as np
import pytest

from foundation.errors import InputError
from softdot.arrays import presses as presses_module
from softdot.arrays.case import ArrayCase
from softdot.arrays.matrix import CrosstalkMatrix, crosstalk
from softdot.arrays.presses import ArrayPresses, Signals, StoppedPressError
from softdot.arrays.roles import representatives, role
from softdot.case import Case
from softdot.config.model import model_of
from softdot.prepared_press import PreparedPress
from softdot.summary import stopped_solver
from tests.cases import for_each
from tests.verification.array_cases import array


def made_up(charges_pC) -> Signals:
    """A press of one step whose charges are given."""
    electrodes = [
        {"film_charge_pC": [0.0, charge], "open_circuit_voltage_V": [0.0, 0.05 * charge], "capacitance_pF": 20.0}
        for charge in charges_pC
    ]
    return Signals({"indentation_mm": [0.0, 0.2], "reaction_force_N": [0.0, 0.1], "electrodes": electrodes})


def test_mirror_images_are_not_solved_again():
    """Two by three: a corner and the middle of a side. A row of five: three. A film drawn aslant: all."""
    assert array(2, 3).solved_numbers == [0, 2]
    assert array(5, 1).solved_numbers == [0, 1, 2]
    assert array(2, 3, segment={"film": {"draw_angle_deg": 30.0}}).solved_numbers == list(range(6))


@for_each(
    ("name", "parameters"),
    [
        ("crosstalk", {"coupling": 0.1}),
        ("charge-leakage", {"resistance_MOhm": 500.0}),
        ("low-pass", {"cutoff_Hz": 20.0}),
    ],
)
def test_channels_that_differ_have_no_images(name, parameters):
    """An amplifier whose first channel hears the others, leaks or filters reads other presses otherwise."""
    one = {"name": name, "component": "channel-1", "parameters": parameters}
    assert array(2, 3, tables={"mechanisms": [one]}).solved_numbers == list(range(6))


def test_a_dot_beside_the_middle_keeps_the_symmetry_across():
    """Moved along x, it stands over a column of its own; rows are images of each other still."""
    assert array(2, 3, tables={"dot": {"offset_mm": [0.3, 0.0]}}).solved_numbers == [0, 1, 2, 3]


def test_rows_of_the_matrix_are_those_of_the_solved_presses_turned_over():
    """Columns of the last row read from the other end, by hand."""
    case = array(3, 1)
    matrix = CrosstalkMatrix(case, {0: made_up([10.0, 2.0, 1.0]), 1: made_up([3.0, 12.0, 3.0])})
    np.testing.assert_array_equal(matrix.charge_pC[:, -1], [[10, 2, 1], [3, 12, 3], [1, 2, 10]])
    np.testing.assert_allclose(matrix.crosstalk_percent[0], [100, 20, 10])
    np.testing.assert_allclose(matrix.crosstalk_dB[0], [0.0, -13.9794, -20.0], atol=1e-4)
    assert matrix.largest_crosstalk_percent == pytest.approx(25.0)
    assert matrix.asymmetry_percent() == pytest.approx(100.0 * 1.0 / 12.0)


def test_rows_and_columns_of_two_by_two_follow_from_one_press():
    """Segments 0 1 / 2 3: the neighbour along x of segment 3 is 2, that along y is 1."""
    matrix = CrosstalkMatrix(array(2, 2), {0: made_up([10.0, 3.0, 2.0, 1.0])})
    np.testing.assert_array_equal(matrix.charge_pC[3, -1], [1.0, 2.0, 3.0, 10.0])
    np.testing.assert_array_equal(matrix.charge_pC[1, -1], [3.0, 10.0, 1.0, 2.0])


def test_roles():
    """Three by three has all; of a row the ends are edges; two by three has no inner segment."""
    layouts = {shape: array(*shape).layout for shape in ((3, 3), (5, 1), (2, 3))}
    names = {shape: [role(one, place) for place in one.places] for shape, one in layouts.items()}
    assert names[3, 3] == ["corner", "edge", "corner", "edge", "inner", "edge", "corner", "edge", "corner"]
    assert names[5, 1] == ["edge", "inner", "inner", "inner", "edge"]
    assert set(names[2, 3]) == {"edge", "corner"}
    assert representatives(layouts[5, 1])["inner"] == 2


@pytest.mark.press
def test_a_solved_press_is_kept(monkeypatch, tmp_path):
    """Asked again it is read, and equal; an edited array is solved anew."""
    monkeypatch.setenv("SOFTDOT_CACHE", str(tmp_path))
    case = array(press={"load_steps": 1}, electrode_margin_mm=0.2)
    press = case.press_over(case.layout.places[0])
    (first,) = ArrayPresses()({"a press": press}).values()
    assert first.solve_s > 0.0
    np.testing.assert_allclose(case.capacitance_pF, first.capacitance_pF)  # eps A / t of what the margin leaves

    pressed = press.press()  # on the mesh that is there
    assert list(pressed.charges_pC) == ["segment-r1c1", "segment-r1c2"]
    assert "region_volume_error" not in press.mesh_quality  # of a segment without gaps
    np.testing.assert_allclose(np.column_stack(list(pressed.signals_V.values())), first.signal_V, rtol=1e-9)

    def never(*_given, **_named):
        raise AssertionError("solved again")

    monkeypatch.setattr(PreparedPress, "solve", never)
    (again,) = ArrayPresses()({"a press": press}).values()
    assert again.outcome == first.outcome
    other = array(press={"load_steps": 1}, electrode_margin_mm=0.1)
    with pytest.raises(AssertionError, match="solved again"):
        ArrayPresses()({"another": other.press_over(other.layout.places[0])})


def test_a_press_that_stops_is_told_by_its_segment(monkeypatch, tmp_path):
    """Nothing is made of the others."""
    monkeypatch.setenv("SOFTDOT_CACHE", str(tmp_path))
    stopped = {"solver": stopped_solver("step 1 of 2 stopped")}
    monkeypatch.setattr(presses_module, "outcome", lambda _config: stopped)
    with pytest.raises(StoppedPressError, match="the press of segment-r1c1 did not converge: step 1 of 2 stopped"):
        crosstalk(array(), ArrayPresses())


REFUSED = {
    "ridge": ({"dot": {"shape": "ridge"}}, "dot.shape = 'ridge': an array is pressed by round dots"),
    "a cap over slices": (
        {"segment": {"section": "plane-strain"}, "dot": {"shape": "cap"}},
        "dot.shape = 'cap': a row of slices is pressed by a 'ridge'",
    ),
    "slide": ({"press": {"path_xy_mm": [[1.0, 0.0]]}}, "press.path_xy_mm: softdot array presses each segment in turn"),
    "accuracy": ({"mesh": {"accuracy_percent": 1.0}}, "mesh.accuracy_percent = 1: an array takes element sizes"),
    "too fine": ({"mesh": {"contact_element_size_mm": 0.004}}, "mesh.contact_element_size_mm = 0.004: means about"),
    "cell too large": (
        {"dot": {"standard": "marburg-medium", "cell": "⠿"}},
        "dot.cell = '⠿': dot 2 has no segment under it, array.rows = 1 and 2 in each",
    ),
    "a mechanism that moves the dot": (
        {"mechanisms": [{"name": "dot-offset", "component": "dot", "parameters": {"offset_mm": [0.1, 0.0]}}]},
        "mechanisms: 'dot-offset': one of them changes the segment, the dot or a bond",
    ),
}


@for_each("name", REFUSED)
def test_what_an_array_does_not_take_is_refused_by_name(name):
    changes, sentence = REFUSED[name]
    tables = {key: value for key, value in changes.items() if key not in ("press", "mesh", "segment")}
    case = array(**{key: changes.get(key) for key in ("press", "mesh", "segment")}, tables=tables)
    with pytest.raises(InputError) as refusal:
        _ = case.warnings
    assert str(refusal.value).startswith(sentence)


def test_one_segments_commands_refuse_an_array():
    with pytest.raises(InputError, match="array: this is one segment's command; use softdot array"):
        model_of(array().config)


def test_a_configuration_without_an_array_is_refused():
    with pytest.raises(InputError, match="array is missing"):
        ArrayCase(array().config.model_copy(update={"array": None}))


def test_a_case_of_an_array_is_pressed_over_a_segment_by_its_name():
    """The same press as that of the study; the array itself has no single one."""
    case = Case(array().config)
    press = case.over("r1c2")
    assert press.dot.origin_mm[:2] == pytest.approx([1.25, 0.0])  # half the pitch of 2.5 mm from the middle
    assert [one.name for one in press.model.segment.film.electrodes] == ["segment-r1c1", "segment-r1c2"]
    assert case.warnings == array().warnings
    assert case.cost == array().cost
    with pytest.raises(InputError, match="segment 'r2c1': is none of r1c1, r1c2"):
        case.over("r2c1")
    with pytest.raises(InputError, match="array: this is one segment's command"):
        case.press()
    with pytest.raises(InputError, match="array is missing"):
        Case().over("r1c1")

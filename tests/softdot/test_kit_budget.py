"""The tolerance budget: exact laws of similarity, linearity of the charge, and its order."""

import pytest

from foundation.executor import HERE
from softdot.config.loading import config_from
from softdot.differentiation import with_changes
from softdot.prepared_press import PreparedPress
from softdot.tolerances import budget as budgets
from softdot.tolerances.budget import tolerance_budget
from softdot.tolerances.draws import ToleranceBox, box_questions
from softdot.tolerances.factors import FACTORS, factor_key, with_factors
from softdot.tolerances.questions import (
    PressAnswer,
    Question,
    Response,
    answer_all,
    answer_along,
    coarser_press,
    path_matters,
)
from softdot.tolerances.tolerances import Tolerance, shifts, tolerances
from solve.solution.full_load import StoppedShortError
from tests.cases import for_each

TABLES = {
    "segment": {
        "effector": {}, "medium1": {"thickness_mm": 0.5}, "film": {"thickness_um": 28.0},
        "medium2": {"thickness_mm": 2.0, "material": "vnr-soft"},
    },
    "press": {"indentation_mm": 0.1, "load_steps": 2},
    "mesh": {"element_size_mm": 1.2, "contact_element_size_mm": 0.8, "mesher": "layered"},
}  # fmt: skip
LAYERS = ("effector", "medium1", "film", "medium2")
PERMITTIVITY = "materials.pvdf.relative_permittivity"


@pytest.fixture(scope="module")
def config():
    return config_from(TABLES)


@pytest.fixture(scope="module")
def solved(config):
    """Response and its derivative by every key of the budget."""
    return Question(config, tuple(sorted({key for row in tolerances(config) for key in row.slopes}))).answer()[:2]


def total(found, terms):
    """Sum of weight times derivative."""
    return [sum(weight * found[key][k] for key, weight in terms.items()) for k in (0, 1)]


@pytest.mark.press
def test_full_load_has_the_derivatives_of_the_whole_press(config, solved):
    """Without memory the way there does not matter; differentiated along it, the press gives the same."""
    nominal, found = solved
    keys = [factor_key(config, "medium1", "modulus_factor"), "press.indentation_mm"]
    along, by_key, _ = answer_along(with_factors(config), keys, PreparedPress(config).solved_mesh)
    assert nominal == pytest.approx(along, rel=1e-6)
    for key in keys:
        assert found[key] == pytest.approx(by_key[key], rel=1e-5)


def test_a_press_beside_is_the_whole_press(config):
    """A dot that is 0.05 mm off, from the state of the one that is not, against a press of its own."""
    off = shifts(config)[0].changes(1.0)
    whole = answer_along(with_changes(config, off), (), PreparedPress(config).solved_mesh)
    assert Question(config, changes=off).answer().nominal == pytest.approx(whole.nominal, rel=1e-6)


@for_each(
    ("more", "matters"),
    [
        ({}, False),
        ({"readout": {"input_resistance_MOhm": 10.0}}, True),
        ({"mechanisms": [{"name": "friction", "component": "dot", "parameters": {"coefficient": 0.3}}]}, True),
    ],
)
def test_path_matters_where_something_remembers_or_leaks(more, matters):
    assert path_matters(config_from({**TABLES, **more})) == matters


def test_moduli_all_scale_force_and_charge(config, solved):
    """Euler: force and charge are of first degree in all moduli together, so that the derivatives add up to them."""
    nominal, found = solved
    terms = {factor_key(config, layer, "modulus_factor"): 1.0 for layer in LAYERS}
    assert total(found, terms) == pytest.approx(list(nominal), rel=1e-5)


def test_lengths_all_scale_force_squared_and_voltage(config, solved):
    """Geometric similarity: force grows with the square of all lengths, charge too, capacitance like a length."""
    nominal, found = solved
    terms = {factor_key(config, layer, "thickness_factor"): 1.0 for layer in LAYERS}
    terms |= {factor_key(config, "dot", "radius_factor"): 1.0, "press.indentation_mm": 0.1}
    terms |= {"segment.length_mm": 2.5, "segment.width_mm": 2.5}
    assert total(found, terms) == pytest.approx([2 * nominal.force, nominal.voltage], rel=1e-4)


def test_voltage_is_charge_over_permittivity(config, solved):
    """dV / dln d = V and dV / dln eps = -V; neither touches the force."""
    nominal, found = solved
    by_d, by_permittivity = found[factor_key(config, "film", "d31_factor")], found[PERMITTIVITY]
    assert by_d == (0.0, pytest.approx(nominal.voltage))
    assert 12.0 * by_permittivity.voltage == pytest.approx(-nominal.voltage, rel=1e-6)


def test_a_higher_dot_is_flatter_less_and_deeper(config, solved):
    """The row of the dot's height against two presses with dots of 1.5 mm base that stop at the same plate."""
    _, found = solved
    row = next(row for row in tolerances(config) if row.label == "height of the dot")
    change = 0.002
    sized = config_from({**TABLES, "dot": {"base_diameter_mm": 1.5, "height_mm": 0.5}})
    ends = []
    for sign in (1.0, -1.0):
        higher = {"dot.height_mm": sign * change, "press.indentation_mm": sign * change}
        ends.append(Question(sized, changes=higher).answer().nominal)
    by_difference = [(up - down) / (2 * change) for up, down in zip(*ends, strict=True)]
    assert total(found, row.slopes) == pytest.approx(by_difference, rel=0.01)


def test_film_height_is_an_exchange_of_both_media(config):
    row = next(row for row in tolerances(config) if row.label.startswith("height of the film"))
    assert row.slopes[factor_key(config, "medium1", "thickness_factor")] == pytest.approx(-1 / 0.5)
    assert row.slopes[factor_key(config, "medium2", "thickness_factor")] == pytest.approx(1 / 2.0)
    assert not row.counted


def test_layers_of_one_material_err_by_themselves():
    """Three media of one rubber have three moduli in the budget."""
    same = {name: {**TABLES["segment"][name], "material": "rubber"} for name in ("effector", "medium1", "medium2")}
    rows = tolerances(config_from({**TABLES, "segment": {**TABLES["segment"], **same}}))
    keys = [key for row in rows if row.label.startswith("modulus of") for key in row.slopes]
    assert len(set(keys)) == 4


def test_tolerances_follow_how_parts_are_made():
    """A cast layer is as good as the printer, a sheet 10 %; a silicone 30 %, the softest 50 %, rubber 22 %."""
    segment = {**TABLES["segment"], "medium2": {"thickness_mm": 2.0, "material": "ecoflex-00-30"}}
    made = {"printer": "fdm", "routes": {"medium1": "sheet"}}
    rows = {row.label: row for row in tolerances(config_from({**TABLES, "segment": segment, "fabrication": made}))}
    assert rows["thickness of medium 2"].plus_minus == pytest.approx(0.2)
    assert rows["thickness of medium 1"].plus_minus == pytest.approx(0.05)
    assert rows["modulus of medium 2"].plus_minus == pytest.approx(50.0)
    assert rows["modulus of medium 1"].plus_minus == pytest.approx(22.0)
    assert rows["modulus of the effector"].plus_minus == pytest.approx(30.0)  # RTV615 stands in for the rubber
    assert rows["thickness of the film"].unit == "µm"


def test_base_diameter_has_half_the_range_of_the_standard(config):
    """Marburg Medium: 1.3 to 1.6 mm."""
    row = next(row for row in tolerances(config) if row.label == "base diameter of the dot")
    assert (row.nominal, row.plus_minus) == (1.5, pytest.approx(0.15))
    assert "Marburg Medium" in row.source


def test_optional_rows_come_with_what_they_err_in():
    segment = {
        **TABLES["segment"], "effector": None, "boundary": "elastic", "side_stiffness_N_per_mm3": 4.0,
        "bonds": [{"between": ["film", "medium2"], "normal_stiffness_N_per_mm3": 10, "shear_stiffness_N_per_mm3": 5}],
    }  # fmt: skip
    tables = {**TABLES, "segment": {k: v for k, v in segment.items() if v is not None}}
    tables |= {"readout": {"input_resistance_MOhm": 1000.0, "input_capacitance_pF": 100.0}, "dot": {"shape": "plate"}}
    labels = [row.label for row in tolerances(config_from({**tables, "press": {"force_N": 0.5}}))]
    assert {"stiffness of the sides", "shear stiffness of the bond film–medium2", "force of the press"} <= set(labels)
    assert "capacitance of cable and amplifier" in labels
    assert not [label for label in labels if "dot" in label or "effector" in label]


def test_every_key_of_the_budget_exists(config):
    assert set(FACTORS) == {"effector", "medium1", "film", "medium2", "dot"}
    for row in tolerances(config):
        assert row.plus_minus > 0.0
        assert row.confidence in ("high", "medium", "low")
    for row in shifts(config):
        assert row.plus_minus > 0.0
        assert with_changes(config, row.changes(1.0)) != with_changes(config, row.changes(-1.0)) != config


def test_edges_of_electrodes_are_not_differentiated():
    """They pass whole points of the mesh, so that the sides of the segment are moved to both ends instead."""
    electrode = {"name": "a", "size_mm": [1.0, 1.0]}
    film = {"thickness_um": 28.0, "electrodes": [electrode]}
    config = config_from({**TABLES, "segment": {**TABLES["segment"], "film": film}})
    assert not [row for row in tolerances(config) if row.label.endswith("of the segment")]
    ends = {
        row.label: [with_changes(config, row.changes(share)).segment for share in (1.0, -1.0)] for row in shifts(config)
    }
    assert [one.width_mm for one in ends["width of the segment"]] == pytest.approx([2.6, 2.4])
    assert [one.length_mm for one in ends["length of the segment"]] == pytest.approx([2.6, 2.4])


def test_the_check_has_larger_elements(config):
    meshes = [coarser_press(config, factor).mesh.element_size_mm for factor in (1.0, 2.0, 3.0)]
    assert meshes == pytest.approx([1.2, 2.4, 3.6])


@pytest.fixture
def budget(config, monkeypatch, tmp_path):
    """A budget of made-up responses: 1 N and 10 V; each key changes both by its place in the alphabet."""
    ends = iter([Response(1.0, 9.0), Response(1.0, 10.5)] * 3)

    def made_up(question):
        slopes = {key: Response(0.01 * n, 0.1 * n) for n, key in enumerate(question.keys)}
        return PressAnswer(Response(1.0, 10.0) if question.keys else next(ends), slopes)

    monkeypatch.setenv("SOFTDOT_CACHE", str(tmp_path))
    monkeypatch.setattr(Question, "answer", made_up)
    return tolerance_budget(config)


def test_a_budget_stands_without_the_press_of_all_off_at_once(config, budget, monkeypatch, tmp_path):
    """Where one of these stops short, and where a quantity may vanish, so that it has no logarithm."""

    def stops(question):
        if question.keys and question.changes:
            raise StoppedShortError("too far")
        return PressAnswer(Response(1.0, 9.0), dict.fromkeys(question.keys, Response(0.01, 0.1)))

    monkeypatch.setenv("SOFTDOT_CACHE", str(tmp_path / "other"))
    monkeypatch.setattr(Question, "answer", stops)
    asked = {"all off at once, 1": Question(config, ("press.indentation_mm",), {"press.indentation_mm": 0.01})}
    with pytest.raises(StoppedShortError):
        answer_all(asked, HERE, lambda *_: None)
    monkeypatch.setattr(budgets, "box_questions", lambda *_: asked)
    without = tolerance_budget(config)
    assert without.drawn is None
    assert len(without.effects) == len(budget.effects)
    row = Tolerance("thickness", 0.2, 0.2, "mm", "", "high", {"t": 5.0})
    assert box_questions(config, ToleranceBox.of([row], {"t": 1.0}.get), ("t",)) == {}


def test_largest_effect_on_the_voltage_comes_first(budget):
    sizes = [abs(effect.change[1]) for effect in budget.effects]
    assert sizes == sorted(sizes, reverse=True)


def test_total_is_the_root_of_the_counted_squares(budget):
    counted = [effect.change[1] for effect in budget.effects if effect.tolerance.counted]
    assert len(counted) == len(budget.effects) - 1
    assert budget.total.voltage == pytest.approx(sum(change**2 for change in counted) ** 0.5)


def test_a_shift_shows_its_worse_end_and_their_difference(budget):
    """At 9.0 and 10.5 V around 10 V the change is -1 V; being opposite fails by 0.25 V on either side."""
    effect = next(effect for effect in budget.effects if effect.method == "both ends")
    assert effect.change[1] == -1.0
    assert effect.mesh_error[1] == 0.25


def test_percentages_are_of_the_nominal_response(budget):
    row = budget.as_dict()["rows"][0]
    assert row["voltage_percent"] == pytest.approx(10.0 * row["voltage_V"])
    assert row["force_percent"] == pytest.approx(100.0 * row["force_N"])

"""What the processes answer: drawn parts, remedies that mend, circuits, influences that agree with presses."""

import pickle
import tomllib
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest

from softdot import Case, load_config
from softdot.config.default_design import with_default_design
from softdot.config.loading import config_from
from softdot.config.toml import parse_toml
from softdot.studio.comparison import compared, differences
from softdot.studio.document import Document
from softdot.studio.work import design, influences, press
from softdot.studio.work.form import form
from solve.mechanisms import MECHANISMS
from tests.cases import for_each
from tests.softdot.toml_text import toml_text
from tests.studio.conftest import QUICK

DEFAULT = files("softdot.config").joinpath("default.toml").read_text("utf-8")


def changed(text, *changes):
    document = Document(text)
    for key, value in changes:
        document.set(key, value)
    return document.text


def test_a_design_takes_the_material_that_it_includes(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    material = {"youngs_modulus_MPa": 0.345, "density_kg_m3": 1000.0, "source": "test", "confidence": "low"}
    Path("rubber.toml").write_text(toml_text({"materials": {"own": material}}), "utf-8")
    text = 'include = ["rubber.toml"]\n[segment.medium1]\nmaterial = "own"\n'
    found = design.examine(text)
    assert found["mistakes"] == []
    assert found["values"]["materials"]["own"]["youngs_modulus_MPa"] == 0.345
    assert design.config_of(text).layer_materials()["medium1"].youngs_modulus_MPa == 0.345


def test_what_is_already_known_is_told_with_every_step_that_follows():
    told = []
    progress = press.TaskProgress(told.append)
    progress.stage("compare")
    progress.step(1, 3, "")
    progress.note("First look: the voltage is too high.")
    progress.step(2, 3, "")
    assert "known" not in told[-2]["progress"]
    assert told[-1]["progress"]["known"] == ["First look: the voltage is too high."]


@pytest.mark.press
@for_each("name", MECHANISMS)
def test_every_mechanism_can_be_switched_on_with_its_example(name):
    """At one of its components at least, on the default design with two electrodes."""
    (about,) = [one for one in form()["mechanisms"] if one["name"] == name]
    half = {"size_mm": [1.0, 2.0], "name": "left", "center_mm": [-0.6, 0.0]}
    text = changed(DEFAULT, (["segment", "film", "electrodes", 0], half))
    text = changed(text, (["segment", "film", "electrodes", 1], {**half, "name": "right", "center_mm": [0.6, 0.0]}))
    mistakes = []
    for component in about["components"]:
        entry = {"name": name, "component": component, "parameters": about["example"]}
        mistakes += [design.examine(changed(text, (["mechanisms", 0], entry)))["mistakes"]]
    assert [] in mistakes


def test_examples_of_mechanisms_are_those_of_the_examples():
    stated = {}
    for file in sorted(Path("examples/mechanisms").glob("*.toml")):
        for one in tomllib.loads(file.read_text("utf-8")).get("mechanisms", []):
            stated.setdefault(one["name"], one.get("parameters", {}))
    assert {name: dict(kind.example) for name, kind in MECHANISMS.items()} == stated


WRONG = {
    "press.indentation_mm = -3: must be above 0": ("indentation_mm = 0.3", "indentation_mm = -3.0"),
    "press.load_steps = 0: must be at least 1": ("load_steps = 6", "load_steps = 0"),
    "segment.film.thicknes_um is not a key": ("thickness_um", "thicknes_um"),
    "segment.effector.diameter_mm is missing": ('shape = "layer"', 'shape = "dome"'),
    "press.depth is not a key": ("load_steps = 6", "load_steps = 6\ndepth = 1"),
}


@for_each("sentence", WRONG)
def test_a_mistake_is_mended_by_its_button(sentence):
    text = DEFAULT.replace(*WRONG[sentence])
    told = design.examine(text)
    at = next(number for number, one in enumerate(told["mistakes"]) if one.startswith(sentence))
    mended = design.examine(changed(text, *told["remedies"][at]["changes"]))
    assert not any(one.startswith(sentence) for one in mended["mistakes"])
    assert len(mended["mistakes"]) < len(told["mistakes"])


def test_each_warning_of_a_design_is_mended_by_its_button():
    text = changed(
        DEFAULT, (["press", "indentation_mm"], 0.6), (["segment", "held_layers"], ["medium1", "film", "medium2"])
    )
    told = design.examine(text)
    assert len(told["warnings"]) == 2
    for warning, remedy in zip(told["warnings"], told["remedies"], strict=True):
        assert warning not in design.examine(changed(text, *remedy["changes"]))["warnings"]


def test_a_film_beyond_its_yield_stress_is_let_yield():
    text = QUICK + "\n[materials.pvdf]\nyield_stress_MPa = 1.0\n"
    numbers = press.coarse_press(text, lambda _: None)["numbers"]
    at = next(number for number, one in enumerate(numbers["warnings"]) if "exceeds its yield stress" in one)
    mended = changed(text, *numbers["remedies"][at]["changes"])
    again = press.coarse_press(mended, lambda _: None)["numbers"]
    assert not any("exceeds its yield stress" in one for one in again["warnings"])


def test_the_coarse_press_is_some_percent_off():
    told = []
    coarse = press.coarse_press(QUICK, told.append)["numbers"]
    fine = Case(config_from(with_default_design(parse_toml(QUICK, "quick")))).press()
    assert coarse["open_circuit_voltage_V"][-1] == pytest.approx(fine.open_circuit_voltage_V[-1], rel=0.06)
    assert coarse["reaction_force_N"][-1] == pytest.approx(fine.reaction_force_N[-1], rel=0.06)
    assert [one["progress"]["done"] for one in told if one["progress"]["stage"] == "press"] == [0, 1, 2, 3]
    assert told[-1]["progress"]["left_s"] == 0.0


def test_a_circuit_needs_a_few_kilobytes_and_answers_as_a_run_does(tmp_path):
    amplified = QUICK + "\n[readout]\ninput_resistance_MOhm = 10.0\nlow_pass_Hz = 60.0\n"
    (tmp_path / "mine.toml").write_text(amplified, "utf-8")
    case = Case(load_config(tmp_path / "mine.toml"))
    history = pickle.dumps(press.without_fields(Case(design.pressed_part(case).config).press().result))
    assert len(history) < 20_000
    np.testing.assert_allclose(
        press.circuit(amplified, history)["readout_voltage_V"], case.press().readout_voltage_V, rtol=1e-6
    )
    assert press.circuit(QUICK, history) is None


LOW_PASS = """
[[mechanisms]]
name = "low-pass"
component = "readout"
parameters = { cutoff_Hz = 60.0 }
"""
ELECTRICAL = ["[readout]\ninput_resistance_MOhm = 3.0\n", "[press.waveform]\nrise_s = 0.1\n",
              "[fabrication]\nprinter = \"fdm\"\n",
              LOW_PASS]  # fmt: skip


@for_each("more", ELECTRICAL)
def test_what_stands_behind_the_film_needs_no_other_press(more):
    assert design.examine(QUICK + more)["press_hash"] == design.examine(QUICK)["press_hash"]


CREEP = """
[[mechanisms]]
name = "viscoelasticity"
component = "medium2"
parameters = { relative_moduli = [0.3], relaxation_times_s = [0.2] }
"""


def test_time_counts_where_a_medium_creeps():
    slow, quick = (f"[press.waveform]\nrise_s = {rise}\n" for rise in (1.0, 0.1))
    assert design.examine(QUICK + slow + CREEP)["press_hash"] != design.examine(QUICK + quick + CREEP)["press_hash"]


@pytest.mark.press
def test_influences_are_those_of_two_presses():
    """A tenth of the effect of a thousandth, by central differences on the same extruded elements."""
    rows = {row["label"]: row for row in influences.influences(QUICK, lambda _: None)["rows"]}
    config = influences.quick_press(design.case_of(QUICK).config)

    def voltage(factor):
        film = config.segment.film.model_copy(update={"thickness_um": 100.0})
        deep = config.press.model_copy(update={"indentation_mm": 0.1 * factor})
        segment = config.segment.model_copy(update={"film": film})
        return Case(config.model_copy(update={"press": deep, "segment": segment})).press().open_circuit_voltage_V[-1]

    slope = (voltage(1.001) - voltage(0.999)) / 0.002 / voltage(1.0)
    assert rows["depth of the press"]["voltage_percent"] == pytest.approx(10 * slope, rel=0.02)
    assert rows["d31 of film"]["voltage_percent"] == pytest.approx(10.0, rel=0.4)
    assert rows["d31 of film"]["force_percent"] == pytest.approx(0.0, abs=1e-6)


def test_parts_are_drawn_as_they_are_built():
    view = design.draw(DEFAULT)
    assert set(view["names"]) == {"effector", "medium1", "film", "medium2", "case"}
    assert design.draw("[segment") is None
    assert design.draw(DEFAULT.replace("indentation_mm = 0.3", "indentation_mm = -1.0")) is None


def test_a_comparison_shows_what_designs_give_and_where_they_differ():
    thin = {"values": {"segment": {"medium1": {"thickness_mm": 0.4}, "section": "solid"}}, "numbers": None}
    thick = {
        "values": {"segment": {"medium1": {"thickness_mm": 0.5}, "section": "solid"}},
        "numbers": {"open_circuit_voltage_V": [0.0, 9.7], "film": {"max_principal_strain": 0.01}},
    }
    rows = {row["label"]: row["cells"] for row in compared([thin, thick])}
    assert rows["open-circuit voltage"] == [None, 9.7]
    assert rows["strain of the film"] == [None, 1.0]
    assert rows["segment.medium1.thickness_mm"] == [0.4, 0.5]
    assert "segment.section" not in rows
    assert differences(thin["values"], thick["values"]) == {"segment.medium1.thickness_mm": 0.5}

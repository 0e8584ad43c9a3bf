"""The configurations of the rig, and the section that comes out of them."""

import pytest

from softdot.outcome import outcome
from softdot.studies.paper.calibration.rig import CASES, constant_sponge, foam, rig_config
from softdot.studies.paper.calibration.section import section_of
from softdot.studies.paper.published import published_numbers
from tests.cases import for_each
from tests.studies.paper.stand_in_rig import rig


@for_each("name", ["I", "II"])
def test_the_rig_is_that_of_table_1(name):
    config = rig_config(CASES[name], "solid", constant_sponge(0.3), 0.8)
    numbers = published_numbers()
    assert config.segment.medium1.thickness_mm == numbers[f"table1.{name}.h1_mm"].value
    assert config.materials["medium1"].youngs_modulus_MPa == numbers[f"table1.{name}.E1_MPa"].value
    assert config.press.indentation_mm == numbers[f"table1.{name}.u2_mm"].value
    assert config.segment.medium2.thickness_mm == numbers["section2.h2_mm"].value
    assert 1e3 * config.materials["medium2"].youngs_modulus_MPa == numbers["section2.E2_kPa"].value
    assert config.segment.length_mm == config.segment.width_mm == numbers["section2.film-width_mm"].value
    assert config.segment.boundary == "free"


def test_a_finer_mesh_is_finer_in_every_size():
    plain, finer = (rig_config(CASES["I"], "solid", constant_sponge(0.3), 0.8, finer=f).mesh for f in (False, True))
    assert finer.element_size_mm < plain.element_size_mm
    assert finer.contact_element_size_mm < plain.contact_element_size_mm
    assert finer.mesher == plain.mesher


@pytest.mark.press
def test_a_slightly_pressed_foam_is_the_constant_sponge():
    """Both laws have 50 kPa at small strain; deep down the foam gives way."""

    def force(sponge, depth_mm):
        config = rig_config(CASES["I"], "plane-strain", sponge, 0.8)
        press = config.press.model_copy(update={"indentation_mm": depth_mm, "load_steps": 2})
        mesh = config.mesh.model_copy(
            update={"element_size_mm": 3.0, "film_element_size_mm": 2.0, "contact_element_size_mm": 0.4}
        )
        return outcome(config.model_copy(update={"press": press, "mesh": mesh}))["reaction_force_N"][-1]

    assert force(foam(12.0, 0.1), 0.005) == pytest.approx(force(constant_sponge(0.1), 0.005), rel=0.01)
    assert force(foam(12.0, 0.1), 0.8) < 0.75 * force(constant_sponge(0.1), 0.8)


@pytest.mark.press
def test_a_stiff_film_on_soft_foam_is_pressed_to_full_depth():
    """Rounding of the film's own forces exceeds a billionth of the load; the press must not stop there."""
    found = outcome(rig_config(CASES["II"], "plane-strain", foam(12.0, 0.05), 0.8))
    assert found["solver"]["converged"], found["solver"]["failure"]
    assert found["indentation_mm"][-1] == pytest.approx(1.57)


@pytest.mark.press
def test_the_section_has_its_figures_tables_and_words(tmp_path):
    section = section_of(rig(), tmp_path, 4)
    assert {figure.path.name for figure in section.figures} == {
        "calibration-pieces.png",
        "calibration-map.png",
        "calibration-signal.png",
        "calibration-outputs.png",
    }
    assert all(figure.path.stat().st_size > 10_000 for figure in section.figures)
    for table in section.tables:
        assert {len(row) for row in table.rows} == {len(table.headers)}
    assert "288" in section.findings[0]
    assert section.numbers["cases"]["I"]["p_printed"] == 288.0

"""Everything that a command does, in three lines of Python."""

import json
import subprocess
import sys

import numpy as np
import pytest

import softdot
from foundation.errors import InputError
from softdot import Case

TABLES = {
    "segment": {
        "section": "plane-strain", "boundary": "free", "width_mm": 16.0,
        "medium1": {"thickness_mm": 0.5, "material": "vnr"}, "film": {"thickness_um": 28.0},
        "medium2": {"thickness_mm": 2.0, "material": "vnr-soft"},
    },
    "dot": {"shape": "ridge", "radius_mm": 1.15},
    "press": {"indentation_mm": 0.1, "load_steps": 2},
    "mesh": {"element_size_mm": 0.6, "contact_element_size_mm": 0.2, "mesher": "layered"},
}  # fmt: skip


@pytest.fixture(scope="module")
def case():
    return Case(**TABLES)


def test_nothing_is_made_before_it_is_asked_for():
    lazy = Case(**TABLES)
    assert set(vars(lazy)) == {"config"}
    assert lazy.mesh is lazy.mesh
    assert "parts" not in vars(lazy)


def test_a_case_takes_tables_a_file_or_settings(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text("[press]\nindentation_mm = 0.2\n", "utf-8")
    assert Case(press={"indentation_mm": 0.2}).config == Case.load(path).config
    assert Case.load(path, ["press.indentation_mm=0.1"]).config.press.indentation_mm == 0.1
    with pytest.raises(InputError, match=r"press.indentation_mm = -1"):
        Case(press={"indentation_mm": -1})


def test_units_stand_in_the_names_of_a_press(case):
    pressed = case.press()
    assert pressed is case.press()
    assert pressed.converged
    assert pressed.indentation_mm == pytest.approx([0.0, 0.05, 0.1])
    capacitance_F = 1e-12 * pressed.film_capacitance_pF
    assert pressed.open_circuit_voltage_V == pytest.approx(1e-12 * pressed.film_charge_pC / capacitance_F)
    assert pressed.readout_voltage_V is None
    assert pressed.charges_pC["film"] == pytest.approx(pressed.film_charge_pC)  # of its only electrode
    assert pressed.signals_V["film"] == pytest.approx(pressed.open_circuit_voltage_V)
    table = pressed.to_dataframe()
    assert list(table.columns) == [
        "time_s", "indentation_mm", "reaction_force_N", "charge_pC_film", "voltage_V_film", "solved"
    ]  # fmt: skip
    assert table["reaction_force_N"].iloc[-1] == pytest.approx(pressed.reaction_force_N[-1])
    assert table["indentation_mm"][table["solved"]].to_list() == pytest.approx(pressed.indentation_mm)
    assert "converged" in pressed._repr_html_()
    assert len(pressed.plot().axes) == 2


def test_fields_of_a_step_as_pyvista_has_them(case):
    """The base is held and the top of the mesh goes down with the dot; the film has its strain, the media none."""
    grid = case.press().to_pyvista()
    assert grid.n_cells == len(case.mesh.tets)
    moved = grid.point_data["displacement_mm"]
    assert np.abs(moved[case.mesh.facets["base"].ravel()]).max() == 0.0
    assert moved[:, 2].min() == pytest.approx(-0.1, abs=0.01)
    film = grid.cell_data["region"] == case.mesh.region_names.index("film")
    assert np.isfinite(grid.cell_data["film_strain"][film]).all()
    assert np.isnan(grid.cell_data["film_strain"][~film]).all()


@pytest.mark.press
def test_saving_a_case_is_a_run(case, tmp_path):
    summary = case.save(tmp_path / "out")
    assert summary["reaction_force_N"] == pytest.approx(case.press().reaction_force_N, rel=1e-11)
    assert json.loads((tmp_path / "out" / "summary.json").read_text("utf-8"))["solver"]["converged"]
    assert (tmp_path / "out" / "report.html").exists()


def test_derivatives_of_a_case(case):
    """To the film's charge all piezoelectric constants count linearly: the sum of d ln Q / d ln d is one."""
    keys = [f"materials.pvdf.{name}_pC_per_N" for name in ("d31", "d32", "d33")]
    found = case.derivatives(keys)
    total = sum(one.value * one.film_charge_pC[-1] for one in found)
    assert total == pytest.approx(case.press().film_charge_pC[-1], rel=1e-4)


@pytest.mark.press
def test_a_sweep_is_a_data_frame(tmp_path):
    axis = {"key": "press.indentation_mm", "values": [0.05, 0.1]}
    table = softdot.sweep({**TABLES, "sweep": {"workers": 1, "axes": [axis]}}, tmp_path / "sweep")
    assert list(table["press.indentation_mm"]) == [0.05, 0.1]
    assert (table["status"] == "solved").all()


@pytest.mark.parametrize("name", ["mesh.py", "geometry/__init__.py"])
def test_a_foreign_module_that_hides_one_of_ours_is_named_at_import(name, tmp_path):
    (tmp_path / name).parent.mkdir(exist_ok=True)
    (tmp_path / name).write_text("", "utf-8")
    done = subprocess.run(
        [sys.executable, "-c", "import softdot"], cwd=tmp_path, capture_output=True, encoding="utf-8", check=False
    )
    package = name.split("/")[0].removesuffix(".py")
    assert done.returncode == 1
    assert f"the package '{package}' of softdot is hidden by '{tmp_path / name}'" in done.stderr.splitlines()[-1]

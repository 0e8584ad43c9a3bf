"""The folder of a sweep: rows, summaries, failures, and going on after a stop. Stand-ins solve, in this process."""

import errno
import json
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from foundation.errors import InputError
from softdot import outcome as outcome_module
from softdot.cli import main
from softdot.sweeps import folder as store
from softdot.sweeps import read_table, run_sweep, space_from
from softdot.sweeps import run as run_module
from softdot.sweeps.points import CRASHED, LOST, NOT_CONVERGED, REFUSED, failed_record, solve_point
from softdot.sweeps.table import write_table
from tests.softdot.complaints import complaints
from tests.softdot.stand_ins import result_of
from tests.softdot.sweep_spaces import DEPTHS, depths, no_processes, solved_here, space_of
from tests.softdot.toml_text import toml_text

pytestmark = pytest.mark.usefixtures("presses")


class Presses:
    """The stand-in press: deeper gives more; counts, fails and stops as told."""

    def __init__(self):
        self.depths = []
        self.failures = {}

    def __call__(self, case, *_):
        depth = case.config.press.indentation_mm
        self.depths.append(depth)
        failure = self.failures.get(depth)
        if isinstance(failure, BaseException):
            raise failure
        return result_of([0.0, depth], failure)


@pytest.fixture
def presses(stages, monkeypatch, tmp_path):
    monkeypatch.setenv("SOFTDOT_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(run_module, "executor_for", no_processes)
    monkeypatch.setattr(run_module, "solve_all", solved_here)
    stages.solve = Presses()
    return stages.solve


@pytest.fixture
def out(tmp_path):
    return tmp_path / "out"


def rows(out):
    return read_table(out).to_pylist()


def points(out):
    return [json.loads(path.read_text(encoding="utf-8")) for path in sorted((out / "points").iterdir())]


def sweep(tmp_path, out, *axes, **settings):
    """softdot sweep as a user starts it; its exit status."""
    path = tmp_path / "space.toml"
    path.write_text(toml_text(space_of(*axes, **settings)), "utf-8")
    return main(["sweep", str(path), "-o", str(out)])


def test_each_row_says_what_the_summary_of_its_point_says(out):
    run_sweep(space_from(space_of(depths(0.1, 0.2, 0.3))), out)
    table = rows(out)
    summaries = {one["config_hash"]: one for one in points(out)}
    assert [row["point"] for row in table] == [0, 1, 2]
    for row, depth in zip(table, [0.1, 0.2, 0.3], strict=True):
        summary = summaries[row["config_hash"]]
        assert row[DEPTHS] == summary["config"]["press"]["indentation_mm"] == depth
        assert row["reaction_force_N"] == summary["reaction_force_N"] == [0.0, pytest.approx(10.0 * depth)]
        assert row["peak.reaction_force_N"] == summary["reaction_force_N"][-1]
        assert row["film.capacitance_pF"] == summary["film"]["capacitance_pF"] == 10.0
        assert row["solver.newton_iterations"] == summary["solver"]["newton_iterations"]
        assert (row["status"], row["reason"]) == ("solved", None)


def test_the_summary_is_printed_and_kept(tmp_path, out, capfd):
    path = tmp_path / "space.toml"
    path.write_text(toml_text(space_of(depths(0.1, 0.2))), "utf-8")
    assert main(["sweep", str(path), "-o", str(out), "--json"]) == 0
    printed = json.loads(capfd.readouterr().out)
    assert printed == json.loads((out / "sweep.json").read_text(encoding="utf-8"))
    assert (printed["format"], printed["complete"], printed["points"]) == ("softdot-sweep/1", True, 2)
    assert printed["ended"] == {"solved": 2, "refused": 0, "not-converged": 0, "crashed": 0, "lost": 0}
    assert (out / "space.toml").read_text(encoding="utf-8") == path.read_text(encoding="utf-8")
    assert sorted(entry.name for entry in out.iterdir()) == [
        "log.txt", "points", "report.html", "space.toml", "sweep.csv", "sweep.json", "sweep.parquet", "sweep.png",
    ]  # fmt: skip


def test_the_peak_is_the_largest_magnitude_with_its_sign(stages, out):
    pressed, voltages_V = result_of([0.0, 0.1, 0.3]), [0.0, -0.8, 0.6]
    steps = [
        replace(step, open_circuit_voltage_V=np.array([voltage]))
        for step, voltage in zip(pressed.steps, voltages_V, strict=True)
    ]
    stages.solve = lambda *_: replace(pressed, steps=tuple(steps))
    run_sweep(space_from(space_of(depths(0.1))), out)
    assert rows(out)[0]["peak.open_circuit_voltage_V"] == pytest.approx(-0.8)


def test_a_point_that_fails_is_a_row_with_its_reason(presses, stages, tmp_path, out):
    presses.failures = {0.2: "Newton's method found no state\nat 0.1 mm", 0.3: RuntimeError("a bug")}
    check = stages.checked_design

    def refuse_deep(case, *_):
        if case.config.press.indentation_mm > 0.35:
            raise InputError("press.indentation_mm = 0.4: too deep")
        return check(case)

    stages.checked_design = refuse_deep
    assert sweep(tmp_path, out, depths(0.1, 0.2, 0.3, 0.4)) == 0
    assert [(row["status"], row["reason"]) for row in rows(out)] == [
        ("solved", None),
        ("not-converged", "Newton's method found no state at 0.1 mm"),
        ("crashed", "RuntimeError: a bug"),
        ("refused", "press.indentation_mm = 0.4: too deep"),
    ]
    assert json.loads((out / "sweep.json").read_text(encoding="utf-8"))["ended"]["crashed"] == 1


def test_a_configuration_that_cannot_be_is_a_row_too(out):
    along = {"key": "materials.pvdf.youngs_modulus_MPa", "values": [400.0, 2000.0]}
    across = {"key": "materials.pvdf.youngs_modulus_2_MPa", "values": [1000.0, 8000.0]}
    run_sweep(space_from(space_of(along, across)), out)
    assert [row["status"] for row in rows(out)] == ["solved", "refused", "solved", "solved"]
    assert rows(out)[1]["config_hash"] is None
    assert rows(out)[1][across["key"]] == 8000.0


def test_a_sweep_without_any_solved_point_exits_3(presses, tmp_path, out, capfd):
    presses.failures = {0.1: "no", 0.2: "no"}
    assert sweep(tmp_path, out, depths(0.1, 0.2)) == 3
    said = complaints(capfd.readouterr().err)
    assert said == f"softdot: not one of 2 points could be solved; the reasons are in '{out}'\n"
    assert len(rows(out)) == 2


def test_an_interrupted_sweep_keeps_what_was_finished_and_goes_on(presses, tmp_path, out, capfd):
    presses.failures = {0.3: KeyboardInterrupt()}
    assert sweep(tmp_path, out, depths(0.1, 0.2, 0.3, 0.4)) == 130
    assert complaints(capfd.readouterr().err) == (
        f"softdot: interrupted; finished points are kept in '{out}', the same command continues with the others\n"
    )
    assert sorted(entry.name for entry in out.iterdir()) == ["log.txt", "points", "sweep.json"]
    assert len(points(out)) == 2
    with pytest.raises(InputError, match="the sweep is not complete"):
        read_table(out)
    presses.failures, presses.depths = {}, []
    assert sweep(tmp_path, out, depths(0.1, 0.2, 0.3, 0.4)) == 0
    assert presses.depths == [0.3, 0.4]
    assert [row["status"] for row in rows(out)] == ["solved"] * 4


def test_interrupted_before_anything_was_written(monkeypatch, tmp_path, out, capfd):
    def stopped(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(run_module, "executor_for", stopped)
    assert sweep(tmp_path, out, depths(0.1)) == 130
    assert complaints(capfd.readouterr().err) == "softdot: interrupted, nothing was written\n"
    assert not out.exists()


def test_another_space_takes_over_the_points_that_both_have(presses, tmp_path, out):
    sweep(tmp_path, out, depths(0.1, 0.2))
    presses.depths = []
    sweep(tmp_path, out, depths(0.2, 0.3), sampling="list")
    assert presses.depths == [0.3]
    assert [row[DEPTHS] for row in rows(out)] == [0.2, 0.3]
    assert len(points(out)) == 3


def test_the_table_of_the_last_complete_sweep_stays_until_the_next_is_complete(presses, tmp_path, out):
    sweep(tmp_path, out, depths(0.1, 0.2))
    tables = ("sweep.json", "sweep.parquet")
    before = {name: (out / name).read_bytes() for name in tables}
    presses.failures = {0.4: KeyboardInterrupt()}
    assert sweep(tmp_path, out, depths(0.3, 0.4)) == 130
    assert {name: (out / name).read_bytes() for name in tables} == before


ENDS = {CRASHED: [0.2], LOST: [0.2], REFUSED: [], NOT_CONVERGED: []}


@pytest.mark.press
@pytest.mark.parametrize(("accident", "again"), ENDS.items())
def test_only_accidents_are_tried_again(presses, monkeypatch, tmp_path, out, accident, again):
    def unlucky(config):
        return solve_point(config) if config.press.indentation_mm != 0.2 else failed_record(accident, "so it was")

    monkeypatch.setattr(run_module, "solve_all", partial(solved_here, solve=unlucky))
    sweep(tmp_path, out, depths(0.1, 0.2))
    assert rows(out)[1]["reason"] == "so it was"
    monkeypatch.setattr(run_module, "solve_all", solved_here)
    presses.depths = []
    sweep(tmp_path, out, depths(0.1, 0.2))
    assert presses.depths == again


def test_a_damaged_summary_is_solved_again(presses, tmp_path, out, monkeypatch):
    sweep(tmp_path, out, depths(0.1))
    next((out / "points").iterdir()).write_text('{"half', "utf-8")
    monkeypatch.setenv("SOFTDOT_CACHE", str(tmp_path / "another"))
    presses.depths = []
    assert sweep(tmp_path, out, depths(0.1)) == 0
    assert presses.depths == [0.1]
    assert points(out)[0]["status"] == "solved"


def test_a_changed_program_solves_again(presses, tmp_path, out, monkeypatch):
    sweep(tmp_path, out, depths(0.1))
    monkeypatch.setattr(outcome_module, "source_hash", lambda _: "of another program")
    presses.depths = []
    sweep(tmp_path, out, depths(0.1))
    assert presses.depths == [0.1]


def test_a_changed_waveform_file_solves_again(presses, tmp_path, out):
    wave = tmp_path / "wave.csv"
    shape = {"key": "press.waveform", "values": [{"shape": "file", "file": str(wave)}]}
    wave.write_text("time_s,fraction\n0,0\n1,1\n", "utf-8")
    sweep(tmp_path, out, shape)
    wave.write_text("time_s,fraction\n0,0\n2,1\n", "utf-8")
    presses.depths = []
    sweep(tmp_path, out, shape)
    assert presses.depths == [0.05]


def test_a_design_that_stands_twice_in_a_list_is_solved_once(presses, tmp_path, out):
    sweep(tmp_path, out, depths(0.1, 0.1, 0.2), sampling="list")
    assert presses.depths == [0.1, 0.2]
    assert [row["point"] for row in rows(out)] == [0, 1, 2]


def test_half_written_files_of_a_killed_process_are_swept_up(tmp_path, out):
    sweep(tmp_path, out, depths(0.1))
    (out / ".sweep.parquet.part").write_text("half", "utf-8")
    (out / "points" / ".0123.json.part").write_text("half", "utf-8")
    sweep(tmp_path, out, depths(0.1, 0.2))
    assert list(out.rglob("*.part")) == []


def test_a_full_disk_is_one_sentence_and_the_points_stay(tmp_path, out, monkeypatch, capfd):
    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device", str(out / "sweep.parquet"))

    monkeypatch.setattr(store, "finish", full)
    assert sweep(tmp_path, out, depths(0.1)) == 2
    said = complaints(capfd.readouterr().err)
    assert said == f"softdot: '{out}/sweep.parquet' cannot be written: the disk is full\n"
    assert len(points(out)) == 1


def test_a_folder_with_something_else_is_refused(presses, tmp_path, out, capfd):
    out.mkdir()
    (out / "thesis.tex").write_text("mine", "utf-8")
    assert sweep(tmp_path, out, depths(0.1)) == 2
    assert "holds 'thesis.tex', which softdot did not write" in capfd.readouterr().err
    assert presses.depths == []


def test_lists_and_tables_as_values_come_back_as_they_were(out):
    paths = {"key": "press.path_xy_mm", "values": [[], [[0.1, 0.0]]]}
    glue = {"between": ["film", "medium2"], "normal_stiffness_N_per_mm3": 1.0, "shear_stiffness_N_per_mm3": 2.0}
    run_sweep(space_from(space_of(paths, {"key": "segment.bonds", "values": [[glue]]})), out)
    assert [row["press.path_xy_mm"] for row in rows(out)] == paths["values"]
    assert rows(out)[1]["segment.bonds"] == [glue]


def test_a_column_without_a_common_type_is_json(out):
    out.mkdir()
    write_table(out / store.TABLE, [{"a": 1}, {"a": "one", "b": 2.0}, {"a": [1]}])
    assert rows(out) == [{"a": "1", "b": None}, {"a": '"one"', "b": 2.0}, {"a": "[1]", "b": None}]


def test_a_sweep_is_a_csv_table_a_picture_and_a_page_too(presses, tmp_path, out):
    presses.failures = {0.2: "Newton's method found no state"}
    assert sweep(tmp_path, out, depths(0.1, 0.2, 0.3)) == 0
    lines = (out / "sweep.csv").read_text("utf-8").splitlines()
    assert len(lines) == 1 + 3
    assert lines[0].startswith("point,press.indentation_mm,status,reason")
    assert (out / "sweep.png").read_bytes()[:4] == b"\x89PNG"
    page = (out / "report.html").read_text("utf-8")
    assert "2 solved, 1 not-converged" in page
    assert "found no state" in page
    assert "http" not in page


@pytest.mark.usefixtures("presses")
def test_a_second_sweep_into_a_folder_is_refused_and_the_first_keeps_its_file(tmp_path, out):
    from foundation.scratch_folders import lock_folder, unlock_folder

    assert sweep(tmp_path, out, depths(0.1)) == 0
    half = out / "points" / ".half.json.part"
    half.write_text("half", "utf-8")
    held = lock_folder(out)
    try:
        assert sweep(tmp_path, out, depths(0.1, 0.2)) == 2
        assert half.exists()
    finally:
        unlock_folder(held)
    assert sweep(tmp_path, out, depths(0.1, 0.2)) == 0
    assert not half.exists()

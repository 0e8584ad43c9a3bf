"""The pipeline: what it writes, and what is left when something goes wrong."""

import errno
import json
import time
from contextlib import suppress
from pathlib import Path

import pytest

from export import rendering
from mesh.types import MeshingError
from softdot import run_folder
from softdot.cli import main
from softdot.commands import run
from softdot.second_process import SecondProcess
from tests.softdot.complaints import complaints
from tests.softdot.stand_ins import result_of


def entries(folder: Path) -> set[str]:
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}


EVERYTHING = {"summary.json", "log.txt", "report.html", "cad/segment.step", "results/segment.pvd", "pictures/force.png"}


@pytest.mark.usefixtures("stages")
def test_a_good_run_writes_everything_and_exits_0(tmp_path):
    out = tmp_path / "deep" / "out"
    assert main(["run", "-o", str(out)]) == 0
    assert entries(out) == EVERYTHING
    assert entries(tmp_path) == {f"deep/out/{name}" for name in EVERYTHING}


@pytest.mark.usefixtures("stages")
def test_summary_holds_what_was_solved(tmp_path):
    main(["run", "-o", str(tmp_path / "out")])
    summary = json.loads((tmp_path / "out/summary.json").read_text(encoding="utf-8"))
    assert summary["format"] == "softdot-run/1"
    assert summary["indentation_mm"] == pytest.approx([0.0, 0.15, 0.3])
    assert summary["reaction_force_N"] == pytest.approx([0.0, 1.5, 3.0])
    assert summary["film_charge_pC"] == pytest.approx([0.0, 3.0, 6.0])
    assert summary["open_circuit_voltage_V"] == pytest.approx([0.0, 0.3, 0.6])
    film = summary["film"]
    assert (film["capacitance_pF"], film["max_principal_strain"]) == pytest.approx((10.0, 0.01))
    assert (film["max_principal_stress_MPa"], film["rim_principal_stress_MPa"]) == pytest.approx((10.0, 30.0))
    assert (film["charge_density_pC_per_mm2"], film["rim_distance_mm"]) == (pytest.approx([0.0, 10.0]), 0.14)
    assert summary["sensitivity"]["voltage_per_mm"] == pytest.approx(2.0)
    assert summary["sensitivity"]["charge_pC_per_N"] == pytest.approx(2.0)
    assert summary["sensitivity"]["least_detectable_indentation_um"] == pytest.approx(0.5)  # 1 mV at 2 V/mm
    assert summary["solver"]["converged"] is True
    assert summary["solver"]["load_steps"] == 2
    assert summary["mesh"] == {"tetrahedra": 1, "symmetry_planes": [], "unknowns": 30}
    assert set(summary["timing_s"]) == {"geometry", "mesh", "solve", "uncertainty", "export"}
    assert summary["config"]["press"]["indentation_mm"] == 0.3
    assert summary["config"]["materials"]["vnr-soft"]["youngs_modulus_MPa"] == 1.0
    assert "readout_voltage_V" not in summary


@pytest.mark.usefixtures("stages")
def test_json_prints_the_summary_alone(tmp_path, capfd):
    assert main(["run", "-o", str(tmp_path / "out"), "--json"]) == 0
    printed = capfd.readouterr()
    assert json.loads(printed.out) == json.loads((tmp_path / "out/summary.json").read_text(encoding="utf-8"))
    assert complaints(printed.err) == ""


def test_json_is_not_spoilt_by_a_library_that_prints(tmp_path, capfd, stages):
    import os

    def noisy(*_):
        os.write(1, b"library chatter\n")
        return result_of([0.0, 0.3])

    stages.solve = noisy
    main(["run", "-o", str(tmp_path / "out"), "--json"])
    json.loads(capfd.readouterr().out)


@pytest.mark.usefixtures("stages")
def test_a_quiet_run_in_a_pipe_says_nothing(tmp_path, capfd):
    main(["run", "-o", str(tmp_path / "out"), "--quiet"])
    assert capfd.readouterr() == ("", "")


def test_a_press_that_stops_keeps_what_converged_and_exits_3(tmp_path, capfd, stages):
    stages.solve = lambda *_: result_of([0.0, 0.1], failure="step 2 of 3 stopped at 0.100 mm")
    assert main(["run", "-o", str(tmp_path / "out")]) == 3
    summary = json.loads((tmp_path / "out/summary.json").read_text(encoding="utf-8"))
    assert summary["solver"]["converged"] is False
    assert summary["solver"]["failure"] == "step 2 of 3 stopped at 0.100 mm"
    assert summary["indentation_mm"] == pytest.approx([0.0, 0.1])
    assert entries(tmp_path / "out") == EVERYTHING
    assert complaints(capfd.readouterr().err).splitlines() == [
        f"softdot: not converged, step 2 of 3 stopped at 0.100 mm; what converged is in '{tmp_path / 'out'}'"
    ]


def test_a_press_that_never_starts_gives_null_sensitivities(tmp_path, stages):
    stages.solve = lambda *_: result_of([0.0], failure="step 1 of 3 stopped at 0 mm")
    assert main(["run", "-o", str(tmp_path / "out")]) == 3
    summary = json.loads((tmp_path / "out/summary.json").read_text(encoding="utf-8"))
    assert summary["sensitivity"]["voltage_per_mm"] is None
    assert summary["sensitivity"]["charge_pC_per_N"] is None
    assert summary["sensitivity"]["least_detectable_indentation_um"] is None


def test_a_mesh_that_fails_keeps_the_cad_files_and_exits_3(tmp_path, capfd, stages):
    def fail(*_):
        raise MeshingError("the mesher took longer than 300 s")

    stages.mesh = fail
    assert main(["run", "-o", str(tmp_path / "out")]) == 3
    assert entries(tmp_path / "out") == {"summary.json", "log.txt", "cad/segment.step"}
    summary = json.loads((tmp_path / "out/summary.json").read_text(encoding="utf-8"))
    assert summary["solver"] == {
        "converged": False,
        "failure": "meshing: the mesher took longer than 300 s",
        "load_steps": 0,
    }
    assert "took longer than 300 s" in capfd.readouterr().err


@pytest.mark.usefixtures("stages")
def test_an_earlier_run_is_replaced_whole(tmp_path):
    out = tmp_path / "out"
    main(["run", "-o", str(out)])
    (out / "pictures/stale.png").write_text("of the earlier run", "utf-8")
    assert main(["run", "-o", str(out)]) == 0
    assert entries(tmp_path) == {f"out/{name}" for name in EVERYTHING}


def test_an_earlier_run_survives_a_failure(tmp_path, stages):
    out = tmp_path / "out"
    main(["run", "-o", str(out)])
    before = (out / "summary.json").read_text(encoding="utf-8")

    def fail(*_):
        raise ZeroDivisionError

    stages.solve = fail
    with pytest.raises(ZeroDivisionError):
        main(["run", "-o", str(out)])
    assert (out / "summary.json").read_text(encoding="utf-8") == before
    assert entries(tmp_path) == {f"out/{name}" for name in EVERYTHING}


@pytest.mark.parametrize("stage", ["parts", "mesh", "solve", "write_outputs"])
def test_ctrl_c_leaves_nothing(tmp_path, capfd, stages, stage):
    def interrupted(*_):
        raise KeyboardInterrupt

    setattr(stages, stage, interrupted)
    assert main(["run", "-o", str(tmp_path / "new" / "out")]) == 130
    assert list(tmp_path.iterdir()) == []
    assert complaints(capfd.readouterr().err) == "softdot: interrupted, nothing was written\n"


def does_nothing(*_):
    return 0.0


def writes_on_and_on(_mesh, _result, _dot, folder, *_):
    while True:
        with suppress(OSError):
            folder.mkdir(parents=True, exist_ok=True)


@pytest.mark.process
def test_a_failure_leaves_nothing_though_the_second_process_still_writes(tmp_path, capfd, stages, monkeypatch):
    def full(_dot, _result, _summary, folder, _pictures):
        end = time.monotonic() + 120.0
        while not (folder / "pictures").exists():
            assert time.monotonic() < end, "the second process does not write"
            time.sleep(0.01)
        raise OSError(errno.EFBIG, "File too large")

    monkeypatch.setattr(rendering, "ensure_rendering", does_nothing)
    monkeypatch.setattr(run, "SecondProcess", SecondProcess)
    monkeypatch.setattr(run_folder, "make_cad", does_nothing)
    monkeypatch.setattr(run_folder, "draw", writes_on_and_on)
    stages.write_outputs = full
    assert main(["run", "-q", "-o", str(tmp_path / "out")]) == 2
    assert "a limit of the size of files" in complaints(capfd.readouterr().err)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.usefixtures("stages")
def test_the_working_folder_can_be_the_output(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["run", "-o", "."]) == 0
    assert main(["run", "-o", "."]) == 0
    assert entries(tmp_path) == EVERYTHING
    assert Path.cwd() == tmp_path

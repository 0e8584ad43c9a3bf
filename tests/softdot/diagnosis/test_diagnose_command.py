"""softdot diagnose as a laboratory uses it: what is written, what is said, how it exits."""

import json
from dataclasses import replace

import numpy as np
import pytest

from diagnose.findings import LocatedExcess
from diagnose.forward import Setting
from diagnose.inference import diagnose as inference
from diagnose.verdict import resimulation
from diagnose.verdict.resimulation import Resimulation
from mesh.types import MeshingError
from softdot.commands import diagnose as run
from softdot.commands.diagnose import short_text
from softdot.config.loading import load_config
from softdot.config.rig import load_rig
from softdot.diagnosis import folder as engines
from softdot.diagnosis import report as page
from solve.solution.newton import NoEquilibriumError
from tests.diagnose.verdict.test_verdict import QUIET, SHAPE, require
from tests.diagnose.verdict.toy import LEAK, RELAXING, ToyEngine, fitted, found, toy_recording, toy_run
from tests.softdot.diagnosis.toy_rig import write_toy

pytestmark = pytest.mark.press

LEAKS, RELAXES = fitted(LEAK, 0.5), fitted(RELAXING, 0.3, 0.09)
NAMED = {"models": (LEAKS, RELAXES), "best": LEAKS, "groups": ((0,), (1,))}
UNEXPLAINED = {**NAMED, "best": None, "unexplained": True, "reasons": ("Its residual is larger than noise makes it.",)}


@pytest.fixture
def finding(monkeypatch):
    """Put hand-made findings in place of the inference."""

    def put(**parts):
        monkeypatch.setattr(inference, "diagnose", lambda recording, *_: found(recording, **parts))

    return put


def written(tmp_path):
    return sorted(str(path.relative_to(tmp_path / "out")) for path in (tmp_path / "out").rglob("*") if path.is_file())


def test_a_leak_is_found_named_and_switched_on(tmp_path, diagnosed):
    """With the real inference: 2 GOhm beside the input of a sensor that one can calculate by hand."""
    folder = write_toy(tmp_path / "rig", [Setting(LEAK, (0.5,))])
    status, verdict, said = diagnosed(folder)
    assert status == 0
    assert said == "".join(f"softdot: warning: {one}\n" for one in verdict["warnings"])
    require(verdict, SHAPE)
    (missing,) = verdict["missing_physics"]
    assert (missing["mechanism"], missing["component"]) == ("charge-leakage", "readout")
    assert missing["parameters"]["resistance_MOhm"]["value"] == pytest.approx(2000.0, rel=0.05)
    held_out = verdict["fit"]["held_out"]
    assert held_out["nrmse_after"] < 1.2 * held_out["noise_floor_nrmse"] < held_out["nrmse_before"]
    improved = load_config(tmp_path / "out" / "improved.toml")
    assert improved.mechanisms[0].parameters == {"resistance_MOhm": pytest.approx(2000.0, rel=0.05)}


@pytest.mark.usefixtures("pictures")
def test_runs_that_are_held_out_only_score(tmp_path, diagnosed):
    folder = write_toy(tmp_path / "rig", [Setting(LEAK, (0.5,))])
    first, *others = [run.label for run in load_rig(folder).recording.runs]
    status, verdict, said = diagnosed(folder, "--hold-out", first)
    assert status == 0
    assert said == "".join(f"softdot: warning: {one}\n" for one in verdict["warnings"])
    assert {press.partition(", press")[0] for press in verdict["fit"]["held_out"]["presses"]} == {first}
    assert {press.partition(", press")[0] for press in verdict["fit"]["train"]["presses"]} <= set(others)
    assert {place["run"] for place in verdict["where"]} <= set(others)
    assert " runs" not in verdict["summary"][0]  # those that are held out are not counted
    assert verdict["fit"]["held_out"]["nrmse_after"] < 1.2 * verdict["fit"]["held_out"]["noise_floor_nrmse"]
    roles = {one["run"]: one["role"] for one in verdict["fit"]["resimulated"]}
    assert roles[first] == "held-out"


@pytest.mark.parametrize(
    ("part", "sentence"),
    [
        ("no such", "--hold-out 'no such': no run has it in its label; they are "),
        ("", "--hold-out '': holds out every run; at least one has to stay"),
    ],
)
def test_runs_that_cannot_be_held_out(part, sentence, tmp_path, diagnosed):
    status, _, said = diagnosed(write_toy(tmp_path / "rig"), "--hold-out", part)
    assert status == 2
    assert sentence in said
    assert not (tmp_path / "out").exists()


def test_agreement_is_a_good_result(tmp_path, diagnosed):
    status, verdict, _ = diagnosed(write_toy(tmp_path / "rig"))
    assert status == 0
    require(verdict, QUIET)
    assert not verdict["mismatch"]
    html = (tmp_path / "out" / "report.html").read_text("utf-8")
    assert "Simulation and recordings agree" in html
    assert "box good" in html


@pytest.mark.usefixtures("pictures")
def test_what_is_written(tmp_path, diagnosed, finding):
    finding(**NAMED)
    status, verdict, _ = diagnosed(write_toy(tmp_path / "rig"))
    assert status == 0
    assert written(tmp_path) == [
        "improved.toml", "log.txt", "next-press.csv", "plots/components.png", "plots/gains.png", "plots/run-1.png",
        "plots/run-2.png", "plots/where.png", "report.html", "verdict.json",
    ]  # fmt: skip
    assert json.loads((tmp_path / "out" / "verdict.json").read_text("utf-8")) == verdict
    html = (tmp_path / "out" / "report.html").read_text("utf-8")
    assert html.count("data:image/png") == 5
    assert 'src="http' not in html
    assert "<script" not in html


def test_a_second_diagnosis_replaces_the_first(tmp_path, diagnosed, finding):
    folder = write_toy(tmp_path / "rig")
    finding(**NAMED)
    assert diagnosed(folder)[0] == 0
    finding(mismatch=False)
    assert diagnosed(folder)[0] == 0
    assert "next-press.csv" not in written(tmp_path)


def test_the_improved_configuration_is_the_users_own_with_one_table_more(tmp_path, diagnosed, finding):
    finding(**NAMED)
    folder = write_toy(
        tmp_path / "rig", more='[[mechanisms]]\nname = "friction"\ncomponent = "dot"\nparameters.coefficient = 0.2\n'
    )
    diagnosed(folder)
    improved = load_config(tmp_path / "out" / "improved.toml")
    assert [one.name for one in improved.mechanisms] == ["friction", "charge-leakage"]
    changed = {"mechanisms", "press"}
    assert improved.model_dump(exclude=changed) == load_rig(folder).config.model_dump(exclude=changed)
    assert improved.press.waveform.hold_s == pytest.approx(0.5, abs=0.03)
    assert improved.press.indentation_mm == pytest.approx(0.3, rel=0.01)
    assert "# as its data sheet says" in (tmp_path / "out" / "improved.toml").read_text("utf-8")


@pytest.mark.parametrize("parts", [UNEXPLAINED, {"mismatch": False}])
def test_where_nothing_is_named_the_configuration_stays(tmp_path, diagnosed, finding, parts):
    finding(**parts)
    diagnosed(write_toy(tmp_path / "rig"))
    text = (tmp_path / "out" / "improved.toml").read_text("utf-8")
    assert text.startswith("# Your rig.toml unchanged: the diagnosis named nothing that was left out.")
    assert load_config(tmp_path / "out" / "improved.toml").mechanisms == ()


def test_the_next_press_can_be_run(tmp_path, diagnosed, finding):
    """As a motion: increasing time, from clear of the dot to a depth that was pressed before, and back."""
    finding(**NAMED)
    _, verdict, _ = diagnosed(write_toy(tmp_path / "rig"))
    assert verdict["next_experiment"]["waveform"] == "next-press.csv"
    lines = (tmp_path / "out" / "next-press.csv").read_text("utf-8").splitlines()
    assert lines[0] == "time_s,displacement_mm"
    time_s, depth = np.array([line.split(",") for line in lines[1:]], dtype=float).T
    assert (np.diff(time_s) > 0.0).all()
    assert depth[0] <= 0.0
    assert depth[-1] <= 0.0
    assert depth.max() == pytest.approx(0.3, rel=0.02)


def test_the_page_opens_with_the_verdict(tmp_path, diagnosed, finding):
    finding(**NAMED)
    _, verdict, _ = diagnosed(write_toy(tmp_path / "rig"))
    html = (tmp_path / "out" / "report.html").read_text("utf-8")
    first = html.index('<section class="box found"')
    assert html.index("charge leaks through the amplifier; resistance 2000 MΩ") > first
    assert html.index("</section>") > html.index("Next:</strong>")
    assert verdict["summary"][0] in html


def test_labels_of_runs_cannot_break_the_page(tmp_path, diagnosed, finding):
    finding(**NAMED)
    diagnosed(write_toy(tmp_path / "rig", runs=(toy_run("<b>1 & 2</b>".replace("/", "|")), toy_run("quick"))))
    assert "<b>1 &" not in (tmp_path / "out" / "report.html").read_text("utf-8")


def test_a_named_mechanism_that_the_full_model_cannot_press(tmp_path, diagnosed, finding, monkeypatch):
    finding(**NAMED)

    def no_equilibrium(*_):
        raise NoEquilibriumError("step 3 found no equilibrium", np.zeros(1), 0)

    monkeypatch.setattr(ToyEngine, "solve", no_equilibrium)
    status, verdict, said = diagnosed(write_toy(tmp_path / "rig"))
    assert status == 3
    assert "step 3 found no equilibrium; the verdict without it is in" in said
    assert said.count("\n") == 1
    assert verdict["fit"]["resimulated"] == []
    assert "verdict.json" in written(tmp_path)


def test_a_limit_of_time_is_told_and_can_be_lifted(tmp_path, diagnosed, finding, monkeypatch):
    finding(**NAMED)
    folder = write_toy(tmp_path / "rig")
    monkeypatch.setattr(run, "FULL_MODEL_S", -1.0)
    status, verdict, _ = diagnosed(folder)
    assert status == 0
    assert verdict["warnings"][-1].endswith("--all-presses checks every run")
    assert len(diagnosed(folder, "--all-presses")[1]["fit"]["resimulated"]) == 2


def test_the_full_model_can_be_left_out_and_that_is_told(tmp_path, diagnosed, finding):
    finding(**NAMED)
    _, verdict, _ = diagnosed(write_toy(tmp_path / "rig"), "--fast-model-only")
    assert verdict["fit"]["resimulated"] == []
    assert verdict["warnings"][-1] == engines.UNCHECKED_SENTENCE


@pytest.mark.parametrize(
    "error", [NoEquilibriumError("it found no equilibrium", np.zeros(1), 0), MeshingError("it found no equilibrium")]
)
def test_a_baseline_that_cannot_be_solved_writes_nothing(tmp_path, diagnosed, monkeypatch, error):
    def unsolved(*_):
        raise error

    monkeypatch.setattr(engines, "engine_for", unsolved)
    status, verdict, said = diagnosed(write_toy(tmp_path / "rig"))
    assert (status, verdict) == (3, None)
    assert said == "softdot: diagnose, it found no equilibrium; nothing was written\n"
    assert not (tmp_path / "out").exists()


def test_ctrl_c_leaves_nothing(tmp_path, diagnosed, finding, monkeypatch):
    finding(**NAMED)

    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(resimulation, "_resimulate_run", interrupted)
    status, verdict, said = diagnosed(write_toy(tmp_path / "rig"))
    assert (status, verdict) == (130, None)
    assert said == "softdot: interrupted, nothing was written\n"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["rig"]


def test_the_seed_is_that_of_the_rig_unless_told(tmp_path, diagnosed, finding):
    finding(**NAMED)
    folder = write_toy(tmp_path / "rig")
    (folder / "rig.toml").write_text("seed = 5\n" + (folder / "rig.toml").read_text("utf-8"), "utf-8")
    assert diagnosed(folder)[1]["seed"] == 5
    assert diagnosed(folder, "--seed", "7")[1]["seed"] == 7
    assert diagnosed(folder, "--seed", "-1") == (2, None, "softdot: --seed = -1: must be at least 0\n")


def test_another_folder_is_refused_before_any_work(tmp_path, diagnosed, monkeypatch):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "thesis.tex").write_text("mine", "utf-8")
    monkeypatch.setattr(engines, "engine_for", lambda *_: pytest.fail("work began"))
    status, _, said = diagnosed(write_toy(tmp_path / "rig"))
    assert status == 2
    assert "holds 'thesis.tex', which softdot did not write" in said


def test_a_short_text_for_a_terminal(tmp_path, diagnosed, finding):
    finding(**NAMED)
    _, verdict, _ = diagnosed(write_toy(tmp_path / "rig"))
    lines = short_text(verdict, "out").splitlines()
    assert lines[0].startswith("Your simulation of the voltage is")
    assert lines[-1] == "out/report.html"


def test_what_the_full_model_pressed_is_drawn_first():
    """Then what differs most, and not all of many runs."""
    recording = toy_recording(runs=tuple(toy_run(f"run {n}") for n in range(6)))
    places = [LocatedExcess(f"run {n}", "voltage_V", "hold", 0, (0.0, 2.0), 9.0, 1e-3, 0.1 * n, "") for n in range(6)]
    findings = replace(found(recording, **NAMED), places=tuple(places))
    pressed = Resimulation("run 1", "held-out", "3D FEM", {}, {}, {}, {})
    drawn = page.runs_to_draw(recording, findings, [pressed])
    assert [label for label, _ in drawn] == ["run 1", "run 5", "run 4", "run 3"]

"""softdot prove: its folder, its exit codes and going on after a stop. No case is diagnosed here."""

import json
from dataclasses import asdict

import pytest

from softdot.cli import main
from softdot.studies.proof import proof_folder as store
from softdot.studies.proof import run
from softdot.studies.proof.commitment import seal
from softdot.studies.proof.world.cases import LEFT_OUT, NONE, OUTSIDE

RIDGES = "ridge-clamped,ridge-free"


@pytest.fixture
def tried(monkeypatch):
    """Cases end at once: whatever is hidden is named exactly, unless the tool cannot know it."""
    numbers = []

    def fake(missing, _request, place, program):
        store.begin(place)
        for case in missing:
            numbers.append(case.number)
            truth = {"kind": case.kind, "whitened_rms": case.size, "mechanisms": []}
            sealed = seal(truth)
            store.commit(place, case.name, sealed.digest)
            name = () if case.kind in (NONE, LEFT_OUT, OUTSIDE) else (("charge-leakage", "readout"),)
            right = bool(name)
            score = {
                "case": case.number, "kind": case.kind, "bench": case.bench, "truth": name, "size": case.size,
                "detected": case.kind != NONE, "named": name, "abstained": not right, "exact": right,
                "grouped": right, "mechanism": right, "component": right,
            }  # fmt: skip
            record = {
                "case": asdict(case), "truth": truth, "salt": sealed.salt, "digest": sealed.digest, "status": "scored",
                "reason": None, "score": score, "program": program, "verdict": {},
                "rivals": {"always leakage": {"detected": True, "named": ["charge-leakage", "readout"], "after": 2.0}},
            }  # fmt: skip
            store.keep(place, case.name, record)
            yield case.name, record

    monkeypatch.setattr(run, "_try_cases", fake)
    return numbers


@pytest.mark.usefixtures("tried")
def test_a_proof_counts_and_writes_all_that_it_promises(tmp_path, capsys):
    out = tmp_path / "proof"
    assert main(["prove", "--cases", "40", "--staged", "--rigs", RIDGES, "-o", str(out), "--json"]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["ended"] == {"scored": 40}
    assert summary["rates"]["false_names_without_effect"]["count"] == 0
    assert summary["rates"]["clear_exact"]["rate"] == 1.0
    assert summary["rivals"]["always leakage"]["false_names_without_effect"]["rate"] == 1.0
    assert {path.name for path in out.iterdir()} == {"proof.json", "proof.md", "detection.png", "cases", "commitments"}
    report = (out / "proof.md").read_text(encoding="utf-8")
    assert "not run: pysindy" in report or "sparse regression" in summary["rivals"]


@pytest.mark.usefixtures("tried")
def test_without_effects_there_is_no_curve_to_draw(tmp_path):
    out = tmp_path / "proof"
    assert main(["prove", "--cases", "2", "--kinds", "none", "-o", str(out)]) == 0
    assert not (out / "detection.png").exists()
    assert "detection.png" not in (out / "proof.md").read_text(encoding="utf-8")


@pytest.mark.usefixtures("tried")
def test_one_mechanism_on_the_rig_with_channels(tmp_path):
    out = tmp_path / "proof"
    command = ["prove", "--cases", "3", "--rigs", "row-free", "--kinds", "single", "--mechanisms", "crosstalk"]
    assert main([*command, "-o", str(out)]) == 0
    cases = [json.loads(path.read_text("utf-8")) for path in sorted((out / "cases").iterdir())]
    hidden = {tuple(one["case"]["effects"]) for one in cases}
    assert hidden == {("crosstalk-1-2",), ("crosstalk-2-3",), ("crosstalk-1-3",)}
    assert json.loads((out / "proof.json").read_text("utf-8"))["mechanisms"] == ["crosstalk"]


def test_a_proof_that_was_stopped_goes_on(tried, tmp_path):
    command = ["prove", "--staged", "--rigs", RIDGES, "-o", str(tmp_path / "proof"), "--cases"]
    assert main([*command, "10"]) == 0
    (tmp_path / "proof" / "cases" / "case-0003.json").unlink()
    assert main([*command, "20"]) == 0
    assert sorted(tried[10:]) == [3, *range(11, 21)]


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["--cases", "0"], "--cases 0: must be at least 1"),
        (["--cases", "1", "--seed", "-1"], "--seed -1: must not be negative"),
        (["--cases", "1", "--rigs", "table"], "--rigs 'table': must be of ridge-clamped"),
        (["--cases", "1", "--kinds", "triple"], "--kinds 'triple': must be of none"),
        (["--cases", "1", "--mechanisms", "crosstalk"], "--mechanisms 'crosstalk': must be of those that these rigs"),
        (["--cases", "1", "--mechanisms", "friction"], "can hide: charge-leakage, low-pass"),
        (["--cases", "1", "--workers", "0"], "--workers 0: must be at least 1"),
        (["--cases", "1", "--scheduler", "here"], "--scheduler 'here': must be tcp://HOST:PORT"),
    ],
)
def test_bad_input_is_one_sentence(arguments, sentence, tmp_path, capsys):
    assert main(["prove", *arguments, "-o", str(tmp_path / "proof")]) == 2
    assert sentence in capsys.readouterr().err
    assert not (tmp_path / "proof").exists()


def test_without_the_other_code_it_says_what_to_install(monkeypatch, tmp_path, capsys):
    monkeypatch.setattr("softdot.commands.prove.find_spec", lambda _: None)
    assert main(["prove", "--cases", "1", "-o", str(tmp_path / "proof")]) == 2
    assert "pip install 'softdot[prove]'" in capsys.readouterr().err


def test_a_foreign_folder_is_left_alone(tmp_path, capsys):
    (tmp_path / "diary.txt").write_text("dear", "utf-8")
    assert main(["prove", "--cases", "1", "-o", str(tmp_path)]) == 2
    assert "diary.txt" in capsys.readouterr().err


@pytest.mark.usefixtures("tried")
def test_a_proof_that_was_killed_while_it_wrote_goes_on(tmp_path):
    command = ["prove", "--staged", "--rigs", RIDGES, "-o", str(tmp_path / "proof"), "--cases", "4"]
    assert main(command) == 0
    (tmp_path / "proof" / ".proof.json.part").write_text("{", "utf-8")
    assert main(command) == 0


def test_no_verdict_at_all_exits_3(monkeypatch, tmp_path, capsys):
    def fail(missing, _request, place, _program):
        store.begin(place)
        yield from ((case.name, {"status": "crashed", "reason": "no", "score": None}) for case in missing)

    monkeypatch.setattr(run, "_try_cases", fail)
    assert main(["prove", "--cases", "2", "--rigs", RIDGES, "-o", str(tmp_path / "proof")]) == 3
    assert "not one of 2 cases has a verdict" in capsys.readouterr().err

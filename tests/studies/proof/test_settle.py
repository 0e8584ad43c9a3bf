"""The press that a verdict asks for, as the hidden world makes it."""

from dataclasses import replace

import numpy as np
import pytest

from softdot.studies.proof import trial
from softdot.studies.proof.asked_presses import asked_run, with_asked
from softdot.studies.proof.isolation import Heard
from softdot.studies.proof.recording_folder import rig_text
from softdot.studies.proof.score import score_verdict
from softdot.studies.proof.trial import Terms
from softdot.studies.proof.world.cases import AMBIGUOUS, Case
from softdot.studies.proof.world.reality import baseline, record
from softdot.studies.proof.world.rigs import CLAMPED, VOLTAGE_ONLY

TIME = np.arange(0.0, 4.0, 0.004)
TWICE = 0.25 * np.clip(np.minimum(np.abs(TIME - 2.0) - 0.2, 1.8 - np.abs(TIME - 2.0)) / 0.4, -0.1, 1.0)
WAVE = "time_s,displacement_mm\n" + "\n".join(f"{t:.9g},{u:.9g}" for t, u in zip(TIME, TWICE, strict=True))
CASE = Case(20, 7, AMBIGUOUS, VOLTAGE_ONLY.name, ("cable",), 5.0)
CABLE = {"mechanism": "parasitic-capacitance", "component": "readout"}
WEAK = {"mechanism": "property-error", "component": "film"}
GLUE = {"mechanism": "adhesive-compliance", "component": "bond-base"}
LEAK = {"mechanism": "charge-leakage", "component": "readout"}


def experiment(**changes):
    return {"as_in": "slow and deep", "changes": changes, "waveform": "next-press.csv", "then": []}


def test_the_stage_follows_the_path_with_round_corners():
    run = asked_run(VOLTAGE_ONLY, experiment(cycles=2), WAVE)
    path = run.depth(run.times(250.0))
    assert path.max() == pytest.approx(0.25, rel=1e-6)
    assert np.abs(path - TWICE).max() < 0.02 * 0.25
    assert np.abs(np.diff(path, 2)).max() < 0.5 * np.abs(np.diff(TWICE, 2)).max()
    assert TWICE[run.lead_s < TIME][0] > 0.0 >= TWICE[run.lead_s > TIME][-1]
    first, second = np.flatnonzero(np.diff((TWICE > 0.0).astype(int)) > 0)
    np.testing.assert_array_equal(run.presses_before(TIME[[0, first + 5, second - 5, second + 5]]), [0, 0, 0, 1])


def test_resistor_and_capacitor_are_those_that_were_asked_for():
    run = asked_run(CLAMPED, experiment(input_resistance_MOhm=100.0, input_capacitance_pF=1100.0), WAVE)
    assert (run.resistance_MOhm, run.added_pF) == (100.0, 1000.0)
    longer = replace(CLAMPED, runs=(*CLAMPED.runs, run))
    assert "readout = { input_resistance_MOhm = 100, input_capacitance_pF = 1100 }" in rig_text(longer)


def test_a_dot_that_has_to_be_as_warm_as_the_film_cannot_be_had_here():
    assert asked_run(CLAMPED, experiment(dot_temperature="of the film"), WAVE) is None


def test_the_longer_recording_begins_with_what_there_was(monkeypatch):
    more = {"time_s": TIME, "of": "the same specimen"}
    monkeypatch.setattr("softdot.studies.proof.asked_presses.press_again", lambda *_: more)
    before = [{"time_s": TIME}] * 4
    warm = {**experiment(dot_temperature="of the film"), "waveform": "next-press-2.csv"}
    slow = {**experiment(speed_factor=0.1), "waveform": "next-press-3.csv"}
    asked = {**experiment(), "then": [warm, slow]}
    waves = {f"next-press{number}.csv": WAVE for number in ("", "-2", "-3")}
    bench, runs = with_asked(CASE, before, asked, waves)
    assert runs[:4] == before
    assert (len(bench.runs), runs[4:]) == (6, [more, more])
    assert with_asked(CASE, before, {**warm, "then": []}, waves) is None


@pytest.mark.evidence
def test_a_load_cell_that_was_asked_for_records_the_force_of_that_run_alone():
    run = asked_run(VOLTAGE_ONLY, experiment(records="force_N"), WAVE)
    (signals,) = record(baseline(VOLTAGE_ONLY), replace(VOLTAGE_ONLY, runs=(run,)))
    assert signals["force_N"].max() > 1.0
    text = rig_text(replace(VOLTAGE_ONLY, runs=(*VOLTAGE_ONLY.runs, run)))
    assert text.count("force_gain") == 1


@pytest.mark.parametrize(
    ("named", "groups", "resolved", "left"),
    [
        ([CABLE], [], True, 1),
        ([CABLE], [[CABLE, WEAK]], False, 2),
        ([WEAK], [], False, 0),
        ([], [], False, 0),
        ([], [[CABLE, WEAK, GLUE, LEAK]], False, 4),
        ([], [[WEAK, GLUE, LEAK]], False, 0),
    ],
)
def test_only_the_truth_alone_is_a_resolved_group(named, groups, resolved, left, monkeypatch):
    truth = {
        "number": 20, "kind": AMBIGUOUS, "bench": VOLTAGE_ONLY.name, "whitened_rms": 5.0, "per_run": {},
        "mechanisms": [{**CABLE, "values": {}}],
    }  # fmt: skip
    verdict = {
        "mismatch": True, "unexplained": not named, "ambiguous_with": groups,
        "missing_physics": [{**one, "parameters": {}} for one in named],
    }  # fmt: skip
    monkeypatch.setattr(trial, "diagnose_isolated", lambda *_: Heard(verdict, "", 1.0))
    monkeypatch.setattr(trial, "_score", lambda _, t, v, s: score_verdict(t, v, lambda _: 0.5, s))
    assert trial._settle(CASE, Terms("."), truth, {})[1:] == (resolved, left)

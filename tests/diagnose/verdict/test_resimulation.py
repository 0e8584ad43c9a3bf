"""Runs by the full model: the shortest first, both roles, within the time, with its own error told."""

import time
from dataclasses import replace

import pytest

from diagnose.forward import Candidate, Coordinate, Setting
from diagnose.verdict.resimulation import OutOfTimeError, resimulate
from tests.diagnose.verdict.toy import LEAK, ToyEngine, fitted, found, toy_recording, toy_run

LEAKS = fitted(LEAK, 0.5)


@pytest.fixture(scope="module")
def recording():
    runs = [toy_run(name, rows=rows) for name, rows in (("long", 400), ("a", 320), ("b", 300), ("b 2", 350))]
    return toy_recording([Setting(LEAK, (0.5,))], tuple(runs))


def findings_of(recording, train, held_out):
    findings = found(recording, (LEAKS,), LEAKS, ((0,),))
    fit = findings.train
    return replace(findings, train=replace(fit, presses=train), held_out=replace(fit, presses=held_out))


def pressed(recording, findings, limit_s=60.0, engine=None, report=lambda *_: None):
    return list(resimulate(recording, engine or ToyEngine(recording), findings, report, limit_s))


def test_the_shortest_run_of_each_role_within_the_limit(recording):
    findings = findings_of(recording, ("long, press 1", "a, press 1"), ("b, press 1", "b 2, press 1"))
    assert [(one.run, one.role) for one in pressed(recording, findings)] == [("a", "training"), ("b", "held-out")]


def test_without_a_limit_all_runs(recording):
    findings = findings_of(recording, ("long, press 1", "a, press 1"), ("b, press 1", "b 2, press 1"))
    everything = [(one.run, one.role) for one in pressed(recording, findings, None)]
    assert everything == [("a", "training"), ("b", "held-out"), ("b 2", "held-out"), ("long", "training")]


def test_the_only_run_is_pressed_once():
    recording = toy_recording([Setting(LEAK, (0.5,))], (toy_run("one"),))
    (one,) = pressed(recording, findings_of(recording, ("one, press 1",), ("one, press 1",)))
    assert one.role == "training and held-out"


def test_the_error_of_the_fast_model_is_measured(recording):
    engine = ToyEngine(recording, full_error=0.02)
    one = pressed(recording, findings_of(recording, ("a, press 1",), ("b, press 1",)), engine=engine)[0]
    assert one.reduced_error["voltage_V"] == pytest.approx(0.02 / 1.02)


def test_hum_keeps_its_fitted_phase(recording):
    """The engine is never asked for it, as it knows nothing of the phase in this run."""
    hum = Candidate("mains-hum", "readout", (Coordinate("sine", -1.0, 1.0, (0.1,)),), lambda v: {"amplitude_V": v[0]})
    both = replace(LEAKS, settings=(*LEAKS.settings, Setting(hum, (0.01,))))
    findings = findings_of(recording, ("a, press 1",), ("b, press 1",))
    wave = {label: {"voltage_V": 0.01 + its["voltage_V"]} for label, its in findings.improved.items()}
    one = pressed(recording, replace(findings, best=both, improved=wave))[0]
    assert one.signals["voltage_V"] == pytest.approx(wave["a"]["voltage_V"])


def test_nothing_is_pressed_where_nothing_is_named(recording):
    assert pressed(recording, found(recording, (LEAKS,), None, ((0,),), unexplained=True)) == []


def test_the_limit_ends_the_work(recording):
    findings = findings_of(recording, ("a, press 1",), ("b, press 1",))
    with pytest.raises(OutOfTimeError, match=r"checking with the full 3D model was stopped after 0.01 s"):
        pressed(recording, findings, 0.01, report=lambda *_: time.sleep(0.02))

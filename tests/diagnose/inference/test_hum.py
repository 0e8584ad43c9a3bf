"""Mains hum is noise where it is weak and a mechanism where it outweighs all other noise."""

from functools import cache

import numpy as np
import pytest

from diagnose.inference.diagnose import diagnose
from diagnose.inference.hum import HumEngine, loud_lines, without
from diagnose.noise.estimate import noise_models
from tests.diagnose.inference.toy import CANDIDATES, ToyEngine, one, silent, small

HUM = one("mains-hum", "readout", "amplitude_V", 0.0, 1.0, 0.1)


class Humming(ToyEngine):
    """The engine's own hum: a sine that starts with the record."""

    def predict(self, run, settings):
        hum = sum(s.values[0] for s in settings if s.candidate is HUM)
        signals = super().predict(run, [s for s in settings if s.candidate is not HUM])
        time = self.recording.runs[run].time_s
        return signals | {"voltage_V": signals["voltage_V"] + hum * np.sin(2.0 * np.pi * 50.0 * time)}


@cache
def hummed(amplitude):
    recording = small(9, runs=3, rate=400.0, duration=5.0)
    for phase, run in enumerate(recording.runs):
        run.channels["voltage_V"] += amplitude * np.sin(2.0 * np.pi * 50.02 * run.time_s + phase)
    return recording, Humming(recording, candidates=(*CANDIDATES[:2], HUM))


def test_only_loud_lines_leave_the_noise():
    recording, engine = hummed(0.05)
    noise = noise_models(recording)
    loud = loud_lines(recording, noise)
    assert set(loud) == {(run.label, "voltage_V") for run in recording.runs}
    assert not without(noise, loud)["run 0", "voltage_V"].lines
    weak, _ = hummed(0.001)
    assert not loud_lines(weak, noise_models(weak))
    assert HUM not in HumEngine(engine, weak, {}).candidates


@pytest.mark.press
def test_loud_hum_is_named_with_its_amplitude_whatever_its_phase():
    findings = diagnose(*hummed(0.05), 1, silent)
    assert findings.best is not None
    assert findings.best.settings[0].candidate.name == ("mains-hum", "readout")
    assert findings.held_out is None or findings.held_out.excess_after < 0.1 * findings.held_out.excess_before
    (numbers,) = findings.best.parameters
    assert numbers["amplitude_V"].value == pytest.approx(0.05, rel=0.1)
    assert numbers["frequency_Hz"].value == pytest.approx(50.02, abs=0.02)


def test_weak_hum_is_no_mismatch():
    assert not diagnose(*hummed(0.001), 1, silent).mismatch

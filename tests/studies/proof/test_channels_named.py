"""What is the matter between channels, hidden by the generator's circuit and told by the diagnosis' own.

Both get the same presses, which cost nothing: what each electrode collects is a power of the depth.
"""

from dataclasses import replace

import numpy as np
import pytest

from diagnose.engines.segment.drive import model_drive
from diagnose.engines.segment.response import FilmPlate, Mechanics, channel_signals
from diagnose.inference.diagnose import diagnose
from diagnose.signals.time_scales import time_scales
from diagnose.vocabulary.base import candidates_of_segment
from diagnose.vocabulary.scene import Scene
from softdot.config.model import model_of
from softdot.config.rig import load_rig
from softdot.studies.proof.recording_folder import files
from softdot.studies.proof.world import cases, reality, rigs
from softdot.studies.proof.world.effects import apply_effects
from softdot.studies.proof.world.march import Course, Table
from solve.mechanisms import with_mechanisms

DEPTH_MM = np.linspace(0.0, 0.3, 13)
COLLECTED = {-2.5: (1.0, 0.15, 0.01), 0.0: (0.2, 1.6, 0.2)}
"""Share of the charge of each electrode by the place of the dot."""
BENCH = replace(rigs.ROW, runs=rigs.ROW.runs[:2], rate_Hz=125.0)


def pressed(made, _depth_mm=0.0):
    power = DEPTH_MM**1.5
    charges = 2.4e4 * power[:, None] * np.array(COLLECTED[made.offset_mm])
    return Table(DEPTH_MM, Course(30.0 * power, charges, DEPTH_MM))


class Known:
    """An engine that knows the presses: only what stands behind the film may be missing."""

    name, accuracy, shortfalls, free_nuisances = "known presses", {"force_N": 0.003, "voltage_V": 0.003}, (), ()

    def __init__(self, rig, among):
        self.recording, self.model = rig.recording, model_of(rig.config)
        scene = Scene(
            self.model, tuple(r.readout for r in rig.recording.runs), 0.25, 4.0, 25.0, time_scales(rig.recording), 3
        )
        behind = [c for c in candidates_of_segment(scene) if c.traits.electrical and c.traits.acts_on_tables]
        self.candidates = tuple(c for c in behind if not among or c.mechanism in among)
        self.film = FilmPlate(1e-12 * np.column_stack([BENCH.made.capacitances_pF, np.full(3, 23e6)]), 30.0)

    def nuisance(self, _name):
        """None that goes through the model."""

    def prepare(self, _candidates, _report):
        """Nothing to press."""

    prepare_roughly = prepare

    def refine(self, _settings, _report):
        return ()

    def predict(self, number, settings):
        run = self.recording.runs[number]
        on = [setting.candidate.as_mechanism(setting.values) for setting in settings if any(setting.values)]
        model = with_mechanisms(replace(self.model, readout=run.readout), on)
        drive = model_drive(run, self.recording.phases[number])
        course = pressed(replace(BENCH.made, offset_mm=run.dot_offset_mm[0])).at(np.maximum(drive.values, 0.0))
        found = Mechanics(drive.values, course.force_N, course.area_mm2, 1e-12 * course.charge_pC)
        return channel_signals(run, run.answers, drive, drive.values, found, self.film, model)

    def imagine(self, _run, _settings):
        raise ValueError("only the presses that were made are known")


def told(effect, strength, folder, among=()):
    """What is named in a recording with an effect, among all that stands behind the film or some of it."""
    rng = np.random.default_rng(3)
    believed = replace(reality.baseline(BENCH), nuisance={("gain", 0, 1): 0.02, ("lag_s", 1, 2): 0.001})
    hidden = apply_effects(believed, BENCH, {effect: strength} if effect else {})
    runs = [cases._noisy(run, BENCH, rng) for run in reality.record(hidden, BENCH)]
    for name, text in files(BENCH, runs).items():
        (folder / name).write_text(text, "utf-8")
    rig = load_rig(folder)
    return diagnose(rig.recording, Known(rig, among), 0, lambda *_: None)


@pytest.fixture(autouse=True)
def known_presses(monkeypatch):
    monkeypatch.setattr(reality, "table", pressed)


def named(findings):
    assert findings.best is not None, findings.reasons
    return [setting.candidate.name for setting in findings.best.settings]


@pytest.mark.press
def test_a_pair_is_told_from_the_other_pairs_and_from_leaks(tmp_path):
    found = told("crosstalk-2-3", 15.0, tmp_path, ("crosstalk", "charge-leakage"))
    assert named(found) == [("crosstalk", "channel-2-channel-3")]


@pytest.mark.evidence
@pytest.mark.parametrize(
    ("effect", "strength", "name"),
    [
        ("crosstalk-1-2", 15.0, ("crosstalk", "channel-1-channel-2")),
        ("crosstalk-2-3", 15.0, ("crosstalk", "channel-2-channel-3")),
        ("crosstalk-1-3", 15.0, ("crosstalk", "channel-1-channel-3")),
        ("leakage-2", 1.0, ("charge-leakage", "channel-2")),
        ("low-pass-3", 5.0, ("low-pass", "channel-3")),
    ],
)
def test_channels_are_named_among_all_that_stands_behind_the_film(effect, strength, name, tmp_path):
    assert named(told(effect, strength, tmp_path)) == [name]


def test_film_that_hands_on_its_stretch_is_no_crosstalk(tmp_path):
    findings = told("", 0.0, tmp_path)
    assert not findings.mismatch

"""A stage that trembles: force and voltage show it together, and a mechanism is named beside it."""

from dataclasses import replace

import numpy as np
import pytest

from diagnose.findings import Grade
from diagnose.fit.drive_error import likeliest_drive_error
from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.samples import Samples
from diagnose.inference.diagnose import diagnose
from diagnose.noise.estimate import noise_models
from diagnose.signals.recording import Recording
from tests.diagnose.inference.toy import CANDIDATES, Sensor, ToyEngine, concealed, silent, small

LEVEL = 1e-3
TREMBLE_MM, FASTEST_HZ = 0.002, 4.0


def trembling(seed, sensor, rms_mm=TREMBLE_MM, drift=0.0, **more):
    """Recorded while the stage was off what its encoder says; drift of the voltage over each run besides."""
    recording = small(seed, sensor, **more)
    rng, runs = np.random.default_rng(seed + 1), []
    for run in recording.runs:
        tones, turns = rng.uniform(0.3, FASTEST_HZ, 6), rng.uniform(0.0, 2.0 * np.pi, 6)
        waves = np.sin(2.0 * np.pi * np.outer(run.time_s, tones) + turns).sum(axis=1) / np.sqrt(3.0)
        still, moved = (sensor.answers(run.time_s, run.drive_values + by) for by in (0.0, rms_mm * waves))
        shown = {name: run.channels[name] + moved[name] - still[name] for name in run.answers}
        if "voltage_V" in shown:
            shown["voltage_V"] = shown["voltage_V"] + drift * run.time_s / run.time_s[-1]
        runs.append(replace(run, channels={**run.channels, **shown}))
    return Recording(tuple(runs))


class Shallow(ToyEngine):
    """Has no answer below a depth."""

    deepest_mm: float = np.inf

    def imagine(self, run, settings):
        if run.drive_values.max() > self.deepest_mm:
            raise ValueError("deeper than was prepared")
        return super().imagine(run, settings)


def learned(recording, names=None, deepest_mm=np.inf):
    """Beside a model that knows the sensor."""
    if names is not None:
        runs = tuple(replace(run, channels={n: run.channels[n] for n in (run.drive, *names)}) for run in recording.runs)
        recording = Recording(runs)
    engine = Shallow(recording)
    engine.deepest_mm = deepest_mm
    model = ObservedModel(Samples(recording, noise_models(recording)), engine)
    return likeliest_drive_error(model, np.zeros(len(model.nuisances)), (), LEVEL)


def test_its_size_and_band_are_those_of_the_tremor():
    found = learned(trembling(3, Sensor(), noise=1e-3, scatter=0.0))
    assert found.rms_mm == pytest.approx(TREMBLE_MM, rel=0.25)
    assert found.band_Hz == 5.0


def test_a_still_stage_has_none():
    assert learned(small(3, Sensor(), noise=1e-3, scatter=0.0)) is None


def test_what_one_channel_shows_alone_is_none():
    assert learned(trembling(3, Sensor(), rms_mm=0.0, drift=0.05, noise=1e-3, scatter=0.0)) is None
    assert learned(trembling(3, Sensor(), noise=1e-3, scatter=0.0), ["force_N"]) is None


def test_a_stage_that_trembles_more_than_an_ordinary_one_is_not_excused():
    assert learned(trembling(3, Sensor(), rms_mm=0.02, noise=1e-3, scatter=0.0)) is None


def test_where_the_model_has_no_answer_there_is_none():
    """It needs one as deep as the recording goes, and no deeper."""
    recording = trembling(3, Sensor(), noise=1e-3, scatter=0.0)
    deepest = max(run.drive_values.max() for run in recording.runs)
    assert learned(recording, deepest_mm=deepest) is not None
    assert learned(recording, deepest_mm=0.9 * deepest) is None


def test_noise_that_channels_share_is_white_once_it_is_known():
    """Whitened, tremor and noise together have unit variance; by the noise alone they have many times that."""
    recording = trembling(3, Sensor(), noise=1e-3, scatter=0.0, distort=0.0)
    found = learned(recording)
    noise = noise_models(recording)
    for shared, least, most in (((), 2.0, np.inf), (found.noise, 0.9, 1.15)):
        samples = Samples(recording, noise, shared)
        model = ObservedModel(samples, ToyEngine(recording))
        left = samples.recorded_vector - model.vector(np.zeros(len(model.nuisances)))
        assert least < float(np.mean(left**2)) < most


@pytest.mark.press
@pytest.mark.parametrize(
    "name",
    [("rig-compliance", "rig"), pytest.param(("charge-leakage", "readout"), marks=pytest.mark.evidence)],
    ids=" ".join,
)
def test_a_mechanism_is_identified_on_a_stage_that_trembles(name):
    recording = trembling(5, concealed(name), runs=4, noise=1e-3)
    findings = diagnose(recording, ToyEngine(recording, candidates=CANDIDATES), 1, silent)
    assert findings.grade is Grade.IDENTIFIED
    assert [setting.candidate.name for setting in findings.best.settings] == [name]
    assert any("µm" in said for said in findings.warnings)

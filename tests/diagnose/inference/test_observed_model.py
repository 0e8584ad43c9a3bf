"""What the instruments show: tangents are slopes, and the vector keeps energies."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from diagnose.fit.baseline import fit_baseline
from diagnose.fit.discrepancy import error_scale_signals, rough_variance, smooth_columns
from diagnose.fit.drive_noise import drive_noise_variance
from diagnose.fit.informative_rows import informative_rows
from diagnose.fit.linearised_system import linearise
from diagnose.fit.nuisances import Nuisance
from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.samples import Samples
from diagnose.forward import Setting
from diagnose.noise.estimate import noise_models
from diagnose.vocabulary.layers.property_error import property_error
from tests.cases import for_each
from tests.diagnose.inference.toy import CANDIDATES, NUISANCE, Sensor, ToyEngine, small


@cache
def observed():
    floating = {**NUISANCE, "clock_ratio": 1e-3, "offset_mm": 0.01}
    recording = small(3, Sensor(leak=0.5), runs=2, rate=400.0, nuisance=floating)
    return ObservedModel(Samples(recording, noise_models(recording)), ToyEngine(recording))


def test_every_tangent_is_the_slope_of_the_prediction():
    model = observed()
    values = 0.3 * model.sigma
    tangents = model.tangents(values)
    for number, nuisance in enumerate(model.nuisances):
        step = np.zeros(len(values))
        step[number] = nuisance.sigma
        slope = (model.vector(values + step) - model.vector(values - step)) / 2.0
        error = np.linalg.norm(tangents[:, number] * nuisance.sigma - slope) / np.linalg.norm(slope)
        assert error < 0.2, nuisance.name  # the slope of a signal with kinks is only as sharp as its sampling


class Turning(ToyEngine):
    """A law that turns over where a modulus is larger than stated by what is allowed, or smaller by more than that."""

    def __init__(self, recording, low, high):
        super().__init__(recording)
        self.low, self.high = low, high

    def predict(self, run, settings):
        if any(not self.low <= s.values[0] <= self.high for s in settings if s.candidate.mechanism == "property-error"):
            raise ValueError("the law turns over")
        return super().predict(run, settings)


@for_each(("low", "high", "answers"), [(-1.0, 0.0, True), (0.0, 0.0, False)])
def test_a_slope_is_taken_on_the_side_that_has_an_answer(low, high, answers):
    smooth = observed()
    recording = smooth.samples.recording
    model = ObservedModel(smooth.samples, Turning(recording, low, high))
    zero = np.zeros(len(model.sigma))
    shared = [(n.name, n.run) for n in model.nuisances].index(("modulus.medium1", None))
    slope, expected = model.tangents(zero)[:, shared], smooth.tangents(zero)[:, shared]
    if answers:
        assert np.linalg.norm(slope - expected) < 0.05 * np.linalg.norm(expected)
    else:
        assert not slope.any()


def test_a_baseline_is_fitted_beside_a_law_that_turns_over():
    """The modulus may only fall: what the fit of the smooth law asks for beyond is a rejected trial."""
    smooth = observed()
    free = fit_baseline(smooth).values
    shared = [(n.name, n.run) for n in smooth.nuisances].index(("modulus.medium1", None))
    edge = 0.5 * free[shared]
    low, high = (edge, 1.0) if edge < 0.0 else (-1.0, edge)
    held = fit_baseline(ObservedModel(smooth.samples, Turning(smooth.samples.recording, low, high))).values
    assert free[shared] != 0.0
    assert low <= held[shared] <= high


def test_a_step_of_the_nuisances_ends_where_the_model_has_an_answer():
    smooth = observed()
    shared = [(n.name, n.run) for n in smooth.nuisances].index(("modulus.medium1", None))
    model = ObservedModel(smooth.samples, Turning(smooth.samples.recording, -1.0, 0.3))
    start, end = np.zeros(len(model.sigma)), np.zeros(len(model.sigma))
    end[shared] = 1.0
    assert model.answerable_nuisances(start, end, ())[shared] == 0.25
    assert model.answerable_nuisances(start, 0.2 * end, ())[shared] == 0.2
    end[shared] = 100.0
    assert model.answerable_nuisances(start, end, ())[shared] == 0.0


def test_nuisances_of_a_run_leave_the_other_alone_and_shared_ones_are_counted_once():
    model = observed()
    names = [(n.name, n.run) for n in model.nuisances]
    assert names.count(("gain", 0)) == names.count(("gain", 1)) == 1
    assert names.count(("modulus.medium1", None)) == 1
    tangents = model.tangents(np.zeros(len(names)))
    assert not tangents[model.samples.run == 1, names.index(("gain", 0))].any()


def test_the_vector_of_noise_is_white():
    model = observed()
    rng = np.random.default_rng(0)
    noise = model.samples.noise
    drawn = [
        {c: noise[run.label, c].draw(rng, len(run.time_s)) for c in run.answers} for run in model.samples.recording.runs
    ]
    vector = model.samples.coefficients(drawn)
    assert np.mean(vector**2) == pytest.approx(1.0, abs=5.0 * np.sqrt(2.0 / len(vector)))


def test_allowance_has_the_energy_that_was_asked_for():
    samples = observed().samples
    vector = observed().vector(np.zeros(len(observed().sigma)))
    total = rough_variance(samples, vector, [0.1, 0.1]).sum()
    assert total == pytest.approx(0.01 * float(vector @ vector))


def test_discrepancy_columns_hold_each_channel_as_a_whole():
    model = observed()
    shown = model.signals(np.zeros(len(model.sigma)))
    found, sigma = smooth_columns(model.samples, shown, [0.02, 0.01])
    voltage = [np.linalg.norm(c) for c, s in zip(found.T, sigma, strict=True) if s == 0.01]
    assert len(sigma) == 2 * 2 * 3 + 2
    assert voltage[-1] == pytest.approx(np.hypot(voltage[0], voltage[3]))


def test_a_commanded_drive_adds_no_noise_and_a_measured_one_adds_its_own():
    quiet = observed()
    assert drive_noise_variance(quiet.samples, quiet.signals(np.zeros(len(quiet.sigma)))).max() < 1e-12
    recording = small(3, runs=1)
    run = recording.runs[0]
    run.channels["displacement_mm"] += 1e-3 * np.random.default_rng(0).standard_normal(len(run.time_s))
    model = ObservedModel(Samples(recording, noise_models(recording)), ToyEngine(recording))
    added = drive_noise_variance(model.samples, model.signals(np.zeros(len(model.sigma))))
    assert added[model.samples.phase == 2].mean() > 0.1  # force changes by some 10 N/mm under a noise of 1 um


def test_live_rows_hold_the_sensitivities():
    model = observed()
    zero = np.zeros(len(model.sigma))
    effect = model.vector(zero, [Setting(CANDIDATES[0], (0.5,))]) - model.vector(zero)
    live = informative_rows(model.samples, linearise(model, zero), [effect[:, None]])
    assert np.abs(effect[~live]).max() < 1.0
    assert live.sum() < 0.9 * len(live)


class TwoChannels(ToyEngine):
    """A second electrode that collects a tenth of the first one's charge."""

    def predict(self, run, settings):
        found = self.imagine(self.recording.runs[run], settings)
        return {"force_N": found["force_N"], "voltage_1_V": found["voltage_V"], "voltage_2_V": 0.1 * found["voltage_V"]}


@cache
def two_channels():
    recording = small(3, Sensor(leak=0.5), runs=2, rate=400.0, nuisance={**NUISANCE, "force_gain": 0.02})
    runs = []
    for run in recording.runs:
        parts = {}
        for name in ("channels", "valid", "saturated"):
            own = dict(getattr(run, name))
            voltage = own.pop("voltage_V")
            parts[name] = {
                **own,
                "voltage_1_V": voltage,
                "voltage_2_V": 0.1 * voltage if name == "channels" else voltage,
            }
        runs.append(replace(run, **parts))
    recording = replace(recording, runs=tuple(runs))
    return ObservedModel(Samples(recording, noise_models(recording)), TwoChannels(recording))


def test_several_channels_have_gain_lag_and_offset_each_for_itself():
    model = two_channels()
    owners = [(n.name, n.run, n.channel) for n in model.nuisances]
    for name in ("gain", "lag_s", "offset_V"):
        assert {channel for one, run, channel in owners if (one, run) == (name, 0)} == {"voltage_1_V", "voltage_2_V"}
    assert ("force_gain", 0, None) in owners
    number = owners.index(("gain", 0, "voltage_2_V"))
    values = np.zeros(len(owners))
    before = model.signals(values)
    values[number] = 0.1
    after = model.signals(values)
    np.testing.assert_allclose(after[0]["voltage_2_V"], 1.1 * before[0]["voltage_2_V"])
    np.testing.assert_array_equal(after[0]["voltage_1_V"], before[0]["voltage_1_V"])
    np.testing.assert_array_equal(after[1]["voltage_2_V"], before[1]["voltage_2_V"])
    slope = model.vector(values) - model.vector(np.zeros(len(owners)))
    np.testing.assert_allclose(model.tangents(np.zeros(len(owners)))[:, number] * 0.1, slope, atol=1e-9)


def test_the_error_of_the_model_is_that_of_the_film_also_where_an_electrode_collects_little():
    shown = two_channels().signals(np.zeros(len(two_channels().nuisances)))
    for own, film in zip(shown, error_scale_signals(shown), strict=True):
        np.testing.assert_array_equal(film["voltage_2_V"], own["voltage_1_V"])
        np.testing.assert_array_equal(film["voltage_1_V"], own["voltage_1_V"])
        np.testing.assert_array_equal(film["force_N"], own["force_N"])


def test_a_wrong_modulus_is_told_as_its_relative_error():
    """Whose coordinate is the logarithm of a factor: half the modulus is an error of -50 %."""
    halved = Nuisance("modulus.medium1", None, 0.05, property_error("medium1", ("modulus",)))
    assert halved.stated_value(np.log(0.5)) == pytest.approx(-0.5)
    assert Nuisance("gain", 0, 0.05).stated_value(0.1) == 0.1

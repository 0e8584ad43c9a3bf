"""A trial that fails, in whatever way, is a rejected trial: nothing ends by it, and what is right is still found."""

from dataclasses import replace
from hashlib import blake2b
from math import nan

import numpy as np
import pytest

from diagnose.fit import trials
from diagnose.fit.baseline import fit_baseline
from diagnose.fit.intervals import point_intervals, profile_intervals
from diagnose.fit.linearised_system import linearise
from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.refit import fit_mechanisms
from diagnose.fit.samples import Samples
from diagnose.fit.trials import Trials
from diagnose.forward import NoAnswerError, Setting
from diagnose.inference.diagnose import diagnose
from diagnose.next_press.choose import next_presses
from diagnose.noise.estimate import noise_models
from solve.solution.errors import NoEquilibriumError
from tests.cases import for_each
from tests.diagnose.inference.toy import CANDIDATES, NUISANCE, Sensor, ToyEngine, silent, small

FEW = tuple(CANDIDATES[n] for n in (0, 2, 3, 5, 6, 11))
LEAK = CANDIDATES[0]
FAILURES = (ValueError("no such law"), OverflowError("too large"), NoEquilibriumError("turned over", np.zeros(0), None))


class Failing(ToyEngine):
    """An engine that fails at random: at so many of a hundred trials, always the same ones, each in its own way.

    What rig.toml states has an answer.
    """

    percent = 0
    fickle = False  # whether the same trial fails at one time and not at another
    asked = 0

    def predict(self, run, settings):
        self.asked += self.fickle
        told = [self.asked, *((s.candidate.name, s.values) for s in settings)]
        number = int.from_bytes(blake2b(repr(told).encode()).digest()[:4])
        if not settings or number % 100 >= self.percent:
            return super().predict(run, settings)
        if number % 4 < len(FAILURES):
            raise FAILURES[number % 4]
        return {name: nan * values for name, values in super().predict(run, settings).items()}

    def imagine(self, run, settings):
        number = len(run.time_s) % 7
        if number < len(FAILURES):
            raise FAILURES[number]
        return super().imagine(run, settings)


def failing(recording, percent, fickle=False):
    engine = Failing(recording, candidates=FEW)
    engine.percent, engine.fickle = percent, fickle
    return engine


@pytest.fixture(scope="module")
def recording():
    return small(5, Sensor(leak=1.0), runs=2, rate=100.0)


@for_each("failure", [*FAILURES, None])
def test_whatever_goes_wrong_is_one_exception_and_is_remembered(recording, failure):
    asked = []

    class Once(ToyEngine):
        def predict(self, run, settings):
            asked.append(settings)
            if failure is not None:
                raise failure
            return {name: np.full(600, np.inf) for name in self.recording.runs[run].answers}

        imagine = predict

    engine, on = Trials(Once(recording), recording.runs), [Setting(LEAK, (0.5,))]
    for _ in range(2):
        with pytest.raises(NoAnswerError):
            engine.predict(0, on)
    assert len(asked) == 1
    engine.refine(on, silent)  # after which it may answer
    with pytest.raises(NoAnswerError):
        engine.predict(0, on)
    assert len(asked) == 2


def test_what_was_said_before_a_refinement_is_not_said_after_it(recording):
    class Learning(ToyEngine):
        better = 0.0

        def refine(self, settings, _report):
            self.better = 1.0
            return settings

        def predict(self, run, settings):
            return {name: self.better + values for name, values in super().predict(run, settings).items()}

    model = ObservedModel(Samples(recording, noise_models(recording)), Learning(recording))
    before = model.signals(np.zeros(len(model.sigma)))
    assert model.engine.refine([Setting(LEAK, (0.5,))], silent)
    after = model.signals(np.zeros(len(model.sigma)))
    np.testing.assert_allclose(after[0]["force_N"] - before[0]["force_N"], 1.0)


@for_each("percent", [0, 5, 30])
def test_a_fit_finds_what_is_right_beside_trials_that_fail(recording, percent):
    model = ObservedModel(Samples(recording, noise_models(recording)), failing(recording, percent))
    baseline = fit_baseline(model)
    fit = fit_mechanisms(model, baseline, (LEAK,), np.array([0.5]), 1e6)
    assert fit.values[0] == pytest.approx(1.0, rel=0.1 if percent < 30 else 1.0)
    for told in (profile_intervals(model, fit), point_intervals(fit)):
        assert told[0]["leak"].low <= fit.values[0] <= told[0]["leak"].high
    linearise(model, fit.closest_nuisances(model), fit.settings)


def test_a_fit_that_starts_where_there_is_no_answer_starts_nearer_to_none(recording):
    class Turning(ToyEngine):
        def predict(self, run, settings):
            if any(s.candidate is LEAK and s.values[0] > 1.2 for s in settings):
                raise NoEquilibriumError("the law turns over", np.zeros(0), None)
            return super().predict(run, settings)

    model = ObservedModel(Samples(recording, noise_models(recording)), Turning(recording, candidates=FEW))
    fit = fit_mechanisms(model, fit_baseline(model), (LEAK,), np.array([15.0]), 1e6)
    assert fit.values[0] == pytest.approx(1.0, rel=0.1)


def test_a_quantity_that_has_no_answer_is_not_told(recording):
    def turns_over(_values):
        raise NoEquilibriumError("the law turns over", np.zeros(0), None)

    model = ObservedModel(Samples(recording, noise_models(recording)), ToyEngine(recording, candidates=FEW))
    one = replace(LEAK, derived=turns_over)
    fit = fit_mechanisms(model, fit_baseline(model), (one,), np.array([0.5]), 1e6)
    assert profile_intervals(model, fit)[0].keys() == {"leak"}


def test_a_baseline_without_an_answer_says_so(recording):
    class Never(ToyEngine):
        def predict(self, run, settings):
            raise FAILURES[0]

    model = ObservedModel(Samples(recording, noise_models(recording)), Never(recording))
    with pytest.raises(NoEquilibriumError, match=r"as rig\.toml states it"):
        fit_baseline(model)


@pytest.mark.press
@for_each("percent, fickle", [(3, False), (20, False), (3, True)])
def test_no_trial_ends_a_diagnosis(percent, fickle, monkeypatch):
    monkeypatch.setattr(trials, "MOST_REMEMBERED", 40 if fickle else trials.MOST_REMEMBERED)
    recording = small(7, Sensor(leak=1.0), runs=4, rate=50.0, nuisance=NUISANCE)
    engine = failing(recording, percent, fickle)
    found = diagnose(recording, engine, 1, silent)
    next_presses(recording, engine, found)
    assert found.mismatch
    assert found.best is None or found.best.settings[0].candidate is LEAK

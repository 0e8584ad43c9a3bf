"""Named on some runs, scored on others that took no part."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from diagnose.engines.some_runs import select_runs
from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.samples import Samples
from diagnose.inference.diagnose import diagnose
from diagnose.inference.held_runs import diagnose_and_score
from diagnose.inference.true_refit import relaxed
from diagnose.noise.estimate import noise_models
from tests.diagnose.inference.toy import CANDIDATES, NUISANCE, Sensor, ToyEngine, silent, small

FEW = tuple(CANDIDATES[n] for n in (0, 1, 4))
TRAINED, HELD = [0, 1, 4, 5], [2, 3]
LABELS = {f"run {number}" for number in HELD}


def scored(recording, candidates=FEW):
    return diagnose_and_score(recording, ToyEngine(recording, candidates=candidates), HELD, 1, silent)


@cache
def leaking():
    """Every run leaks."""
    return small(5, Sensor(leak=1.0))


@cache
def found_of_leaking():
    return scored(leaking())


@cache
def leaking_only_where_trained():
    """The same, but held-out runs of a sound sensor."""
    sound = small(5).runs
    return replace(leaking(), runs=tuple(sound[n] if n in HELD else run for n, run in enumerate(leaking().runs)))


@pytest.mark.press
def test_a_leak_of_all_runs_is_shown_on_those_that_took_no_part():
    found = found_of_leaking()
    assert found.best.settings[0].candidate.name == ("charge-leakage", "readout")
    assert {press.partition(",")[0] for press in found.held_out.presses} == LABELS
    assert not {press.partition(",")[0] for press in found.train.presses} & LABELS
    assert found.held_out.nrmse_before > 3.0 * found.held_out.noise_floor_nrmse
    assert found.held_out.nrmse_after < 1.2 * found.held_out.noise_floor_nrmse
    assert found.held_out.log_score_gain_per_press > 0.0
    assert set(found.improved) == set(found.baseline) == {run.label for run in leaking().runs}


@pytest.mark.press
def test_runs_that_took_no_part_change_nothing_but_the_score():
    one, other = found_of_leaking(), scored(leaking_only_where_trained())
    assert one.best.parameters == other.best.parameters
    assert one.places == other.places
    assert other.held_out.nrmse_after > 3.0 * other.held_out.nrmse_before
    assert other.held_out.log_score_gain_per_press < 0.0


@pytest.mark.press
def test_training_is_a_diagnosis_of_those_runs_alone():
    alone = select_runs(leaking(), TRAINED)
    expected = diagnose(alone, ToyEngine(alone, candidates=FEW), 1, silent)
    assert found_of_leaking().best.parameters == expected.best.parameters


@pytest.mark.press
def test_where_nothing_is_named_nothing_improves():
    found = scored(leaking(), candidates=FEW[1:2])
    assert found.best is None
    assert found.held_out.nrmse_after == found.held_out.nrmse_before
    assert found.held_out.log_score_gain_per_press == 0.0
    assert found.improved is None


@pytest.mark.press
def test_runs_without_mismatch_have_an_error_as_large_as_noise():
    found = scored(small(6))
    assert not found.mismatch
    assert found.held_out.nrmse_before == pytest.approx(found.held_out.noise_floor_nrmse, rel=0.2)


def test_what_is_known_from_other_runs_stays_as_it_is_however_far_from_its_prior():
    recording = small(5, runs=2, nuisance={**NUISANCE, "modulus.medium1": 0.01})
    model = ObservedModel(Samples(recording, noise_models(recording)), ToyEngine(recording))
    shared = np.array([one.run is None for one in model.nuisances])
    assert shared.any()
    known = np.where(shared, 6.0 * model.sigma, 0.0)
    fitted = relaxed(model, known, (), np.ones(len(model.samples), dtype=bool), shared)
    assert np.array_equal(fitted[shared], known[shared])
    assert np.any(fitted[~shared] != 0.0)

"""The next press parts what the recording could not, and is one that a bench can make."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import block_diag

from diagnose.forward import Candidate, Coordinate, Setting
from diagnose.next_press.choose import SETTLED_SEPARATION_SIGMAS, next_presses, surviving_models
from diagnose.next_press.parting import PressJudge
from diagnose.next_press.press_shape import Shape, recorded_shape
from diagnose.next_press.proposals import base_setup, repeat_proposals
from diagnose.next_press.variations import variations
from diagnose.signals.phases import find_phases
from diagnose.signals.recording import Recording
from diagnose.statistics.nuisance_projection import Marginal
from tests.diagnose.verdict.toy import LEAK, RELAXING, ToyEngine, fitted, found, toy_recording, toy_run

LEAKS, RELAXES = fitted(LEAK, 0.5), fitted(RELAXING, 0.3, 0.5)


def planned(recording, models=(LEAKS, RELAXES), engine=None):
    """The first of the presses that are proposed, None without any."""
    return next(iter(series(recording, models, engine)), None)


def series(recording, models, engine=None):
    findings = found(recording, models, models[0], (tuple(range(len(models))),))
    return next_presses(recording, engine or ToyEngine(recording), findings)


@pytest.fixture(scope="module")
def recording():
    return toy_recording([Setting(LEAK, (0.5,))])


def separations(recording, proposals, engine=None):
    judge = PressJudge(recording, engine or ToyEngine(recording), (LEAKS, RELAXES))
    return [float(judge.separations(each).min()) for each in proposals]


def test_the_choice_is_the_best_of_all_presses_that_the_model_can_tell(recording):
    best = planned(recording)
    shallower = [
        v for v in variations(base_setup(recording)) if v.shape.deep <= 0.31 and "dot_offset_mm" not in v.changes
    ]
    rivals = separations(recording, [*repeat_proposals(recording), *(each.proposal() for each in shallower)])
    assert best.separation == pytest.approx(max(rivals))
    assert best.separation > separations(recording, repeat_proposals(recording))[0]
    assert "dot_offset_mm" not in best.changes  # which the toy was not prepared for
    assert best.run.drive_values.max() < 0.31


def test_two_equal_rivals_are_not_parted(recording):
    twin = fitted(LEAK, 0.5)
    judge = PressJudge(recording, ToyEngine(recording), (LEAKS, twin))
    assert judge.separations(repeat_proposals(recording)[0]) == pytest.approx([0.0], abs=1e-6)
    assert planned(recording, (LEAKS, twin)) is None


def test_a_press_that_settles_all_but_twins_says_which_stay_together(recording):
    (only,) = series(recording, (LEAKS, RELAXES, fitted(LEAK, 0.5)))
    assert only.alike == ((0, 2),)
    assert only.separations[1] == pytest.approx(0.0, abs=1e-6)
    assert only.separation == pytest.approx(min(only.separations[[0, 2]]))
    assert only.separation > SETTLED_SEPARATION_SIGMAS


@pytest.mark.press
def test_presses_are_made_until_their_separations_together_settle_it(recording):
    """Under a rough model one press does not; squares add."""
    rough = ToyEngine(recording)
    rough.accuracy = {"voltage_V": 0.8, "force_N": 0.8}
    found = series(recording, (LEAKS, RELAXES), rough)
    assert len(found) > 1
    together = [np.sqrt(sum(float(one.separations[0]) ** 2 for one in found[: n + 1])) for n in range(len(found))]
    assert [bool(one.alike) for one in found] == [sigma < SETTLED_SEPARATION_SIGMAS for sigma in together]


def test_a_load_cell_shows_what_a_voltage_does_not(recording):
    """A leak leaves the force as it is; what relaxes lets it fall too, and a model may know forces better."""
    rough, setup = ToyEngine(recording), base_setup(recording)
    rough.accuracy = {"voltage_V": 0.3, "force_N": 0.02}
    (weighed,) = [each.proposal() for each in variations(setup) if "records" in each.changes]
    assert weighed.run.answers == ("voltage_V", "force_N")
    without, with_it = separations(recording, [setup.proposal(), weighed], rough)
    assert with_it > SETTLED_SEPARATION_SIGMAS > without
    forces = toy_recording(runs=(toy_run(channels=("voltage_V", "force_N")),))
    assert not any("records" in each.changes for each in variations(base_setup(forces)))


def test_an_error_of_the_model_hides_a_difference(recording):
    press = repeat_proposals(recording)[:1]
    rough = ToyEngine(recording)
    rough.accuracy = {"voltage_V": 0.5}
    assert separations(recording, press, rough)[0] < 0.5 * separations(recording, press)[0]


def test_the_separation_is_the_one_of_the_statistics(recording):
    judge = PressJudge(recording, ToyEngine(recording), (LEAKS, RELAXES))
    press = repeat_proposals(recording)[0]
    one, other = judge.rival_answers(press)
    weight = 1.0 / np.sqrt(np.maximum(one.system.variance, other.system.variance))[:, None]
    columns = weight * np.column_stack(
        [one.slopes, -other.slopes, one.system.nuisance_design, other.system.nuisance_design]
    )
    floating = np.diag(np.concatenate([one.system.sigma, other.system.sigma]))
    spread = block_diag(*judge.spreads, floating)
    left = Marginal(columns @ spread, np.ones(len(spread)))(weight[:, 0] * (one.prediction - other.prediction))
    assert judge.separations(press) == pytest.approx([np.linalg.norm(left)], rel=1e-6)


def test_a_declared_gain_takes_its_part_of_the_difference(recording):
    loose = Recording(tuple(replace(run, nuisance={"gain": 0.5}) for run in recording.runs))
    press = repeat_proposals(recording)[0], repeat_proposals(loose)[0]
    tight, floating = separations(recording, press[:1]), separations(loose, press[1:])
    assert floating[0] <= tight[0]


def test_each_rival_is_predicted_beside_its_own_value_of_what_all_runs_share(recording):
    """Which may lie where the fit without any mechanism has strained it to a value that no part has."""
    engine, sigma = Stiffer(recording), {"gain": 0.02, "modulus.medium1": 0.01}
    engine.recording = Recording(tuple(replace(run, nuisance=sigma) for run in recording.runs))
    softer, stiffer = (replace(LEAKS, shared={"modulus.medium1": value}) for value in (-0.2, 0.2))
    same, apart = (
        PressJudge(engine.recording, engine, (softer, rival)).separations(repeat_proposals(engine.recording)[0])[0]
        for rival in (softer, stiffer)
    )
    assert same == pytest.approx(0.0, abs=1e-6)
    assert apart > SETTLED_SEPARATION_SIGMAS


class Stiffer(ToyEngine):
    """A toy whose medium may be stiffer than stated: it gives so much more of everything, up to a third."""

    def nuisance(self, name):
        within = Coordinate("modulus", -0.3, 0.3, (0.1,))
        return Candidate("property-error", "medium1", (within,), lambda v: {"modulus_factor": float(np.exp(v[0]))})

    def imagine(self, run, settings):
        (factor,) = [s.values[0] for s in settings if s.candidate.mechanism == "property-error"] or [0.0]
        if abs(factor) > 0.3:
            raise ValueError("beyond its bounds")
        others = [s for s in settings if s.candidate.mechanism != "property-error"]
        return {name: np.exp(factor) * values for name, values in super().imagine(run, others).items()}


def test_every_press_is_made_on_a_specimen_that_all_runs_have_left(recording):
    """Also one that repeats a run."""
    engine = Remembering(recording)
    planned(recording, engine=engine)
    made = {label for label, before in engine.seen if before == pytest.approx({"displacement_mm": 0.3})}
    assert made >= {run.label for run in recording.runs}


class Remembering(ToyEngine):
    """A toy that writes down what the specimen had felt before each press that it was asked for."""

    def __init__(self, recording):
        super().__init__(recording)
        self.seen = []

    def imagine(self, run, settings):
        self.seen.append((run.label, dict(run.largest_before)))
        return super().imagine(run, settings)


def test_an_engine_that_knows_only_recorded_presses_repeats_one(recording):
    best = planned(recording, engine=_without_imagine(ToyEngine(recording)))
    assert best.text.startswith("Repeat “")
    assert best.changes == {}


def _without_imagine(engine):
    class Narrow:
        name, accuracy, candidates = engine.name, engine.accuracy, engine.candidates
        predict, nuisance, free_nuisances = engine.predict, engine.nuisance, engine.free_nuisances

    return Narrow()


def test_without_a_rival_there_is_nothing_to_part(recording):
    assert planned(recording, (LEAKS,)) is None
    assert surviving_models(found(recording, (LEAKS, RELAXES), mismatch=False)) == ()


def test_rivals_are_those_that_are_left():
    recording = toy_recording()
    unlikely = fitted(RELAXING, 0.3, probability=1e-4)
    assert surviving_models(found(recording, (LEAKS, unlikely), LEAKS, ((0,),))) == (LEAKS,)
    assert surviving_models(found(recording, (LEAKS, RELAXES), None, ((0,), (1,)), unexplained=True)) == (
        LEAKS,
        RELAXES,
    )


def test_a_recorded_press_is_read_as_it_was_set():
    shape = recorded_shape(toy_recording(runs=(toy_run(rise_s=0.2, hold_s=0.5),)), 0)
    assert shape.deep == pytest.approx(0.3, rel=0.01)
    assert shape.level == pytest.approx(-0.2, abs=0.01)
    assert (shape.rise_s, shape.hold_s, shape.fall_s) == pytest.approx((0.2, 0.5, 0.2), abs=0.03)


def test_the_drive_of_a_shape_is_that_shape():
    time, drive = Shape(level=-0.1, deep=0.2, rise_s=0.2, hold_s=0.4, fall_s=0.1, cycles=2).sample(0.001)
    presses = find_phases(time, drive).presses
    assert len(presses) == 2
    assert drive.max() == pytest.approx(0.2)
    for press in presses:
        lasts = np.diff([time[n] for n in (press.touch, press.held, press.released, press.clear)])
        assert lasts == pytest.approx([0.2, 0.4, 0.1], abs=0.02)


def test_every_change_is_said_noted_and_made(recording):
    setup = base_setup(recording)
    for changed in variations(setup):
        proposal = changed.proposal()
        assert proposal.text.startswith("Press as in “")
        assert len(changed.changes) == 1
        (key,) = changed.changes
        same_drive = np.array_equal(proposal.run.drive_values, setup.proposal().run.drive_values)
        if key.startswith("input_"):
            assert getattr(proposal.run.readout, key) == changed.changes[key]
            assert same_drive
        elif key not in ("dot_offset_mm", "dot_temperature", "records"):
            assert not same_drive


def test_a_dot_as_warm_as_the_film_takes_its_drift_away():
    setup = base_setup(toy_recording())
    (warm,) = [each.proposal() for each in variations(setup) if "dot_temperature" in each.changes]
    assert warm.removes == "pyroelectric-drift"

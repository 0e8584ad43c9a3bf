"""The whole chain on a toy sensor: its promises, on recordings of other laws than the engine's."""

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pytest

from diagnose.findings import Fit, Grade
from diagnose.fit.relative_errors import RelativeErrors
from diagnose.inference.diagnose import diagnose
from diagnose.signals.recording import Recording
from diagnose.vocabulary.base import vocabulary
from solve.model import Readout
from tests.cases import for_each
from tests.diagnose.inference.toy import (
    CANDIDATES,
    CONCEALED,
    NUISANCE,
    Sensor,
    ToyEngine,
    concealed,
    one,
    silent,
    small,
)  # fmt: skip

FEW = tuple(CANDIDATES[n] for n in (0, 1, 4, 6, 11, 12))
LEAK = ("charge-leakage", "readout")


def found(recording, candidates=FEW, **more):
    return diagnose(recording, ToyEngine(recording, candidates=candidates, **more), 1, silent)


def names(findings):
    """Of the named mechanisms."""
    return tuple(s.candidate.name for s in findings.best.settings) if findings.best else ()


@cache
def leaking_and_told():
    told = []
    recording = small(5, Sensor(leak=1.0), runs=4)
    return diagnose(recording, ToyEngine(recording, candidates=FEW), 1, silent, told.append), told


def leaking():
    return leaking_and_told()[0]


def test_a_first_look_comes_before_the_findings_and_only_where_there_is_a_mismatch():
    _, (where, who) = leaking_and_told()
    assert where.startswith("First look: Your simulation of the voltage is")
    assert "leaks" in who.partition("%")[0]
    told, recording = [], small(3, runs=2, rate=50.0, noise=0.01)
    assert not diagnose(recording, ToyEngine(recording, candidates=FEW), 1, silent, told.append).mismatch
    assert told == []


def quiet(cases, first=0):
    """Recordings without any effect: how many are named, and how many show a mismatch."""
    all_of_them = [found(small(first + seed, runs=2, rate=50.0, noise=0.01)) for seed in range(cases)]
    return sum(f.best is not None for f in all_of_them), sum(f.mismatch for f in all_of_them)


@pytest.mark.evidence
def test_no_effect_is_named_in_forty_recordings():
    assert quiet(40) == (0, 0)


@pytest.mark.evidence
def test_no_effect_is_named_in_at_most_four_of_four_hundred():
    named, mismatches = quiet(400, first=1000)
    assert named <= 4
    assert mismatches <= 6  # at a level of 0.32 % more have a chance of 0.3 %


@pytest.mark.press
def test_leakage_is_found_located_and_shown():
    findings = leaking()
    assert names(findings) == (LEAK,)
    assert findings.best.parameters[0]["leak"].low < 1.0 < findings.best.parameters[0]["leak"].high
    assert findings.best.gain_lower > 0.0
    assert findings.models[0].probability > 0.9
    assert {place.channel for place in findings.places} == {"voltage_V"}
    left = {one.candidate.component for n in findings.groups[0] for one in findings.models[n].settings}
    assert set(findings.shares) <= left
    assert max(findings.shares, key=findings.shares.get) == "readout"
    assert findings.places[0].component == "readout"
    assert "charge-leakage (readout)" in findings.reasons[0]


@pytest.mark.press
def test_where_only_a_sum_of_cells_stands_out_the_strongest_cell_is_the_place():
    findings = found(small(7, Sensor(leak=0.004), runs=4))
    assert findings.mismatch
    (place,) = findings.places
    assert place.p_value > findings.detection.level


def test_held_out_presses_come_down_to_the_noise():
    findings = leaking()
    assert set(findings.train.presses).isdisjoint(findings.held_out.presses)
    assert findings.held_out.nrmse_after < 0.2 * findings.held_out.nrmse_before
    assert findings.held_out.nrmse_after < 1.2 * findings.held_out.noise_floor_nrmse
    assert findings.held_out.log_score_gain_per_press > 0.0


def missed(recording, signals):
    """Sum of squares of what signals by run leave of a recording."""
    return sum(
        np.nansum((values - signals[run.label][name]) ** 2)
        for run in recording.runs
        for name, values in run.channels.items()
        if name in run.answers
    )


@pytest.mark.press
def test_an_unknown_effect_is_left_unexplained():
    others = tuple(c for c in FEW if c.name != LEAK)
    recording = small(5, Sensor(leak=1.0), runs=4)
    findings = found(recording, others)
    assert findings.mismatch
    assert findings.unexplained
    assert not findings.ambiguous
    assert findings.best is None
    assert findings.improved is None
    assert findings.held_out.nrmse_after == findings.held_out.nrmse_before
    assert findings.unnamed.nrmse_after < findings.unnamed.nrmse_before
    assert missed(recording, findings.closest) < missed(recording, findings.baseline)
    assert not found(small(7, Sensor(step_charge=0.3), runs=4)).best


@pytest.mark.press
@for_each("noise", [0.01, 0.001])
def test_a_law_of_another_form_is_named_at_any_noise(noise):
    name = ("viscoelasticity", "medium2")
    assert names(found(small(11, concealed(name), runs=4, noise=noise), FEW[:4])) == (name,)


@pytest.mark.press
def test_mechanisms_that_act_alike_are_one_group():
    twin = one("pyroelectric-drift", "film", "leak", 0.0, 20.0, 0.5)
    findings = found(small(5, Sensor(leak=1.0), runs=3), (CANDIDATES[0], CANDIDATES[1], twin))
    both = {findings.models[n].settings[0].candidate.name for n in findings.groups[0]}
    assert both == {LEAK, ("pyroelectric-drift", "film")}
    assert findings.best.probability == pytest.approx(0.5, abs=0.1)


@pytest.mark.press
def test_four_that_act_alike_are_not_named():
    twins = [one("friction", name, "leak", 0.0, 20.0, 0.5) for name in ("dot", "rig", "film")]
    findings = found(small(5, Sensor(leak=1.0), runs=3), (CANDIDATES[0], *twins))
    assert findings.unexplained
    assert "4 explanations cannot be told apart" in " ".join(findings.reasons)
    assert (findings.kind, findings.grade, findings.ambiguous) == ("", Grade.UNEXPLAINED, True)


@pytest.mark.press
def test_of_four_that_act_alike_the_kind_is_told():
    twins = [one("charge-leakage", name, "leak", 0.0, 20.0, 0.5) for name in ("dot", "rig", "film")]
    findings = found(small(5, Sensor(leak=1.0), runs=3), (CANDIDATES[0], *twins))
    assert findings.best is None
    assert findings.kind == vocabulary()["charge-leakage"].kind
    assert findings.grade is Grade.KIND_ONLY


@dataclass
class OtherCode(ToyEngine):
    """A leak through the film is the same as one of the input, but for what two codes differ by, over depth."""

    difference: float = 0.0

    def predict(self, run, settings):
        found = super().predict(run, settings)
        film = any(setting.candidate.component == "film" for setting in settings)
        bend = self.difference * film * np.cos(9.0 * np.maximum(self.recording.runs[run].drive_values, 0.0))
        return found | {"voltage_V": found["voltage_V"] * (1.0 + bend)}


@pytest.mark.press
@for_each(("difference", "alike"), [(0.003, 2), (0.04, 1)])
def test_what_differs_by_less_than_two_codes_do_is_one_group(difference, alike):
    """By the noise alone both differences tell the two leaks apart."""
    recorded = small(5, Sensor(leak=1.0), runs=3, noise=0.0005, distort=0.001)
    through_film = one("charge-leakage", "film", "leak", 0.0, 20.0, 0.5)
    accuracy = {"force_N": 0.001, "voltage_V": 0.001}
    engine = OtherCode(recorded, (*FEW[:3], through_film), accuracy, difference=difference)
    findings = diagnose(recorded, engine, 1, silent)
    assert names(findings) == (LEAK,)
    assert len(findings.groups[0]) == alike


@pytest.mark.press
def test_a_second_mechanism_that_may_be_a_flaw_of_the_rig_is_not_named():
    """A leak, and lost motion of 6 um that leaves half a per cent of the signal."""
    sensor, sure = Sensor(leak=1.0, gap_mm=0.006), {"force_N": 0.003, "voltage_V": 0.003}
    findings = found(small(5, sensor, runs=4, noise=0.001, distort=0.0), FEW[:4], accuracy=sure)
    assert (findings.grade, names(findings)) == (Grade.IDENTIFIED, (LEAK,))


@pytest.mark.evidence
def test_what_too_many_pairs_have_in_them_is_the_main_part():
    """A leak, and lost motion that four candidates describe alike."""
    sensor, sure = Sensor(leak=1.0, gap_mm=0.006), {"force_N": 0.003, "voltage_V": 0.003}
    gaps = [one("contact-gap", name, "gap_mm", 0.0, 0.15, 0.02) for name in ("dot", "rig", "film", "case")]
    findings = found(small(5, sensor, runs=4, noise=0.001, distort=0.0), (CANDIDATES[0], *gaps), accuracy=sure)
    assert names(findings) == (LEAK,)


@pytest.mark.press
def test_of_two_equals_the_one_that_a_real_part_can_have_is_named():
    capped = one("pyroelectric-drift", "film", "leak", 0.0, 0.98, 0.5)
    richer = replace(CANDIDATES[0], coordinates=(*CANDIDATES[0].coordinates, *CANDIDATES[13].coordinates))
    findings = found(small(5, Sensor(leak=1.0), runs=3), (capped, richer))
    assert names(findings) == (LEAK,)
    assert len(findings.groups[0]) == 2  # the other one is not excluded: its search was too narrow


def test_shares_are_of_squares_above_noise():
    fit = Fit(("run 1, press 1",), 0.5, 0.3, 0.1, 0.0)
    assert fit.improves
    assert fit.excess_after == pytest.approx(0.08)
    assert fit.share == pytest.approx(1.0 - 0.08 / 0.24)
    assert replace(fit, nrmse_after=0.05).share == 1.0
    assert replace(fit, nrmse_before=0.1, nrmse_after=0.1).share == 0.0


def test_a_channel_whose_noise_was_estimated_too_large_hides_no_other():
    fit = Fit(("run 1, press 1",), 0.3, 0.2, 0.4, 0.0, ((0.1, 0.0, 0.0), (0.1, 0.1, 0.9)))
    assert (fit.excess_before, fit.excess_after, fit.share) == pytest.approx((0.05, 0.0, 1.0))
    errors = RelativeErrors(np.ones(4), np.ones(4), np.array([0, 0, 1, 1]), np.ones(4, dtype=bool))
    before, after = np.array([0.3, 0.1, -5.0, 1.0]), np.array([0.1, 0.1, -5.1, 1.1])
    assert errors.share_taken(before, after) == pytest.approx(0.5)
    assert errors.share_taken(before, before + 0.1 * (errors.channel == 1)) < 0.0


@pytest.mark.press
def test_beside_something_without_a_name_the_main_part_is_named():
    """A leak, and contact charge that is no candidate."""
    findings = found(small(5, Sensor(leak=1.0, touch_charge=0.02), runs=4, noise=0.001), FEW[:3])
    assert findings.grade in (Grade.MAIN_PART, Grade.IDENTIFIED)
    assert names(findings) == (LEAK,)
    assert findings.held_out.nrmse_after < 0.2 * findings.held_out.nrmse_before
    low, high = (getattr(findings.best.parameters[0]["leak"], end) for end in ("low", "high"))
    assert low < 1.0 < high


@pytest.mark.press
@for_each(("touch_charge", "grade"), [(0.02, Grade.IDENTIFIED), (0.05, Grade.MAIN_PART)])
def test_a_wrong_number_is_the_main_part_beside_something_else_that_is_seen(touch_charge, grade):
    """A modulus beside contact charge that is no candidate: 1.4 % of the voltage, hardly more than flaws of a rig, and
    3.5 %.
    """
    errors = tuple(c for c in CANDIDATES if c.mechanism == "property-error")
    sensor = Sensor(modulus1=0.6, touch_charge=touch_charge)
    findings = found(small(5, sensor, runs=4, noise=0.001), (*FEW[:3], *errors))
    assert (findings.grade, names(findings)) == (grade, (("property-error", "medium1"),))


def test_flaws_of_a_rig_alone_have_no_main_part():
    """A surface that is soft by 2 um at the touch, which no candidate describes."""
    findings = found(small(5, Sensor(rounding_mm=0.002), runs=4, noise=0.001), FEW)
    assert findings.grade in (Grade.AGREEMENT, Grade.UNEXPLAINED)


@pytest.mark.evidence
def test_two_mechanisms_are_a_pair():
    findings = found(small(12, Sensor(leak=1.0, friction=0.1), runs=4))
    assert set(names(findings)) == {LEAK, ("friction", "dot")}


@pytest.mark.press
def test_a_modulus_beyond_its_declared_scatter_is_a_mismatch():
    name = ("property-error", "medium1")
    errors = tuple(c for c in CANDIDATES if c.mechanism == "property-error")
    assert names(found(small(13, concealed(name), runs=4), (*FEW, *errors))) == (name,)


def test_a_modulus_within_its_declared_scatter_is_none():
    assert not found(small(14, Sensor(modulus1=0.05), runs=4, scatter=0.5)).mismatch


def test_one_press_is_judged_by_its_phases_and_says_so():
    findings = found(small(5, Sensor(leak=1.0), runs=1))
    assert names(findings) == (LEAK,)
    assert findings.held_out is None
    assert "only one press" in " ".join(findings.warnings)


@pytest.mark.press
def test_a_value_at_the_edge_of_what_parts_have_is_the_main_part_where_it_leaves_next_to_nothing():
    recording = small(5, Sensor(leak=5.0), runs=3)
    findings = found(recording, (one(*LEAK, "leak", 0.0, 4.9, 0.5),))
    assert (findings.grade, names(findings)) == (Grade.MAIN_PART, (LEAK,))
    assert "implausible" in " ".join(findings.reasons)
    assert found(recording, (one(*LEAK, "leak", 0.0, 1.5, 0.5),)).grade is not Grade.IDENTIFIED


def test_a_sensor_of_unknown_sensitivity_is_no_mismatch():
    free = one("property-error", "film", "d31", -0.9, 20.0, 1.0)
    recording = small(15, Sensor(d31=4.0), runs=3)
    findings = found(recording, FEW, free_nuisances=(free,))
    assert not findings.mismatch
    assert findings.nuisances["d31"][0] == pytest.approx(4.0, rel=0.1)


@pytest.mark.press
def test_missing_samples_are_left_out():
    recording = small(16, Sensor(leak=1.0), runs=3)
    runs = []
    for run in recording.runs:
        there = np.ones(len(run.time_s), dtype=bool)
        there[200:215] = False
        channels = {name: np.where(there, values, np.nan) for name, values in run.channels.items()}
        channels[run.drive] = run.drive_values
        runs.append(replace(run, channels=channels, valid=dict.fromkeys(channels, there)))
    assert names(found(Recording(tuple(runs)))) == (LEAK,)


@pytest.mark.press
def test_a_limit_that_nobody_stated_is_a_saturation_and_one_that_is_stated_is_no_mismatch():
    candidate = one("saturation", "readout", "inverse_limit", 0.0, 20.0, 3.0, 6.0)
    recording = small(17, runs=3)
    limit = 0.6 * max(float(run.channels["voltage_V"].max()) for run in recording.runs)
    unstated, stated = [], []
    for run in recording.runs:
        clipped = np.minimum(run.channels["voltage_V"], limit)
        channels = {**run.channels, "voltage_V": clipped}
        at_limit = {**run.saturated, "voltage_V": clipped >= limit}
        unstated.append(replace(run, channels=channels, saturated=at_limit))
        stated.append(replace(unstated[-1], readout=Readout(limit_V=limit)))
    findings = found(Recording(tuple(unstated)), (*FEW[:3], candidate))
    assert names(findings) == (("saturation", "readout"),)
    assert findings.best.settings[0].values[0] == pytest.approx(1.0 / limit, rel=0.05)
    assert not found(Recording(tuple(stated))).mismatch


@pytest.mark.press
def test_the_same_seed_gives_the_same_findings():
    recording = small(5, Sensor(leak=1.0), runs=2)
    assert found(recording).models[0] == found(recording).models[0]


@pytest.mark.evidence
@for_each("name", CONCEALED, ids=" ".join)
def test_every_mechanism_is_named_by_another_law_and_missed_when_it_is_not_listed(name):
    recording = small(31, concealed(name), noise=0.005)
    assert names(found(recording, CANDIDATES)) == (name,)
    assert found(recording, tuple(c for c in CANDIDATES if c.name != name)).best is None


def test_every_nuisance_of_the_toy_is_known_to_its_engine():
    assert all(ToyEngine(Recording(())).nuisance(n) is not None for n in NUISANCE if "." in n)

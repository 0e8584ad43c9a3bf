"""Real presses of a P(VDF-TrFE) fingertip: what shows, and what must not once nothing is left to find."""

from dataclasses import replace
from pathlib import Path

import pytest

from diagnose.engines.proportional.engine import proportional_engine
from diagnose.inference.diagnose import diagnose
from softdot.config.rig import load_rig
from tests.cases import for_each
from tests.diagnose.real import NEEDED, RECORDINGS, control, converted, silent

pytestmark = NEEDED


@pytest.fixture(scope="module")
def recording(tmp_path_factory):
    """Nine presses at two speeds."""
    out = tmp_path_factory.mktemp("presses") / "out"
    converted("pvdf-presses", out)
    return load_rig(out).recording


def found_in(recording):
    """Findings."""
    return diagnose(recording, proportional_engine(recording, silent), 0, silent)


def test_a_leak_predicts_the_presses_of_one_speed_best(recording):
    """The voltage is there while the force changes and gone while it is held."""
    fast = replace(recording, runs=tuple(run for run in recording.runs if "speed 300" in run.label))
    found = found_in(fast)
    single = [model for model in found.models if len(model.settings) == 1]
    best = max(single, key=lambda model: model.gain)
    assert best.settings[0].candidate.mechanism == "charge-leakage"
    assert best.gain_lower > 0.0


def test_that_charge_is_lost_is_told_of_both_speeds(recording):
    """An expert's leak, fitted to the same presses, leaves 28.5 % of the others."""
    found = found_in(recording)
    assert found.kind == "the film or its input loses charge"
    assert [[one.candidate.mechanism for one in found.models[n].settings] for n in found.groups[0]] == [
        ["charge-leakage"], ["charge-leakage"],
    ]  # fmt: skip
    assert found.unnamed is not None
    assert found.unnamed.nrmse_after < 1.2 * 0.285


@for_each("every", [1, 2, 3])
def test_a_ferroelectric_loop_is_nothing_viscous(every):
    """Also where only every second or third sample is kept. An expert's plays leave 1.2 % of it."""
    whole = load_rig(Path(RECORDINGS) / "hysteresis-loop").recording
    kept = [
        replace(run, time_s=run.time_s[::every], **{
            name: {key: values[::every] for key, values in getattr(run, name).items()}
            for name in ("channels", "valid", "saturated")
        })
        for run in whole.runs
    ]  # fmt: skip
    found = found_in(replace(whole, runs=tuple(kept)))
    assert found.best is not None
    assert [one.candidate.mechanism for one in found.best.settings] == ["hysteresis"]
    assert found.held_out.nrmse_after < 1.2 * 0.012


def test_voltages_of_other_presses_name_nothing(recording):
    """Nothing in them looks like a mechanism."""
    found = found_in(control("shuffled")(recording))
    assert found.best is None
    assert min(found.screened.values()) > found.detection.level


def test_voltages_backwards_name_nothing(recording):
    """A press backwards looks like one, so that mechanisms show in it; none of them predicts."""
    assert found_in(control("reversed_answers")(recording)).best is None


def test_the_difference_of_two_presses_names_nothing(recording):
    fast = replace(recording, runs=tuple(run for run in recording.runs if "speed 300" in run.label))
    assert found_in(control("replicates")(fast)).best is None

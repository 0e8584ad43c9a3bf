"""A loop between force and travel at one rate may be friction of the tester or relaxation; a second rate decides.

The recordings are made by closed forms of a sheared layer, G A u / h, and by nothing of the diagnosis.
"""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid

from diagnose.engines.coupon.engine import coupon_engine
from diagnose.inference.diagnose import diagnose
from diagnose.signals.recording import Recording
from tests.cases import for_each
from tests.diagnose.coupon.coupons import RUBBER, TIME, run, silent, specimen

STIFFNESS = 0.4 * 100.0 / 20.0
"""N/mm: G = E / 3 of a layer of 20 mm by 5 mm and 20 mm height."""
SIGMA_N = 0.05
TRAVEL = np.interp(TIME, [0.0, 5.0, 10.0, 15.0, 20.0], [0.0, 8.0, 0.0, 8.0, 0.0])
RATES = (1.0, 30.0)


def rubbed(_time, presliding=0.2):
    """Coulomb's friction of 1.5 N that is reached within so many mm of rest, whatever the rate."""
    leg = np.maximum(np.ceil(TIME / 5.0) - 1.0, 0.0)  # in, out, in, out
    gone = 8.0 * (TIME / 5.0 - leg)
    turned = np.minimum(-1.0 + gone / presliding, 1.0) * np.where(leg % 2.0 == 0.0, 1.0, -1.0)
    return STIFFNESS * TRAVEL + 1.5 * np.where(leg == 0.0, np.minimum(gone / presliding, 1.0), turned)


def relaxed(time):
    """A third of the stress fades with 4 s: the hereditary integral of G (2 + exp(-t / 4 s)) / 3."""
    grows = np.exp(time / 4.0)
    kept = cumulative_trapezoid(grows * np.gradient(TRAVEL, time), time, initial=0.0) / grows
    return STIFFNESS * (2.0 * TRAVEL + kept) / 3.0


def found(force_of, rates, without=""):
    """The diagnosis of one run for each rate, with all candidates but one."""
    rng, runs = np.random.default_rng(5), []
    for rate in rates:
        time = TIME / rate
        force = force_of(time) + SIGMA_N * rng.standard_normal(len(time))
        one = run(TRAVEL, force, noise={"force_N": SIGMA_N})
        runs.append(replace(one, label=f"{rate:g} times", time_s=time))
    engine = coupon_engine(Recording(tuple(runs), specimen("shear")), {"mine": RUBBER}, silent)
    engine = engine.with_candidates(tuple(one for one in engine.candidates if one.mechanism != without))
    return diagnose(engine.recording, engine, 0, silent)


def loss_N_mm(forces_N, presliding_mm):
    """Work that sliders lose in a loop of 8 mm from end to end."""
    return sum(2.0 * force * (8.0 - 2.0 * d) for force, d in zip(forces_N, presliding_mm, strict=True))


@pytest.mark.press
@for_each("presliding", [0.02, 0.07, 0.2, 0.7])
def test_a_name_needs_no_certain_presliding(presliding):
    """Sliders half a decade apart stand for it; what they lose in a loop is right within 6 %."""
    findings = found(partial(rubbed, presliding=presliding), RATES)
    assert findings.best is not None, findings.reasons
    (rubbing,) = findings.best.settings
    assert rubbing.candidate.mechanism == "guide-friction"
    sliders = rubbing.candidate.parameters(rubbing.values)
    told = rubbing.candidate.derived(rubbing.values)
    assert told["sliding_friction_N"] == pytest.approx(1.5, rel=0.06)
    if presliding > TRAVEL[1] - TRAVEL[0]:  # what slips within a sample slips at once
        assert told["half_of_it_within_mm"] == pytest.approx(0.5 * presliding, rel=0.4)
    assert loss_N_mm(sliders["friction_force_N"], sliders["presliding_mm"]) == pytest.approx(
        loss_N_mm([1.5], [presliding]), rel=0.06
    )


@pytest.mark.press
@for_each(("force_of", "mechanism"), [(rubbed, "guide-friction"), (relaxed, "viscoelasticity")])
def test_two_rates_tell_friction_from_relaxation(force_of, mechanism):
    findings = found(force_of, RATES)
    assert findings.best is not None, findings.reasons
    assert [one.candidate.mechanism for one in findings.best.settings] == [mechanism]
    alike = [one for n in findings.groups[0] for one in findings.models[n].settings]
    assert {one.candidate.mechanism for one in alike} == {mechanism}


@pytest.mark.press
@for_each(("force_of", "mechanism"), [(rubbed, "guide-friction"), (relaxed, "viscoelasticity")])
def test_one_rate_names_nothing_wrong(force_of, mechanism):
    """The truth alone or in a group, or no name."""
    findings = found(force_of, RATES[:1])
    assert findings.mismatch
    alike = [one for n in findings.groups[0] for one in findings.models[n].settings]
    assert findings.best is None or mechanism in {one.candidate.mechanism for one in alike}


@pytest.mark.press
@pytest.mark.parametrize("rates", [pytest.param(RATES, marks=pytest.mark.evidence), RATES[:1]])
@pytest.mark.parametrize(("force_of", "mechanism"), [(rubbed, "guide-friction"), (relaxed, "viscoelasticity")])
def test_neither_is_named_for_the_other(force_of, mechanism, rates):
    findings = found(force_of, rates, without=mechanism)
    assert findings.unexplained
    assert findings.best is None

"""A strip that relaxes and does not stretch as a neo-Hookean rubber does: both are named, one after the other.

The recordings are made by closed forms, a hereditary integral of the elastic force of an incompressible strip, and by
nothing of the diagnosis.
"""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid

from diagnose.engines.coupon.engine import coupon_engine
from diagnose.inference.diagnose import diagnose
from diagnose.signals.recording import Recording
from tests.cases import for_each
from tests.diagnose.coupon.coupons import RUBBER, run, silent, specimen

SIGMA_N = 0.01
AREA_MM2, LENGTH_MM = 10.0, 20.0
STRETCHES = (1.5, 2.0, 3.0, 2.5)


def held(stretch, seconds=60.0):
    """Time and stretch of a strip that is pulled within a second and held."""
    time = np.linspace(0.0, seconds, 301)
    return time, np.interp(time, [0.0, 1.0, seconds], [1.0, stretch, stretch])


def force_N(time, stretch, c10=0.12, c01=0.0, tau=8.0):
    """Mooney and Rivlin's force, of which half fades (Fung, Biomechanics, 1981, quasi-linear)."""
    elastic = 2.0 * AREA_MM2 * (c10 + c01 / stretch) * (stretch - stretch**-2)
    grows = np.exp(time / tau)
    kept = cumulative_trapezoid(grows * np.gradient(elastic, time), time, initial=0.0) / grows
    return 0.5 * (elastic + kept)


def found(**law):
    rng, runs = np.random.default_rng(3), []
    for stretch in STRETCHES:
        time, course = held(stretch)
        force = force_N(time, course, **law) + SIGMA_N * rng.standard_normal(len(time))
        one = run(LENGTH_MM * (course - 1.0), force, noise={"force_N": SIGMA_N}, nuisance={"modulus.specimen": 1.0})
        there = {name: np.ones(len(time), dtype=bool) for name in one.channels}
        none = {name: ~flags for name, flags in there.items()}
        runs.append(replace(one, label=f"to {stretch}", time_s=time, valid=there, saturated=none))
    recording = Recording(tuple(runs), specimen())
    findings = diagnose(recording, coupon_engine(recording, {"mine": RUBBER}, silent), 0, silent)
    assert findings.best is not None, findings.reasons
    return findings


def names(findings):
    return [one.candidate.mechanism for one in findings.best.settings]


@pytest.mark.evidence
def test_what_only_relaxes_only_relaxes():
    assert names(found()) == ["viscoelasticity"]


@pytest.mark.evidence
@for_each("c01", [0.1, 0.2])
def test_relaxation_and_another_elastic_law_are_both_named(c01):
    findings = found(c10=0.05, c01=c01)
    assert sorted(names(findings)) == ["hyperelastic-stiffening", "viscoelasticity"]
    assert findings.held_out.nrmse_after < 0.05

"""What relaxes is found whatever the logger did between the motions of the drive.

The strip is a closed form: a layer in shear at small strain whose modulus fades with two times, by its hereditary
integral over a ramp and a hold.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import least_squares, lsq_linear

from diagnose.engines.coupon.engine import coupon_engine
from diagnose.engines.coupon.relaxation_spectrum import relaxation_times
from diagnose.forward import Setting
from diagnose.signals.recording import Recording
from diagnose.signals.time_scales import time_scales
from softdot.config.rig import load_rig
from softdot.diagnosis.engine import engine_for
from tests.cases import for_each
from tests.diagnose.coupon.coupons import RUBBER, candidate, run, silent, specimen
from tests.diagnose.real import RECORDINGS

PER_SAMPLE = "channels", "valid", "saturated"
RAMP_S, END_S, TRAVEL_MM = 2.0, 400.0, 0.02
SHARES, TIMES_S = (0.3, 0.25), (0.7, 40.0)
STIFFNESS_N_PER_MM = 0.4 * 100.0 / 20.0 * (1.5 / 1.499)  # E / (2 (1 + nu)) A / h
EVEN = np.linspace(0.0, END_S, 8001)
UNEVEN = np.concatenate([np.arange(0.0, RAMP_S, 0.05), np.arange(RAMP_S, END_S, 2.0)])


def force_N(time):
    """Stiffness times the ramp, less what each branch has forgotten: g (u - tau v (1 - exp(-t / tau)) faded)."""
    ramp, held = np.minimum(time, RAMP_S), np.maximum(time - RAMP_S, 0.0)
    speed, total = TRAVEL_MM / RAMP_S, (1.0 - sum(SHARES)) * TRAVEL_MM * np.minimum(time / RAMP_S, 1.0)
    for share, tau in zip(SHARES, TIMES_S, strict=True):
        total += share * speed * tau * -np.expm1(-ramp / tau) * np.exp(-held / tau)
    return STIFFNESS_N_PER_MM * total


def strip(time):
    """A recording of the strip at these times."""
    travel = TRAVEL_MM * np.minimum(time / RAMP_S, 1.0)
    channels = {"displacement_mm": travel, "force_N": force_N(time)}
    there = {name: np.ones(len(time), dtype=bool) for name in channels}
    none = {name: ~flags for name, flags in there.items()}
    one = replace(run(), time_s=time, channels=channels, valid=there, saturated=none)
    return Recording((one,), specimen("shear"))


def relaxed_by(recording):
    """Fraction that the fitted branches relax between a tenth of a second and ten, and what they leave of the force.

    At small strain the force is linear in E_inf and in E_i, whose sum is the stated modulus, so that the fit is linear.
    """
    engine = coupon_engine(recording, {"mine": RUBBER}, silent)
    one, (seen,) = candidate(engine, "viscoelasticity"), recording.runs
    count, linear = len(one.coordinates) - 1, 1.0
    unit = [engine.predict(0, [Setting(one, (*(1e3 * row), linear))])["force_N"] for row in np.eye(count)]
    columns = np.column_stack([engine.predict(0, [])["force_N"], *unit])
    force = seen.channels["force_N"]
    stated = np.linalg.norm(force)  # as sure as the whole force is
    found = lsq_linear(np.vstack([columns, stated * np.ones(count + 1)]), np.append(force, stated), (0.0, np.inf)).x
    moduli = found[1:] / (found[0] + found[1:].sum() / 1001.0)
    left = np.linalg.norm(columns @ found - force) / np.linalg.norm(force)
    return one.derived((*moduli, linear))["relaxed_fraction"], left


def thinned(every):
    """The uneven log, of which every second, third, ... row is kept."""
    return UNEVEN[::every]


@for_each("time", [EVEN, UNEVEN, thinned(2), thinned(3)], ids=["even", "uneven", "half", "third"])
def test_the_same_relaxation_is_fitted_however_it_was_logged(time):
    relaxed, left = relaxed_by(strip(time))
    kept = [1.0 - sum(g * -np.expm1(-t / tau) for g, tau in zip(SHARES, TIMES_S, strict=True)) for t in (0.1, 10.0)]
    assert relaxed == pytest.approx(1.0 - kept[1] / kept[0], rel=0.05)
    assert left < 0.01


def test_branches_lie_where_the_drive_puts_them_and_not_the_logger():
    """Also where the logger ran for a while before the touch."""
    even = relaxation_times(time_scales(strip(EVEN)))
    for time in (UNEVEN, thinned(2)):
        np.testing.assert_allclose(relaxation_times(time_scales(strip(time))), even, rtol=0.1)
    waiting = strip(EVEN)
    (one,) = waiting.runs
    late = replace(one, time_s=np.append(0.0, one.time_s[1:] + 300.0))
    np.testing.assert_allclose(relaxation_times(time_scales(replace(waiting, runs=(late,)))), even, rtol=0.1)


def test_what_is_slower_than_the_recording_may_stand_at_the_end_of_its_range():
    """E_inf is not seen then: at the end another tenfold changes nothing, of a quick branch it does."""
    recording = strip(UNEVEN)
    engine = coupon_engine(recording, {"mine": RUBBER}, silent)
    one = candidate(engine, "viscoelasticity")
    times = relaxation_times(time_scales(recording), 1)
    force = engine.predict(0, [])["force_N"]
    for number, (time, coordinate) in enumerate(zip(times, one.coordinates[:-1], strict=True)):
        at = [tuple(x if n == number else float(n == len(times)) for n in range(len(times) + 1))
              for x in (coordinate.high, 10.0 * coordinate.high)]  # fmt: skip
        ends = [engine.predict(0, [Setting(one, values)])["force_N"] for values in at]
        levels = np.abs(ends[1] - ends[0])[-1] < 0.05 * np.abs(force - ends[0])[-1]
        assert coordinate.levels_off == (False, time >= END_S)
        assert levels or not coordinate.levels_off[1]


def thin(one):
    """A run of which every third row of the ramp and every sixth of the hold is kept."""
    kept = np.unique(np.concatenate([np.arange(0, 600, 3), np.arange(0, len(one.time_s), 6)]))
    of = {name: {key: values[kept] for key, values in getattr(one, name).items()} for name in PER_SAMPLE}
    return replace(one, time_s=one.time_s[kept], **of)


@pytest.mark.evidence
@pytest.mark.skipif(not RECORDINGS, reason="SOFTDOT_RECORDINGS names no folder")
def test_branches_of_a_tape_logged_unevenly_predict_other_stretches():
    """Fitted to the first and third run; a quasi-linear model of SciPy leaves 2.3 % of the others."""
    rig = load_rig(Path(RECORDINGS) / "vhb-uneven")
    rig = replace(rig, recording=replace(rig.recording, runs=tuple(map(thin, rig.recording.runs))))
    engine, runs = engine_for(rig, silent), rig.recording.runs
    one, modulus = candidate(engine, "viscoelasticity"), engine.nuisance("modulus.specimen")
    bounds = [(c.low, c.high) for c in one.coordinates]

    def left(values, numbers):
        on = Setting(one, tuple(values[:-1])), Setting(modulus, tuple(values[-1:]))
        seen = [runs[n].channels["force_N"] for n in numbers]
        made = [engine.predict(n, on)["force_N"] for n in numbers]
        return np.concatenate([(a - b) / np.linalg.norm(b) for a, b in zip(made, seen, strict=True)])

    start = [0.3] * (len(bounds) - 1) + [0.1, 0.5]
    fit = least_squares(left, start, bounds=np.array([*bounds, (-0.9, 20.0)]).T, args=((0, 2),), max_nfev=12)
    assert np.linalg.norm(fit.fun) / np.sqrt(2.0) < 0.025
    assert np.linalg.norm(left(fit.x, (1, 3))) / np.sqrt(2.0) < 0.035

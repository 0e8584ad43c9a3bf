"""The generator's read-out, noise and measure of size against what theory says."""

from dataclasses import replace

import numpy as np
import pytest

from softdot.studies.proof.world.amplifier import Amplifier, Filter
from softdot.studies.proof.world.details import PLAY, SOFTNESS_MM, Details
from softdot.studies.proof.world.effects import EFFECTS, apply_effects, fits
from softdot.studies.proof.world.judge import Judge
from softdot.studies.proof.world.march import Course, Table
from softdot.studies.proof.world.noise import Autoregression, noises, yule_walker
from softdot.studies.proof.world.reality import Reality, _path, baseline, dahl
from softdot.studies.proof.world.rigs import CLAMPED, FREE, SOLID, VOLTAGE_ONLY
from softdot.studies.proof.world.runs import Run, traced_run

TIME = np.arange(0.0, 2.0, 0.004)


def test_a_step_of_charge_decays_with_the_time_constant_of_the_input():
    charge = np.where(TIME < 0.1, 0.0, 500.0)
    voltage = Amplifier(1000.0, 60.0).voltage(TIME, charge, 40.0, 0.0)  # 1 GOhm and 100 pF: 0.1 s
    later = TIME > 0.2
    np.testing.assert_allclose(voltage[later], 5.0 * np.exp(-(TIME[later] - 0.098) / 0.1), atol=0.02)


def test_a_filter_passes_the_power_at_its_corner_by_half():
    sine = np.sin(2.0 * np.pi * 20.0 * TIME)
    for kind in ("bessel", "butterworth"):
        passed = Filter(20.0, 2, kind).apply(sine, 250.0)
        assert passed[TIME > 1.0].std() / sine[TIME > 1.0].std() == pytest.approx(2**-0.5, rel=0.02)


def test_noise_has_the_size_and_the_whitening_that_are_stated():
    for noise in noises().values():
        drawn = noise.draw(np.random.default_rng(1), 40_000)
        assert drawn.std() == pytest.approx(1.0, rel=0.03)
        white = noise.whiten(drawn)[50:]
        assert white.std() == pytest.approx(1.0, rel=0.02)
        assert abs(np.corrcoef(white[1:], white[:-1])[0, 1]) < 0.02


def test_yule_walker_finds_a_known_autoregression():
    known = Autoregression((0.5, -0.3), 0.8)
    drawn = known.draw(np.random.default_rng(0), 50_000)
    np.testing.assert_allclose(yule_walker([drawn], 2).coefficients, (0.5, -0.3), atol=0.02)


def test_a_compliant_rig_is_a_spring_in_series():
    depth = np.linspace(0.0, 1.0, 11)
    linear = Table(depth, Course(3.0 * depth, depth, depth))  # 3 N/mm
    reality = replace(baseline(CLAMPED), compliance_mm_per_N=0.5)
    reached = _path(reality, np.array([-0.2, 0.0, 0.5]), linear)
    np.testing.assert_allclose(reached, [-0.2, 0.0, 0.5 / (1.0 + 0.5 * 3.0)], atol=1e-6)


def test_a_soft_surface_yields_by_half_the_square_at_first_and_by_its_softness_in_the_end():
    soft = Details((0.0, 1.0, 0.0, 0.0, 0.0), seed=0)
    stage = np.array([-0.1, 0.0, 1e-5, 0.3])
    expected = [-0.1, 0.0, 1e-10 / (2.0 * SOFTNESS_MM), 0.3 - SOFTNESS_MM]
    np.testing.assert_allclose(soft.path(TIME[:4], stage, 0), expected, rtol=2e-3, atol=1e-12)


def test_play_makes_the_force_larger_on_the_way_down_and_smaller_on_the_way_up():
    way = np.concatenate([np.linspace(0.0, 0.3, 301), np.linspace(0.3, 0.0, 301)])
    force = Details((0.0, 0.0, 1.0, 0.0, 0.0), seed=0).force(way, np.ones(len(way)))
    np.testing.assert_allclose(force[[150, 450]], [1.0 + PLAY, 1.0 - PLAY], rtol=1e-12)


def test_a_guide_loses_four_times_its_friction_on_each_way_whatever_the_speed():
    """Between -A and A, much farther than the travel d: 4 A, less 4 d of the turns; -expm1(-2 A / d) is 1."""
    path = np.interp(np.arange(4001.0), [0.0, 1000.0, 2000.0, 3000.0, 4000.0], [0.5, -0.5, 0.5, -0.5, 0.5])
    friction = dahl(path, 0.02)
    last = slice(2000, None)
    assert np.trapezoid(friction[last], path[last]) == pytest.approx(4.0 * (0.5 - 0.02), rel=0.01)
    np.testing.assert_allclose(dahl(path[::2], 0.02), friction[::2], atol=1e-12)
    assert np.abs(friction).max() <= 1.0


def test_ramps_are_smooth_and_come_back():
    run = Run("a", 0.3, 0.2, 0.5)
    time = run.times(1000.0)
    depth = run.depth(time)
    assert depth[0] == depth[-1] == pytest.approx(-0.04)
    assert depth.max() == pytest.approx(0.3)
    # a quintic step of height h in time T has the largest acceleration 10 h / sqrt(3) / T^2
    largest = 10.0 / 3.0**0.5 * 0.34 / 0.2**2
    assert np.abs(run.acceleration_mm_per_s2(time)).max() == pytest.approx(largest, rel=1e-2)


def test_a_path_that_is_asked_for_sample_by_sample_accelerates_as_the_stage_does():
    """Straight lines between the samples have no acceleration but at their ends, where it has no limit."""
    run = Run("a", 0.3, 0.6, 0.5)
    samples, between = run.times(250.0), run.times(1000.0)
    asked = traced_run("asked", samples, run.depth(samples), None, 0.0, 0.0)
    largest = np.abs(run.acceleration_mm_per_s2(between)).max()
    for time in (samples, between):
        assert np.abs(asked.acceleration_mm_per_s2(time)).max() == pytest.approx(largest, rel=0.05)


def test_every_effect_is_off_at_strength_zero_and_names_what_the_vocabulary_knows():
    from solve.mechanisms import MECHANISMS

    belief = baseline(CLAMPED)
    assert apply_effects(belief, CLAMPED, dict.fromkeys(EFFECTS, 0.0)) == belief
    for effect in EFFECTS.values():
        assert effect.mechanism == "" or effect.component in MECHANISMS[effect.mechanism].components


def test_effects_that_a_bench_cannot_have_are_barred():
    assert fits("elastic-case", CLAMPED)
    assert not fits("elastic-case", FREE)
    assert not fits("leakage", VOLTAGE_ONLY)
    assert fits("round", CLAMPED)
    assert not fits("round", SOLID)  # round already


class Flat(Judge):
    """A judge whose nuisances are given."""

    def __init__(self, tangents):
        object.__setattr__(self, "given", tangents)

    @property
    def _tangents(self):
        return self.given


def test_a_nuisance_takes_what_lies_along_it_as_far_as_its_width_goes(monkeypatch):
    # an effect of 3 sigma of one nuisance, whose signal is 10 sigma of noise: it keeps 3 of 30, as prior
    tangent = np.zeros((100, 1))
    tangent[0] = 10.0
    monkeypatch.setattr(Judge, "_tangents", tangent)
    monkeypatch.setattr("softdot.studies.proof.world.judge.record", lambda reality, _bench: reality)
    effect = np.zeros(100)
    effect[0], effect[1] = 30.0, 4.0
    monkeypatch.setattr("softdot.studies.proof.world.judge.whiten", lambda signals, _bench: signals)
    left = Judge(CLAMPED).residual(effect, np.zeros(100))
    assert np.linalg.norm(left) == pytest.approx(np.hypot(30.0 / np.sqrt(101.0), 4.0))


def test_an_effect_is_no_further_from_its_own_family_than_rounding():
    rng = np.random.default_rng(0)
    one, other = rng.standard_normal((2, 500))
    assert Judge.separation(2.0 * one, [one, other]) < 1e-9
    assert Judge.separation(one, [other]) == pytest.approx(np.linalg.norm(one), rel=0.05)


def test_reality_looks_up_nuisances_of_a_run_before_those_of_all():
    reality = Reality(CLAMPED.made, CLAMPED.amplifier, nuisance={"gain": 0.1, ("gain", 2): 0.3})
    assert (reality.of("gain", 0), reality.of("gain", 2), reality.of("lag_s", 0)) == (0.1, 0.3, 0.0)

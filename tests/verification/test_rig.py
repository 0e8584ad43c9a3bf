"""Rig compliance, force drive, gap and moving mass around the finite-element segment."""

from dataclasses import replace

import numpy as np
import pytest

from solve.model import Press
from solve.physics import Physics
from solve.terms.guide import GuideFriction
from solve.terms.inertia import MovingMass
from solve.terms.rig import RigSpring
from tests.cases import for_each
from tests.pressing import press_segment
from tests.solve.segments import materials, ridge
from tests.verification.slices import BLOCK, STACK, charge, foams, force, mesh_of, plate, pressed, waved

COMPLIANCE = 0.05  # mm/N, as soft as the slice itself
MASS_G = 20.0
REACH_M = 1e-5  # F0 / k of the tap


@pytest.fixture(scope="module")
def rigid():
    return pressed(Press(indentation_mm=0.2, load_steps=8))


@pytest.fixture(scope="module")
def soft():
    return pressed(Press(indentation_mm=0.2, load_steps=4), Physics(terms=(RigSpring(COMPLIANCE),)))


def test_a_spring_in_series_gives_the_rigid_curve_at_the_travel_that_is_left(soft):
    """F_soft(u) = F(u - C F_soft): press rigidly to exactly that depth."""
    sensor, f = soft.steps[-1].indentation_m, soft.steps[-1].reaction_force_N
    left = 1e3 * sensor - COMPLIANCE * f
    again = pressed(Press(indentation_mm=left, load_steps=4))
    assert 0.05 < left / 0.2 < 0.95
    assert f == pytest.approx(again.steps[-1].reaction_force_N, rel=1e-8)
    assert charge(soft)[-1] == pytest.approx(charge(again)[-1], rel=1e-8)
    assert 1e3 * soft.trace.dot_path_m[-1] == pytest.approx(left, rel=1e-8)


def test_a_prescribed_force_reaches_the_state_of_the_prescribed_depth(rigid):
    driven = pressed(Press(force_N=rigid.steps[-1].reaction_force_N, load_steps=4))
    assert driven.steps[-1].indentation_m == pytest.approx(2e-4, rel=1e-8)
    assert charge(driven)[-1] == pytest.approx(charge(rigid)[-1], rel=1e-8)


def test_a_gap_shifts_the_curve(rigid):
    """F(u) behind a gap g is F(u - g), and nothing happens before the touch."""
    rest = ridge(STACK)
    away = replace(rest, origin_mm=rest.origin_mm + np.array([0.0, 0.0, 0.05]))
    press = Press(indentation_mm=0.25, load_steps=10)
    result = press_segment(STACK, materials(), away, press, mesh_of(False))
    assert result.steps[-1].reaction_force_N == pytest.approx(rigid.steps[-1].reaction_force_N, rel=1e-8)
    assert abs(force(result)[1]) <= 1e-12 * force(result)[-1]


def test_a_mass_on_a_prescribed_path_adds_its_inertia():
    """F = F_contact + m a'', a of the raised cosine d/2 (1 - cos(pi t / T)), T = 20 ms."""
    press = waved("raised-cosine", 16, rise_s=0.02)
    result = pressed(press, Physics(terms=(MovingMass(MASS_G),)))
    time = result.trace.time_s[1:-1]
    acceleration = 0.5 * 2e-4 * (np.pi / 0.02) ** 2 * np.cos(np.pi * time / 0.02)
    extra = force(result)[1:-1] + result.trace.contact_force_N[1:-1, 2] * np.sign(-result.trace.contact_force_N[-1, 2])
    np.testing.assert_allclose(extra, 1e-3 * MASS_G * acceleration, atol=5e-3 * 1e-3 * MASS_G * acceleration.max())


@for_each(("forces_N", "presliding_mm"), [((2.0,), (0.1,)), ((0.5, 3.0), (0.02, 0.7))])
def test_a_loop_loses_coulombs_force_times_the_way_that_slips(forces_N, presliding_mm):
    """Between A and -A each slider slips 2 A - 2 d either way: together they lose sum 4 F (A - d)."""
    amplitude_mm = 1.5
    path = amplitude_mm * np.sin(np.linspace(0.0, 4.0 * np.pi, 4001))
    force = GuideFriction(forces_N, presliding_mm).sliding_force_N(path)
    second = slice(len(path) // 2, None)  # the first loop begins at rest
    lost = np.trapezoid(force[second], path[second])
    ways = [4.0 * f * (amplitude_mm - d) for f, d in zip(forces_N, presliding_mm, strict=True)]
    assert lost == pytest.approx(sum(ways), rel=1e-3)


def test_a_guide_rubs_beside_the_segment():
    """The sensor reads F_c more on the way in and less on the way out; the segment itself feels nothing."""
    press = waved("trapezoid", 8, rise_s=0.1, fall_s=0.2)
    result, plain = pressed(press, Physics(added=(GuideFriction((0.4,), (0.05,)),))), pressed(press)
    extra = force(result) - np.abs(result.trace.contact_force_N[:, 2])
    depth_mm = 1e3 * result.trace.indentation_m
    deepest = int(np.argmax(depth_mm))
    inwards, outwards = depth_mm[: deepest + 1] >= 0.05, depth_mm[deepest:] <= depth_mm[deepest] - 0.1
    np.testing.assert_allclose(extra[: deepest + 1][inwards], 0.4, rtol=1e-9)
    np.testing.assert_allclose(extra[deepest:][outwards], -0.4, rtol=1e-9)
    assert inwards.sum() > 3
    assert outwards.sum() > 2
    assert charge(result)[deepest] == pytest.approx(charge(plain).max(), rel=1e-9)


@pytest.fixture(scope="module")
def stiffness():
    """N/m of the plate on the block at a depth of 0.4 % of its height, where it is linear within that."""
    press = Press(indentation_mm=1e3 * REACH_M, load_steps=1)
    result = press_segment(BLOCK, foams(), plate(BLOCK), press, mesh_of(True))
    return result.steps[-1].reaction_force_N / REACH_M


def tapped(stiffness, steps):
    """Path (t,) of a tapped mass over F0 / k, and that of the linear oscillator."""
    omega = np.sqrt(stiffness / (1e-3 * MASS_G))
    ratio, push = 0.5, REACH_M * stiffness
    press = waved("half-sine", steps, force_N=push, rise_s=0.5 * np.pi / (ratio * omega))
    result = pressed(press, Physics(terms=(MovingMass(MASS_G),)), flat=True)
    time = result.trace.time_s
    exact = (np.sin(ratio * omega * time) - ratio * np.sin(omega * time)) / (1.0 - ratio**2)
    return result.trace.dot_path_m / REACH_M, exact


@pytest.mark.press
def test_a_tapped_mass_follows_the_linear_oscillator(stiffness, monkeypatch):
    """x = F0/k (sin r w t - r sin w t) / (1 - r^2), within the block's own 0.4 % and the step; of second order."""
    monkeypatch.setattr("solve.solution.march.TIME_TOLERANCE", np.inf)
    paths = [tapped(stiffness, steps) for steps in (12, 24, 48)]
    np.testing.assert_allclose(*paths[-1], atol=0.015)
    coarse, middle, fine = (path[:: len(path) // 12] for path, _ in paths)
    order = np.log2(np.abs(coarse - middle).max() / np.abs(middle - fine).max())
    assert order == pytest.approx(2.0, abs=0.2)


def put_in(result):
    """Work of the dot on the segment up to every converged state (t,), by straight lines."""
    contact, path = result.trace.contact_force_N[:, 2], result.trace.dot_path_m
    return np.append(0.0, np.cumsum(0.5 * (contact[1:] + contact[:-1]) * np.diff(path)))


@pytest.mark.press
@for_each("steps", [1, 2, 3])
def test_a_light_dot_that_strikes_too_fast_for_the_steps_gains_nothing_from_the_blow_and_the_result_says_so(steps):
    """0.03 g under a force, across a gap: it would rebound within a thousandth of a load step."""
    away = plate(BLOCK)
    away = replace(away, origin_mm=away.origin_mm + np.array([0.0, 0.0, 0.09]))
    press = Press(force_N=0.005, load_steps=steps)
    result = press_segment(BLOCK, foams(), away, press, mesh_of(True), None, Physics(terms=(MovingMass(0.03),)))
    work = put_in(result)
    assert result.converged
    assert work.min() > -0.05 * work.max()
    (said,) = result.warnings
    assert "the error of the time integration in one sub-step is" in said
    assert "more load steps (press.load_steps)" in said

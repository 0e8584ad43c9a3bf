"""Spring and mass between sensor and dot, against the linear oscillator.

The contact is a linear spring k here: m a'' + k a = F, or (u - a) / c on the right side.
"""

import numpy as np
import pytest

from solve.terms.inertia import MassTerm
from solve.terms.rig import RigTerm
from tests.solve.trial import trial

STIFFNESS, MASS = 5.0, 0.02
OMEGA = np.sqrt(STIFFNESS / MASS)


def rig_of(mass, compliance):
    """The drive, and a mass where there is one."""
    drive_term = RigTerm(0, compliance, alone=mass == 0.0)
    return (drive_term, MassTerm(0, mass)) if mass else (drive_term,)


def drive(rig, loads, time, stiffness=STIFFNESS):
    """Approach, velocity and acceleration (t, 3) of the dot under drives (t,) at times (t,), from rest."""
    histories, a, motion = [one.start() for one in rig], 0.0, [np.zeros(3)]
    for load, dt in zip(loads[1:], np.diff(time), strict=True):
        step = {"time_step": dt, "drive": load, "previous_move": np.array([0.0, 0.0, -a])}
        for _ in range(2):  # linear: the second iteration finds no residual
            residual, tangent = balance(rig, trial(np.zeros((1, 3)), [a], **step), histories)
            a -= (residual + stiffness * a) / (tangent + stiffness)
        state = trial(np.zeros((1, 3)), [a], **step)
        histories = [one.advance(state, history) for one, history in zip(rig, histories, strict=True)]
        velocity, acceleration, _ = histories[-1] if len(rig) > 1 else np.zeros(3)
        motion.append(np.array([a, velocity, acceleration]))
    return np.array(motion)


def balance(rig, state, histories):
    """Residual and tangent of all of it."""
    blocks = [next(iter(one.elements(state, history))) for one, history in zip(rig, histories, strict=True)]
    return sum(block.residuals[0, 0] for block in blocks), sum(block.matrices[0, 0, 0] for block in blocks)


def half_sine(time, ratio):
    """x k / F0 of an oscillator from rest under F0 sin(r w t)."""
    return (np.sin(ratio * OMEGA * time) - ratio * np.sin(OMEGA * time)) / (1.0 - ratio**2)


def test_a_tapped_mass_follows_the_closed_form_with_second_order():
    errors = []
    for steps in (50, 100, 200):
        time = np.linspace(0.0, np.pi / (0.4 * OMEGA), steps + 1)
        ours = drive(rig_of(MASS, None), np.sin(0.4 * OMEGA * time), time)[:, 0] * STIFFNESS
        errors.append(np.abs(ours - half_sine(time, 0.4)).max())
    assert errors[-1] < 1e-3
    np.testing.assert_allclose(np.log2(np.divide(errors[:-1], errors[1:])), 2.0, atol=0.1)


def struck(periods):
    """Energy (n,) at times in periods after a tap that lasts half a period."""
    tap = np.linspace(0.0, 0.5, 20)
    time = np.concatenate([tap, 0.5 + periods]) * 2.0 * np.pi / OMEGA
    loads = np.concatenate([np.sin(2.0 * np.pi * tap), np.zeros_like(periods)])
    a, velocity, _ = drive(rig_of(MASS, None), loads, time)[19:].T
    energy = 0.5 * MASS * velocity**2 + 0.5 * STIFFNESS * a**2
    assert energy[0] > 0.01 / STIFFNESS
    return energy


def left_of_energy(oscillations, steps):
    """Share of the energy that is left after so many free oscillations in so many steps each."""
    energy = struck(np.arange(1, oscillations * steps + 1) / steps)
    return energy[-1] / energy[0]


def test_free_oscillations_keep_their_energy_to_third_order():
    lost = [-np.log(left_of_energy(20, steps)) for steps in (40, 80, 160)]
    assert lost[0] < 0.1
    np.testing.assert_allclose(np.log2(np.divide(lost[:-1], lost[1:])), 3.0, atol=0.1)


def test_oscillations_too_fast_for_the_steps_fade():
    """In steps of sixteen periods half of the motion is left after each; a double root, hence the steps squared."""
    energy = struck(16.0 * np.arange(1.0, 21.0))
    assert energy[-1] < 20.0**2 * 0.25**19 * energy[1]


def test_two_springs_in_series_share_the_travel():
    """a = u / (1 + c k), F = u k / (1 + c k)."""
    rig, travel = rig_of(0.0, 0.3), np.array([0.0, 0.5, 1.0])
    a = drive(rig, travel, np.arange(3.0))[:, 0]
    np.testing.assert_allclose(a, travel / (1.0 + 0.3 * STIFFNESS), rtol=1e-14)
    state = trial(np.zeros((1, 3)), [a[-1]], drive=1.0)
    assert rig[0].drive_force(state) == pytest.approx(STIFFNESS * a[-1], rel=1e-14)


def test_a_force_on_a_massless_dot_is_the_force_of_the_contact():
    a = drive(rig_of(0.0, None), np.array([0.0, 2.0, 4.0]), np.arange(3.0))[:, 0]
    np.testing.assert_allclose(STIFFNESS * a, [0.0, 2.0, 4.0], rtol=1e-14)


def test_a_mass_behind_a_spring_rings_at_the_frequency_of_both_springs():
    """A travel that grows slowly, then rests: a'' m = (u - a) / c - k a, w^2 = (k + 1/c) / m."""
    compliance = 0.3
    w = np.sqrt((STIFFNESS + 1.0 / compliance) / MASS)
    time = np.linspace(0.0, 2.25 * 2.0 * np.pi / w, 2001)
    a = drive(rig_of(MASS, compliance), time, time)[:, 0]
    expected = (time - np.sin(w * time) / w) / (1.0 + compliance * STIFFNESS)
    np.testing.assert_allclose(a, expected, atol=1e-4 * expected.max())


def test_long_at_rest_a_mass_does_not_move():
    rig = rig_of(MASS, 0.3)
    assert balance(rig, trial(np.zeros((1, 3)), [0.0], np.inf), [one.start() for one in rig]) == (0.0, 1.0 / 0.3)


def test_the_estimated_error_of_a_step_falls_with_its_cube():
    """The local error in dt^2 (a_new - a_old): a third order quantity."""
    rig, errors = rig_of(MASS, None), []
    for steps in (100, 200):
        time = np.linspace(0.0, 1.3 / OMEGA, steps + 1)
        motion = drive(rig, np.sin(0.5 * OMEGA * time), time)
        old, new = (np.array([v, acc, a]) for a, v, acc in motion[-2:])
        errors.append(rig[1].time_error(old, new, time[1], after_kink=False) * abs(new[2]))
    assert np.log2(errors[0] / errors[1]) == pytest.approx(3.0, abs=0.1)

"""The Prony update at a material point."""

import numpy as np
import pytest

from solve.materials.inelastic import StressResponse
from solve.materials.prony import Prony
from tests.cases import for_each

G, TAU = (0.3, 0.2), (0.05, 0.7)
SERIES = Prony(G, TAU)


def answer(series, stress, time):
    """Relaxed stress (t,) of a history (t,) of the elastic one, from rest."""
    memory, relaxed = series.start(1), [0.0]
    for value, dt in zip(stress[1:], np.diff(time), strict=True):
        elastic = StressResponse(np.full((1, 6), value), np.eye(6)[None])
        response, memory = series.update(elastic, memory, dt)
        relaxed.append(response.stress[0, 0])
    return np.array(relaxed)


def relaxation(time):
    """G(t) / G(0)."""
    return 1.0 - sum(g * (1.0 - np.exp(-time / tau)) for g, tau in zip(G, TAU, strict=True))


def ramp(time):
    """Answer to S0 = t: the integral of G."""
    return (1.0 - sum(G)) * time - sum(g * tau * np.expm1(-time / tau) for g, tau in zip(G, TAU, strict=True))


def test_a_step_relaxes_along_the_series_whatever_the_steps():
    time = np.array([0.0, 0.0, 0.01, 0.5, 0.6, 3.0])
    relaxed = answer(SERIES, np.array([0.0, 1.0, 1.0, 1.0, 1.0, 1.0]), time)
    np.testing.assert_allclose(relaxed[1:], relaxation(time[1:]), rtol=1e-13)


def test_a_ramp_and_the_hold_after_it_are_exact_whatever_the_steps():
    time = np.array([0.0, 0.02, 0.3, 0.5, 0.51, 0.8, 4.0])
    expected = ramp(time) - np.where(time > 0.5, ramp(np.maximum(time - 0.5, 0.0)), 0.0)
    np.testing.assert_allclose(answer(SERIES, np.minimum(time, 0.5), time), expected, atol=1e-13)


@for_each("frequency", [0.2, 1.0, 3.0])
def test_a_sine_has_the_storage_and_loss_moduli_of_the_series(frequency):
    """G' = 1 - sum g / (1 + (w tau)^2), G'' = sum g w tau / (1 + (w tau)^2); the work lost in a cycle is pi G''."""
    w, cycles, per_cycle = 2.0 * np.pi * frequency, 20, 400
    time = np.arange(cycles * per_cycle + 1) / (per_cycle * frequency)
    strain = np.sin(w * time)
    stress = answer(SERIES, strain, time)[-per_cycle - 1 :]
    storage = 1.0 - sum(g / (1.0 + (w * tau) ** 2) for g, tau in zip(G, TAU, strict=True))
    loss = sum(g * w * tau / (1.0 + (w * tau) ** 2) for g, tau in zip(G, TAU, strict=True))
    phase = w * time[-per_cycle - 1 :]
    assert 2.0 * np.mean(stress[1:] * np.sin(phase[1:])) == pytest.approx(storage, rel=1e-4)
    assert 2.0 * np.mean(stress[1:] * np.cos(phase[1:])) == pytest.approx(loss, rel=1e-4)
    work = np.sum(0.5 * (stress[1:] + stress[:-1]) * np.diff(np.sin(phase)))
    assert work == pytest.approx(np.pi * loss, rel=1e-3)


def test_the_update_is_second_order_in_time():
    """Error of S0 = (1 - cos pi t) / 2 at t = 1 against the closed form of each branch."""
    exact = 0.5 * relaxed_raised_cosine()
    errors = [abs(answer(SERIES, 0.5 * (1.0 - np.cos(np.pi * t)), t)[-1] - exact) for t in map(grid, (16, 32, 64))]
    np.testing.assert_allclose(np.log2(np.divide(errors[:-1], errors[1:])), 2.0, atol=0.05)


def grid(steps):
    return np.linspace(0.0, 1.0, steps + 1)


def relaxed_raised_cosine():
    """Twice the answer to (1 - cos pi t) / 2 at t = 1: the integral of G(1 - s) pi sin(pi s)."""
    w = np.pi
    return 2.0 * (1.0 - sum(G)) + sum(
        g * w**2 * tau**2 * (1.0 + np.exp(-1.0 / tau)) / (1.0 + w**2 * tau**2) for g, tau in zip(G, TAU, strict=True)
    )


@for_each("series", [Prony((), ()), Prony((0.0,), (0.5,))])
def test_without_relaxing_share_it_is_elastic(series):
    time = np.linspace(0.0, 1.0, 8)
    np.testing.assert_allclose(answer(series, np.sin(time), time), np.sin(time), rtol=1e-15)


def test_the_tangent_is_the_derivative_of_the_relaxed_stress():
    law, memory = np.diag(np.arange(1.0, 7.0)), SERIES.start(1)
    _, memory = SERIES.update(StressResponse(np.ones((1, 6)), law[None]), memory, 0.1)
    strain, change = np.linspace(0.1, 0.6, 6), 1e-3
    at = [
        SERIES.update(StressResponse((s @ law)[None], law[None]), memory, 0.2)[0]
        for s in (strain, *(strain + change * e for e in np.eye(6)))
    ]
    slope = np.stack([(r.stress - at[0].stress)[0] / change for r in at[1:]], axis=1)
    np.testing.assert_allclose(at[0].tangent[0], slope, atol=1e-10)


def test_the_estimated_error_of_a_step_is_its_error():
    """S0 = t^2 from t = 1, dt << tau: the estimate of the last step against the exact integral, within 5 %."""
    series, dt, tau = Prony((0.4,), (2.0,)), 0.02, 2.0
    memory = series.start(1)
    for end, step in ((1.0 - 2.0 * dt, 1.0), (1.0 - dt, dt), (1.0, dt)):
        old = memory
        _, memory = series.update(StressResponse(np.full((1, 6), end**2), np.eye(6)[None]), old, step)
    s = np.linspace(1.0 - dt, 1.0, 20_001)
    exact = np.trapezoid(0.4 * np.exp(-(1.0 - s) / tau) * 2.0 * s, s)
    ours = memory[2][0, 0, 0] - np.exp(-dt / tau) * old[2][0, 0, 0]
    assert series.time_error(old, memory, dt, after_kink=False) == pytest.approx(abs(ours - exact), rel=0.05)

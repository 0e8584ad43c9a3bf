"""Viscoelasticity of whole bodies against the hereditary integral of their elastic force."""

import numpy as np
import pytest

from solve.materials.prony import Prony
from solve.physics import Physics
from tests.cases import for_each
from tests.verification.slices import charge, force, pressed, waved

G, TAU = (0.3, 0.2), (0.05, 0.7)
SERIES = Prony(G, TAU)
EVERYWHERE = Physics(inelastic={"medium1": (SERIES,), "medium2": (SERIES,), "film": (SERIES,)})
SMALL_MM = 2e-3  # of a block 2.5 mm high: linear within 0.1 %


def relaxation(time):
    return 1.0 - sum(g * (1.0 - np.exp(-time / tau)) for g, tau in zip(G, TAU, strict=True))


def ramp(time):
    """The integral of the relaxation."""
    time = np.maximum(time, 0.0)
    return (1.0 - sum(G)) * time - sum(g * tau * np.expm1(-time / tau) for g, tau in zip(G, TAU, strict=True))


def test_a_body_pressed_at_once_relaxes_along_the_series():
    """Where every layer has the same series, at fixed depth the field stays and all stresses fade alike."""
    result = pressed(waved("ramp", 3, rise_s=1e-7, hold_s=1.0), EVERYWHERE, flat=True)
    time = result.trace.time_s
    hold = time >= 1e-7
    for history in (force(result), charge(result)):
        np.testing.assert_allclose(history[hold] / history[hold][0], relaxation(time[hold] - 1e-7), rtol=1e-6)


def test_a_ramp_and_its_hold_follow_the_hereditary_integral():
    result = pressed(waved("ramp", 3, SMALL_MM, rise_s=0.3, hold_s=1.0), EVERYWHERE, flat=True)
    elastic = pressed(waved("ramp", 3, SMALL_MM, rise_s=0.3), flat=True)
    time, full = result.trace.time_s, force(elastic)[-1]
    expected = full * (ramp(time) - ramp(time - 0.3)) / 0.3
    np.testing.assert_allclose(force(result), expected, atol=1e-3 * full)


@pytest.mark.press
def test_a_cycle_loses_the_work_of_the_loss_modulus(tmp_path):
    """Depth d (1 - cos(w t)) / 2 of a plate that stays in contact: the work of the last cycle is pi G'' k (d/2)^2.

    It rests at its full depth long before, so that the oscillation stays in compression.
    """
    frequency, steps, cycles = 2.0, 24, 4
    time = np.arange(cycles * steps + 1) / (steps * frequency)
    table = tmp_path / "cycles.csv"
    share = 0.6 - 0.1 * np.cos(2.0 * np.pi * frequency * time)  # a cycle begins at a row that lies on no line
    rows = "\n".join(f"{10.0 + t:.12g},{f:.12g}" for t, f in zip(time, share, strict=True))
    table.write_text(f"time_s,fraction\n0,0\n{1e-6:g},0.5\n{rows}\n", "utf-8")
    result = pressed(waved("file", 1, SMALL_MM, file=str(table)), EVERYWHERE, flat=True)
    elastic = pressed(waved("ramp", 2, SMALL_MM), flat=True)
    last = result.trace.time_s >= 10.0 + time[-steps - 1] - 1e-9
    depth, f = result.trace.indentation_m[last], force(result)[last]
    work = float(np.sum(0.5 * (f[1:] + f[:-1]) * np.diff(depth)))
    w = 2.0 * np.pi * frequency
    loss = sum(g * w * tau / (1.0 + (w * tau) ** 2) for g, tau in zip(G, TAU, strict=True))
    expected = np.pi * loss * force(elastic)[-1] / (1e-3 * SMALL_MM) * (1e-4 * SMALL_MM) ** 2
    assert work == pytest.approx(expected, rel=0.02)  # 24 chords a cycle are (2 pi / 24)^2 / 6 = 1.1 % short


@pytest.mark.press
@for_each("series", [Prony((), ()), Prony((0.0,), (0.5,))])
def test_without_relaxing_share_the_segment_is_elastic(series):
    press = waved("ramp", 3, rise_s=0.1)
    viscous, elastic = pressed(press, Physics(inelastic={"medium2": (series,), "film": (series,)})), pressed(press)
    assert force(viscous)[-1] == pytest.approx(force(elastic)[-1], rel=1e-9)
    assert charge(viscous)[-1] == pytest.approx(charge(elastic)[-1], rel=1e-9)


RUBBER = Physics(inelastic={"medium2": (SERIES,), "effector": (SERIES,)})


@pytest.mark.press
def test_the_raised_cosine_press_is_second_order_in_time(monkeypatch):
    """Force at the end of the rise against Richardson's limit of the two finest."""
    monkeypatch.setattr("solve.solution.march.TIME_TOLERANCE", np.inf)
    end = [force(pressed(waved("raised-cosine", n, rise_s=0.3), RUBBER))[-1] for n in (6, 12, 24, 48)]
    limit = end[-1] + (end[-1] - end[-2]) / 3.0
    errors = np.abs(np.array(end[:3]) - limit)
    np.testing.assert_allclose(np.log2(errors[:-1] / errors[1:]), 2.0, atol=0.3)


@pytest.mark.press
def test_a_smaller_tolerance_gives_a_smaller_error(monkeypatch):
    """The targets along the waveform stay: what changes is only the steps between them."""

    def end(tolerance):
        monkeypatch.setattr("solve.solution.march.TIME_TOLERANCE", tolerance)
        result = pressed(waved("raised-cosine", 2, rise_s=0.3), RUBBER)
        return force(result)[-1], len(result.trace.time_s)

    ends = [end(t) for t in (1e-3, 2.5e-4, 6e-5, 3e-6)]
    assert [steps for _, steps in ends] == sorted(steps for _, steps in ends)
    errors = [abs(f / ends[-1][0] - 1.0) for f, _ in ends[:-1]]
    assert errors[0] > errors[1] > errors[2]

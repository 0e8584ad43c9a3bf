"""Hysteresis of the film: closed forms of plays, and Rayleigh's law as their sum."""

import numpy as np
import pytest

from diagnose.engines.proportional.engine import proportional_engine
from diagnose.forward import Setting
from diagnose.signals.recording import Recording, Run
from solve.added import TouchedFilm
from solve.readout.hysteresis import FilmHysteresis
from solve.stop_operator import apply_stop
from tests.cases import for_each

TURNS = np.array([0.0, 1.0, -1.0, 1.0, -1.0, 1.0])
COURSE = np.interp(np.linspace(0.0, 5.0, 5001), np.arange(6.0), TURNS)
LOOP = slice(1000, 3001)  # from the largest value to the least and back


def charge(on, signal_pC):
    """Of a film whose strain makes this charge, in pC."""
    none = np.zeros(len(signal_pC))
    film = TouchedFilm(none, none, np.ones(1), 0.0, 1e-12 * signal_pC[:, None])
    return signal_pC + 1e12 * on.charge_C(film)[:, 0]


@for_each("r", [0.05, 0.3, 0.8])
def test_a_loop_of_one_play_loses_four_times_its_width_and_what_is_left_of_the_amplitude(r):
    """4 b r (A - r) between -A and A, none where A < r; the same when it takes ten times as long."""
    shown = charge(FilmHysteresis((0.2,), (r,)), COURSE)
    loss = abs(np.sum(0.5 * (shown[LOOP][1:] + shown[LOOP][:-1]) * np.diff(COURSE[LOOP])))
    assert loss == pytest.approx(0.2 * 4.0 * r * (1.0 - r), rel=1e-3)
    slowly = charge(FilmHysteresis((0.2,), (r,)), np.repeat(COURSE, 10))
    np.testing.assert_allclose(slowly[::10], shown, atol=1e-12)
    np.testing.assert_allclose(charge(FilmHysteresis((0.2,), (1.5,)), COURSE), 0.8 * COURSE, atol=1e-12)


def test_a_press_leaves_a_share_of_its_charge_behind():
    """Up to Q and back: each play leaves b r, or b (Q - r) where it never came back."""
    press = np.interp(np.linspace(0.0, 2.0, 201), [0.0, 1.0, 2.0], [0.0, 1.0, 0.0])
    shown = charge(FilmHysteresis((0.1, 0.2), (0.1, 0.6)), press)
    assert shown[100] == pytest.approx(1.0 - 0.1 * 0.1 - 0.2 * 0.6)
    assert shown[-1] == pytest.approx(0.1 * 0.1 + 0.2 * 0.4)


def rayleigh(course, amplitude):
    """Loop (d0 + alpha A) x -+ (alpha / 2) (A^2 - x^2) of Rayleigh's law, and d0 x + alpha x |x| on the first way."""
    way = np.sign(np.gradient(course))
    loop = (1.0 + 0.5 * amplitude) * course - way * 0.25 * (amplitude**2 - course**2)
    first = np.arange(len(course)) < 1000
    return np.where(first, course + 0.5 * course * np.abs(course), loop)


def sensor(signal, time=None):
    """A sensor of unknown geometry of which force and voltage are recorded, the force as it is driven."""
    time = np.linspace(0.0, 5.0, len(COURSE)) if time is None else time
    channels = {"force_N": COURSE, "voltage_V": signal}
    there = {name: np.ones(len(time), dtype=bool) for name in channels}
    none = {name: ~flags for name, flags in there.items()}
    run = Run("loop", "loop.csv", time, "force_N", channels, there, none)
    return proportional_engine(Recording((run,)), lambda *_: None)


def left_of(engine, signal, candidate):
    """Share of a signal that the proportional charge, and that with a candidate, leave: it is linear in the shares."""
    unit = [Setting(candidate, tuple(row)) for row in np.eye(len(candidate.coordinates))]
    plain = engine.predict(0, [])["voltage_V"]
    columns = np.column_stack([plain, *(engine.predict(0, [one])["voltage_V"] - plain for one in unit)])
    plays = np.linalg.lstsq(columns, signal, rcond=None)[0]
    factor = signal @ plain / (plain @ plain)
    return tuple(np.linalg.norm(signal - one) / np.linalg.norm(signal) for one in (factor * plain, columns @ plays))


def test_plays_at_four_widths_make_rayleighs_law():
    """They miss a twentieth of what a charge in proportion to the force does."""
    signal = rayleigh(COURSE, 1.0)
    engine = sensor(signal)
    (plays,) = (one for one in engine.candidates if one.mechanism == "hysteresis")
    before, after = left_of(engine, signal, plays)
    assert before > 0.05
    assert after < 0.05 * before


def test_the_same_loop_at_another_rate_has_the_same_plays():
    engine, slow = (sensor(COURSE, time) for time in (np.linspace(0.0, 5.0, 5001), np.linspace(0.0, 500.0, 5001)))
    (plays,) = (one for one in engine.candidates if one.mechanism == "hysteresis")
    on = [Setting(plays, tuple(0.1 for _ in plays.coordinates))]
    np.testing.assert_allclose(engine.predict(0, on)["voltage_V"], slow.predict(0, on)["voltage_V"], rtol=1e-9)


def test_a_push_may_have_another_loop_than_a_pull():
    """Plays of the positive part leave the pull alone; one that is never crossed takes a share of the push."""
    on = FilmHysteresis(push_shares=(0.2, 0.3), push_play_pC=(0.1, 5.0))
    shown = charge(on, COURSE)
    assert shown[np.argmax(COURSE)] == pytest.approx(1.0 - 0.2 * 0.1 - 0.3)
    assert shown[np.argmin(COURSE)] == pytest.approx(-1.0 + 0.2 * 0.1)  # what is left of the push
    np.testing.assert_allclose(np.diff(shown)[COURSE[1:] < 0.0], np.diff(COURSE)[COURSE[1:] < 0.0], atol=1e-12)


def test_a_stop_is_what_its_play_leaves():
    signal = np.cumsum(np.random.default_rng(2).standard_normal(500))
    stop = apply_stop(signal, 1.5)
    play = signal - signal[0] - stop
    assert np.abs(stop).max() <= 1.5
    moved = np.abs(np.diff(play)) > 1e-12
    assert np.all(np.abs(np.abs(stop[1:][moved]) - 1.5) < 1e-12)  # what has slipped has slipped at the limit

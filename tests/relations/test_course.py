"""What holds for the course of any press: closed forms of an RC, causality, refinement, one course by two shapes."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from solve.materials.prony import Prony
from solve.model import Press, Readout
from solve.physics import Physics
from solve.readout.amplifier import curved_integral, leaky_integral
from solve.readout.course import course
from solve.solution.schedule import duration_s, fraction, schedule
from solve.waveform import Waveform
from tests.cases import for_each
from tests.verification.slices import pressed

FULL_C, FILM_F = 1e-9, 24e-12
DECADES = st.floats(-4.0, 2.0)
SEVERAL = settings(max_examples=10, deadline=None)


def press_of(charge, steps=6, capacitance_F=FILM_F):
    """A press whose charges (s, e) in C are a function of the share of its depth (s,)."""
    progress = np.linspace(0.0, 1.0, steps + 1)
    charges = np.reshape(charge(progress), (steps + 1, -1))
    trace = SimpleNamespace(time_s=progress, indentation_m=progress, reaction_force_N=progress, film_charge_C=charges)
    return SimpleNamespace(
        trace=trace, progress=progress, steps=tuple(SimpleNamespace(time_s=t) for t in progress), follows_time=False,
        capacitance_F=np.full(charges.shape[1], capacitance_F),
    )  # fmt: skip


SPRING = press_of(lambda share: FULL_C * share)


def read(waveform, readout, result=SPRING, physics=None):
    return course(result, Press(waveform=waveform), readout, physics or Physics())


def ramps(time, corners, tau):
    """Response (t,) of V' + V / tau = u' to straight lines through corners (times, shares)."""
    at, share = np.array(corners, dtype=float).T
    rates = np.diff(share) / np.diff(at)
    answer = np.zeros_like(time)
    for start, change in zip(at, np.diff(rates, prepend=0.0, append=0.0), strict=True):
        answer -= change * tau * np.expm1(-np.maximum(time - start, 0.0) / tau)
    return answer


def closed_form(waveform, time, tau):
    """Of u in place of V, for the whole course."""
    rise, hold, fall = waveform.rise_s, waveform.hold_s, waveform.fall_s
    if waveform.shape == "half-sine":
        x = np.pi / (2.0 * rise) * tau
        return x * (np.cos(x * time / tau) + x * np.sin(x * time / tau) - np.exp(-time / tau)) / (1.0 + x**2)
    if waveform.shape == "raised-cosine":
        x = np.pi / rise * tau
        return 0.5 * x * (np.sin(x * time / tau) - x * np.cos(x * time / tau) + x * np.exp(-time / tau)) / (1 + x**2)
    corners = [(0.0, 0.0), (rise, 1.0), (rise + hold, 1.0)][: 3 if hold else 2]
    if waveform.shape == "trapezoid":
        corners.append((rise + hold + fall, 0.0))
    return ramps(time, corners, tau)


@st.composite
def waveforms(draw):
    """Of 1 mHz to 10 kHz."""
    rise = 0.25 * 10.0 ** draw(st.floats(-4.0, 3.0))
    shape = draw(st.sampled_from(["ramp", "half-sine", "raised-cosine", "trapezoid"]))
    held, fallen = (rise * 10.0 ** draw(st.floats(-2.0, 2.0)) for _ in range(2))
    acting = {"ramp": {"hold_s": held}, "trapezoid": {"hold_s": held, "fall_s": fallen}}
    return Waveform(shape=shape, rise_s=rise, **acting.get(shape, {}))


@st.composite
def circuits(draw):
    """Voltage mode and charge mode, with the gain in V per C and the time constant."""
    resistance, capacitance = 10.0 ** draw(st.floats(-2.0, 5.0)), 10.0 ** draw(st.floats(0.0, 4.0))
    if draw(st.booleans()):
        readout = Readout(mode="charge", feedback_pF=capacitance, feedback_MOhm=resistance)
        return readout, -1e12 / capacitance, 1e-6 * resistance * capacitance
    farads = FILM_F + 1e-12 * capacitance
    return (
        Readout(input_resistance_MOhm=resistance, input_capacitance_pF=capacitance),
        1 / farads,
        1e6 * resistance * farads,
    )


@SEVERAL
@given(waveforms(), circuits())
def test_a_linear_spring_reads_as_the_closed_form_of_an_rc(waveform, circuit):
    readout, gain, tau = circuit
    along = read(waveform, readout)
    expected = FULL_C * gain * closed_form(waveform, along.time_s, tau)
    np.testing.assert_allclose(along.together_V, expected, rtol=0, atol=1e-3 * np.abs(expected).max())
    assert along.readout_error_percent < 0.1


@SEVERAL
@given(
    st.lists(st.floats(0.0, 1.0), min_size=1, max_size=8).filter(lambda s: max(s) > 0.01), circuits(), st.floats(-4, 2)
)
def test_rows_of_a_file_are_corners_of_its_course(shares, circuit, decade):
    readout, gain, tau = circuit
    times, shares = 10.0**decade * np.arange(len(shares) + 1.0), np.array([0.0, *shares])
    along = read(Waveform.through(times, shares), readout)
    expected = FULL_C * gain * ramps(along.time_s, list(zip(times, shares, strict=True)), tau)
    np.testing.assert_allclose(along.together_V, expected, rtol=0, atol=1e-3 * np.abs(expected).max() + 1e-15)
    assert set(times) <= set(along.time_s)


@for_each("share", [0.0, 1e-6, 9e-4, 1.1e-3, 0.1, 3.0])
def test_an_input_integrates_a_parabola_exactly(share):
    """V' + V / tau = 2 t from rest; share : step over tau, 0 for no resistance. Straight lines likewise."""
    time = np.linspace(0.0, 4.0, 5)
    tau = 1.0 / share if share else np.inf
    exact = {1: time, 2: time**2}
    if share > 1e-5:  # below it, the closed form is all round-off
        exact[1] = -tau * np.expm1(-time / tau)
        exact[2] = 2.0 * tau * (time - exact[1])
    for power, integral in ((2, curved_integral), (1, curved_integral), (1, leaky_integral)):
        np.testing.assert_allclose(integral(time, time**power, 1.0, tau), exact[power], rtol=1e-5, atol=1e-12)


def bent(exponent):
    return lambda share: FULL_C * share**exponent


@SEVERAL
@given(waveforms(), circuits(), st.floats(1.0, 3.0), st.floats(0.01, 100.0), st.sampled_from([None, 0.1, 30.0]))
def test_what_comes_later_changes_nothing_before(waveform, circuit, exponent, longer, low_pass):
    """The rise before a hold, and before a hold of another length with a release."""
    readout, result = circuit[0].model_copy(update={"low_pass_Hz": low_pass}), press_of(bent(exponent))
    short = Waveform(rise_s=waveform.rise_s)
    held = Waveform(shape="trapezoid", rise_s=waveform.rise_s, hold_s=longer * waveform.rise_s, fall_s=waveform.fall_s)
    before, after = read(short, readout, result), read(held, readout, result)
    largest = np.abs(after.together_V).max()
    on = np.interp(before.time_s, after.time_s, after.together_V)
    np.testing.assert_allclose(on, before.together_V, rtol=0, atol=5e-4 * largest)
    assert after.together_V[after.solved[-1]] == pytest.approx(before.together_V[-1], rel=1e-3, abs=1e-4 * largest)


@SEVERAL
@given(waveforms(), circuits(), st.floats(1.25, 3.0), st.integers(2, 12))
def test_ten_times_the_states_are_within_the_stated_error(waveform, circuit, exponent, steps):
    readout = circuit[0]
    coarse, fine = (read(waveform, readout, press_of(bent(exponent), n)) for n in (steps, 10 * steps))
    on = np.interp(coarse.time_s, fine.time_s, fine.together_V)
    stated = 0.01 * (coarse.readout_error_percent + fine.readout_error_percent) + 5e-4
    assert np.abs(on - coarse.together_V).max() <= stated * np.abs(coarse.together_V).max()


def test_a_sum_of_charges_reads_as_the_sum_of_its_parts():
    """Channels of an amplifier each, of the same capacitance."""
    readout = Readout(input_resistance_MOhm=100.0, input_capacitance_pF=100.0, low_pass_Hz=20.0, high_pass_Hz=0.5)
    both = press_of(lambda s: FULL_C * np.column_stack([s, s**2, s + s**2]))
    along = read(Waveform(shape="half-sine", rise_s=0.1), readout, both)
    one, other, total = along.channels_V.T
    np.testing.assert_allclose(one + other, total, rtol=0, atol=1e-9 * np.abs(total).max())


def test_solved_states_are_where_the_waveform_first_comes_to_them():
    """sin(pi t / 2 T) = n / 6."""
    along = read(Waveform(shape="half-sine", rise_s=0.3), None)
    assert along.time_s[along.solved] == pytest.approx(0.6 / np.pi * np.arcsin(np.arange(7.0) / 6.0), abs=1e-9)
    assert along.together_V is None
    assert along.time_s[-1] == pytest.approx(0.6)


def test_a_charge_amplifier_decays_in_the_hold_and_swings_over_in_the_release():
    waveform = Waveform(shape="trapezoid", rise_s=0.2, hold_s=1.0, fall_s=0.2)
    along = read(waveform, Readout(mode="charge", feedback_pF=1000.0, feedback_MOhm=100.0))
    peak = 0.5 * (1.0 - np.exp(-2.0))  # 1 V over 2 time constants
    assert along.together_V.min() == pytest.approx(-peak, rel=1e-4)
    assert along.together_V.max() == pytest.approx(peak - peak * np.exp(-12.0), rel=1e-3)


OWN = Waveform(shape="trapezoid", rise_s=0.5, hold_s=1.0, fall_s=0.5)
VISCOUS = Physics(inelastic={"medium2": (Prony((0.2,), (0.3,)),)})
SLOW_RC = Readout(input_resistance_MOhm=1e4, input_capacitance_pF=100.0)


def trapezoid_by(rows, steps=6):
    """A press by the trapezoid's own key, or by rows of a file."""
    if rows is None:
        return Press(indentation_mm=0.2, load_steps=steps, waveform=OWN)
    times = np.union1d([0.0, 0.5, 1.5, 2.0], np.linspace(0.0, 2.0, rows - 2))
    return Press(indentation_mm=0.2, load_steps=steps, waveform=Waveform.through(times, fraction(OWN, times)))


@for_each("rows", [4, 200])
def test_all_files_of_one_trapezoid_ask_for_the_same_states(rows):
    """So that a press by one of them does for all."""
    ours, theirs = (schedule(trapezoid_by(n), 0.2, 1e-3, follows_time=True) for n in (40, rows))
    times = np.array([target.time for target in ours])
    np.testing.assert_allclose([target.time for target in theirs], times, rtol=0, atol=1e-12)
    between = 0.5 * (times[1:] + times[:-1])
    for one, other in zip(ours, theirs, strict=True):
        assert one.kink == other.kink
        assert one.load.drive == pytest.approx(other.load.drive, abs=1e-12)
        np.testing.assert_allclose([one.drive_at(t) for t in between], [other.drive_at(t) for t in between], atol=1e-12)


@pytest.fixture(scope="module")
def trapezoids():
    """A press through time by the trapezoid's own key with many steps, with few, and one by files of 4, 40, 200 rows.

    Under a flat dot, whose contact does not grow node by node.
    """
    by_key, by_file = (pressed(trapezoid_by(rows), VISCOUS, flat=True) for rows in (None, 40))
    fine = course(pressed(trapezoid_by(None, 20), VISCOUS, flat=True), trapezoid_by(None), SLOW_RC, VISCOUS)
    same = SLOW_RC, VISCOUS, fine.time_s
    return [
        fine,
        course(by_key, trapezoid_by(None), *same),
        *(course(by_file, trapezoid_by(rows), *same) for rows in (4, 40, 200)),
    ]


def test_a_trapezoid_is_the_same_by_its_key_and_by_rows_of_a_file(trapezoids):
    """All of them as with many steps until contact ends, which happens between two steps, and alike to the end."""
    fine, own, *files = trapezoids
    down = fine.time_s <= 1.5
    for name, within in (("together_V", 5e-3), ("reaction_force_N", 5e-3), ("indentation_m", 1e-6)):
        true = getattr(fine, name)
        bound = within * np.abs(true).max()
        for along in (own, *files):
            np.testing.assert_allclose(getattr(along, name)[down], true[down], rtol=0, atol=bound)
            np.testing.assert_allclose(getattr(along, name), getattr(own, name), rtol=0, atol=bound)
    for other in files[1:]:
        np.testing.assert_allclose(other.together_V, files[0].together_V, rtol=0, atol=1e-9)


def test_the_course_holds_until_the_waveform_has_ended(trapezoids):
    assert all(along.time_s[[0, -1]] == pytest.approx([0.0, 2.0]) for along in trapezoids)
    assert duration_s(Waveform(shape="trapezoid", hold_s=1.0)) == 2.0

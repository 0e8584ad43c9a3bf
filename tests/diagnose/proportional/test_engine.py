"""A sensor of unknown geometry against closed forms: proportional, leaking, creeping, relaxing, warming."""

import numpy as np
import pytest
from scipy.special import erf

from diagnose.engines.proportional.engine import proportional_engine
from diagnose.forward import Setting
from diagnose.signals.recording import Recording, Run
from foundation.errors import InputError
from solve.model import Readout
from tests.cases import for_each

RATE = 200.0
TIME = np.arange(2400) / RATE
UP, DOWN = 2.0, 8.0  # s, of a sudden press
STEP = np.where((TIME >= UP) & (TIME < DOWN), 3.0, 0.0)
RAMPS = np.interp(TIME, [1.0, 3.0, 4.0, 6.0, 7.0, 9.0], [0.0, 3.0, 3.0, 1.0, 3.0, 0.0])
HELD = (TIME >= UP + 2.0 / RATE) & (TIME < DOWN)
SINCE = TIME - UP


def silent(*_):
    """A report that nobody reads."""


def run(force=RAMPS, scale=(0.2,), label="run", **others):
    """Voltages in proportion to the force."""
    names = ["voltage_V"] if len(scale) == 1 else [f"voltage_{n + 1}_V" for n in range(len(scale))]
    channels = {"force_N": force, **{name: k * force for name, k in zip(names, scale, strict=True)}}
    there = {name: np.ones(len(force), dtype=bool) for name in channels}
    none = {name: ~flags for name, flags in there.items()}
    return Run(label, f"{label}.csv", TIME, "force_N", channels, there, none, **others)


def engine(*runs):
    """Of some runs."""
    return proportional_engine(Recording(runs or (run(),)), silent)


def candidate(of, mechanism, component):
    """By its name."""
    return next(one for one in of.candidates if one.name == (mechanism, component))


def voltage(of, *settings, number=0):
    """Of the only channel."""
    return of.predict(number, settings)["voltage_V"]


def test_the_baseline_is_the_force_times_a_free_number_for_each_channel():
    of = engine(run(scale=(0.2, -0.03)))
    first, second = of.predict(0, ()).values()
    np.testing.assert_allclose(first, 0.2 * RAMPS, atol=1e-12)
    np.testing.assert_allclose(second, -0.03 * RAMPS, atol=1e-12)
    doubled = of.predict(0, [Setting(of.free_nuisances[0], (1.0,)), Setting(of.free_nuisances[1], (-1.5,))])
    np.testing.assert_allclose(doubled["voltage_1_V"], 0.4 * RAMPS, atol=1e-12)
    np.testing.assert_allclose(doubled["voltage_2_V"], 0.015 * RAMPS, atol=1e-12)


def test_every_candidate_is_off_at_zero_and_answers_at_its_starts():
    of = engine()
    baseline = voltage(of)
    for one in of.candidates:
        assert np.array_equal(voltage(of, Setting(one, (0.0,) * len(one.coordinates))), baseline)
        for start in range(min(len(coordinate.starts) for coordinate in one.coordinates)):
            at = tuple(coordinate.starts[start] for coordinate in one.coordinates)
            changed = voltage(of, Setting(one, at))
            assert np.isfinite(changed).all()
            assert not np.allclose(changed, baseline, rtol=1e-4), (one.name, at)
            assert one.as_mechanism(at).parameters.keys() | one.derived(at).keys() <= one.units.keys()


def test_no_factor_is_a_candidate():
    of = engine(run(scale=(0.2, 0.1)))
    assert not {"parasitic-capacitance", "crosstalk", "property-error"} & {one.mechanism for one in of.candidates}
    assert of.nuisance("d31") is None


def test_a_leak_lets_a_held_press_decay_and_turns_the_release():
    of = engine(run(STEP))
    one = candidate(of, "charge-leakage", "readout")
    values = (3.0,)
    tau = one.derived(values)["time_constant_s"]
    leaking = voltage(of, Setting(one, values))
    peak = leaking[np.argmax(STEP > 0.0)]
    np.testing.assert_allclose(leaking[HELD] / peak, np.exp(-SINCE[HELD] / tau), rtol=1e-9)
    released = int(np.argmax(TIME >= DOWN))
    assert leaking[released] - leaking[released - 1] * np.exp(-1.0 / RATE / tau) == pytest.approx(-peak, rel=1e-9)
    capacitance_pF = of.scene.capacitance_pF
    assert tau == pytest.approx(1e-6 * one.parameters(values)["resistance_MOhm"] * capacitance_pF)


def test_a_film_that_relaxes_loses_the_charge_of_a_held_press():
    of = engine(run(STEP))
    one = candidate(of, "viscoelasticity", "film")
    values = (0.0, 0.0, 0.5, *(0.0,) * (len(one.coordinates) - 3))
    (g,), (tau,) = one.parameters(values).values()
    relaxed = voltage(of, Setting(one, values))
    since = SINCE[HELD] + 0.5 / RATE  # the press takes one sample, the middle of it counts
    np.testing.assert_allclose(relaxed[HELD] / (0.2 * 3.0), 1.0 - g * -np.expm1(-since / tau), rtol=1e-4)


def test_a_medium_that_relaxes_creeps_under_a_force_and_the_charge_grows():
    """The standard solid: J(t) / J(0) = 1 + g / (1 - g) (1 - exp(-(1 - g) t / tau)) (Tschoegl 1989)."""
    of = engine(run(STEP))
    one = candidate(of, "viscoelasticity", "medium1")
    values = (0.0, 0.5, *(0.0,) * (len(one.coordinates) - 2))
    (g,), (tau,) = one.parameters(values).values()
    crept = voltage(of, Setting(one, values))
    since = SINCE[HELD] + 0.5 / RATE  # the press takes one sample, the middle of it counts
    expected = 1.0 + g / (1.0 - g) * -np.expm1(-(1.0 - g) * since / tau)
    np.testing.assert_allclose(crept[HELD] / (0.2 * 3.0), expected, rtol=2e-4)


def test_a_medium_that_stiffens_yields_less_at_the_largest_force():
    of = engine()
    one = candidate(of, "hyperelastic-stiffening", "medium1")
    bent = voltage(of, Setting(one, (0.4, 0.2)))
    strain = bent / (0.2 * 3.0)
    np.testing.assert_allclose(strain + 0.4 * strain**3 + 0.2 * strain**5, RAMPS / 3.0, atol=1e-9)
    assert one.derived((0.4, 0.2))["force_ratio"] == pytest.approx(1.6)


def test_a_medium_that_softens_yields_more_on_the_way_back():
    of = engine()
    soft = voltage(of, Setting(candidate(of, "stress-softening", "medium1"), (0.3,)))
    first = TIME <= 3.0
    np.testing.assert_allclose(soft[first], 0.2 * RAMPS[first], atol=1e-9)
    strain = soft / (0.2 * 3.0)
    largest = np.maximum.accumulate(strain**2)
    eta = 1.0 - 0.3 * erf((largest - strain**2) / (0.3 * np.maximum(largest, 1e-30)))
    np.testing.assert_allclose(eta * strain, RAMPS / 3.0, atol=1e-5)


def test_heat_and_touch_add_charge_of_their_own():
    of = engine(run(STEP))
    heat, touch = candidate(of, "pyroelectric-drift", "film"), candidate(of, "contact-electrification", "film")
    drift = voltage(of, Setting(heat, (0.1, 0.5))) - voltage(of)
    tau = heat.parameters((0.1, 0.5))["time_constant_s"]
    warming = -np.expm1(-np.maximum(SINCE, 0.0) / tau)
    np.testing.assert_allclose(drift, drift[-1] * warming / warming[-1], atol=1e-9)
    ramped = engine()
    charge = voltage(ramped, Setting(candidate(ramped, "contact-electrification", "film"), (0.2, 0.0))) - voltage(
        ramped
    )
    np.testing.assert_allclose(charge, charge.max() * (RAMPS / 3.0) ** (2.0 / 3.0), atol=1e-12)
    assert touch.parameters((0.2, 0.0))["charge_pC"] > 0.0


def test_hum_has_a_phase_of_its_own_in_every_run():
    of = engine(run(), run(label="other"))
    one = candidate(of, "mains-hum", "readout")
    hum = voltage(of, Setting(one, (0.0, 0.0, 0.03, 0.04)), number=1) - voltage(of, number=1)
    phase = 2.0 * np.pi * 50.0 * TIME
    np.testing.assert_allclose(hum, 0.03 * np.sin(phase) + 0.04 * np.cos(phase), atol=1e-12)
    assert np.array_equal(voltage(of, Setting(one, (0.0, 0.0, 0.03, 0.04))), voltage(of))


def test_a_stated_resistor_leaves_the_capacitance_free():
    """It decays with R (C_film + C_in), of which nobody knows C_film."""
    resistor = Readout(input_resistance_MOhm=1e4, input_capacitance_pF=50.0)
    of = engine(run(STEP, readout=resistor))
    free = next(one for one in of.free_nuisances if one.mechanism == "film-capacitance")
    film_pF = of.scene.capacitance_pF - 50.0
    for value in (0.0, 2.0):
        tau = 1e-6 * 1e4 * (50.0 + film_pF * (1.0 + np.sinh(value)))
        decaying = voltage(of, Setting(free, (value,)))
        np.testing.assert_allclose(
            decaying[HELD] / decaying[int(np.argmax(STEP > 0.0))], np.exp(-SINCE[HELD] / tau), rtol=1e-9
        )
    assert not [one for one in engine().free_nuisances if one.mechanism == "film-capacitance"]


@for_each(
    ("changes", "expected"),
    [
        ({"drive": "displacement_mm"}, "needs drive = 'force_N'"),
        ({"channels": {"force_N": RAMPS, "voltage_V": RAMPS, "displacement_mm": RAMPS}}, "cannot explain column displ"),
        ({"channels": {"force_N": RAMPS}}, "has no column of voltage"),
    ],
)
def test_what_this_engine_cannot_take(changes, expected):
    with pytest.raises(InputError, match=expected):
        engine(Run(**{**run().__dict__, **changes}))

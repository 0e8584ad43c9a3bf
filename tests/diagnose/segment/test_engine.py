"""The tables of a rig against the 3D model itself: every kind of mechanism, coarse mesh, slice."""

import numpy as np
import pytest

from diagnose.engines.segment import response as answer
from diagnose.engines.segment.engine import segment_engine
from diagnose.engines.segment.kept_answers import Courses
from diagnose.forward import Setting
from diagnose.signals.recording import Recording
from foundation.errors import InputError
from solve.mechanisms import Mechanism
from solve.model import Readout
from solve.tables import cache as store
from tests.cases import for_each
from tests.diagnose.segment.rigs import COARSE, DEPTH_MM, candidate, engine, model, press, run, silent

KINKS = 0.01  # of the peak: so coarse a surface touches node by node, which neither table nor press resolves
FORCE = {"drive": "force_N"}


@pytest.fixture(scope="module")
def rig():
    """One run of one press, driven by its depth."""
    return engine()


def peak(signal):
    return float(np.abs(signal).max())


def switched(of, mechanism, component, values):
    """A prepared setting."""
    chosen = candidate(of, mechanism, component)
    of.prepare([chosen], silent)
    return Setting(chosen, values)


def errors(of, setting):
    """Channel -> error of the tables against the 3D model, and the size of the effect, both of the baseline's peak."""
    without, told = of.predict(0, []), of.predict(0, [setting])
    true = of.solve(0, [setting.candidate.as_mechanism(setting.values)], silent)
    sizes = {name: peak(without[name]) for name in told}
    return {name: (peak(told[name] - true[name]) / size, peak(true[name] - without[name]) / size)
            for name, size in sizes.items()}  # fmt: skip


@pytest.mark.press
def test_the_baseline_is_that_of_the_3d_model(rig):
    told, true = rig.predict(0, []), rig.solve(0, [], silent)
    for name in told:
        assert peak(told[name] - true[name]) < KINKS * peak(true[name])


@pytest.mark.press
def test_a_second_recording_of_a_rig_needs_no_press_for_another_noise_of_its_drive(monkeypatch):
    asked, recall = [], store.recall
    monkeypatch.setattr(store, "recall", lambda name: asked.append(name) or recall(name))
    for noise in (1e-4, -1e-4):
        of = engine(run(values=press(np.arange(0.0, 1.6, 0.002)) + noise))
        of.prepare([candidate(of, "adhesive-compliance", "bond-film-medium2")], silent)
    half = len(asked) // 2
    assert asked[:half] == asked[half:]


CASES = [
    # mechanism, component, coordinates, largest error as a share of the effect, least effect on the voltage
    ("charge-leakage", "readout", (1.0,), 0.02, 0.1),
    ("rig-compliance", "rig", (0.3,), 0.02, 0.1),
    ("property-error", "medium1", (0.3, 0.0), 0.05, 0.03),
    ("property-error", "film", (0.2, 0.1, 0.3), 0.05, 0.3),
    ("viscoelasticity", "medium2", (0.1, 0.1, 0.05, 0.05, 0.3), 0.1, 0.05),
    ("hyperelastic-stiffening", "effector", (0.3, 0.2), 0.08, 0.05),
    ("hyperelastic-stiffening", "effector", (1.0, 1.0), 0.08, 0.2),
    ("foam-densification", "medium2", (0.5, 1.0), 0.08, 0.1),
    ("adhesive-compliance", "bond-film-medium2", (1.2, 2.5), 0.08, 0.05),
    ("elastic-sides", "sides", (2.0,), 0.08, 0.1),
    ("stress-softening", "effector", (0.3, 0.0), 0.15, 0.1),
    ("stress-softening", "effector", (0.5, 0.6), 0.15, 0.1),
]


@pytest.mark.evidence
@for_each(("mechanism", "component", "values", "allowed", "least"), CASES)
def test_a_mechanism_acts_as_in_the_3d_model(rig, mechanism, component, values, allowed, least):
    found = errors(rig, switched(rig, mechanism, component, values))
    assert found["voltage_V"][1] > least
    for error, effect in found.values():
        assert error < allowed * effect + KINKS


@pytest.mark.evidence
def test_far_from_all_presses_a_refinement_brings_the_tables_to_the_3d_model(rig):
    """A foam is pressed at few exponents; where a fit leads, once more. The reference has elements a third as large."""
    fine = segment_engine(model(), COARSE.scale_sizes(0.35), Recording((run(),)), silent)
    foam = switched(rig, "foam-densification", "effector", (0.3, 2.0))

    def change(of, signals):
        plain = signals(of, [])
        changed = signals(of, [foam])
        return {name: (changed[name] - plain[name]) / peak(plain[name]) for name in plain}

    true = change(fine, lambda of, on: of.solve(0, [s.candidate.as_mechanism(s.values) for s in on], silent))
    before = change(rig, lambda of, on: of.predict(0, on))
    assert rig.refine([foam], silent) == [foam]
    after = change(rig, lambda of, on: of.predict(0, on))
    for name in true:
        assert peak(after[name] - true[name]) < 0.2 * peak(before[name] - true[name])
    assert not rig.refine([foam], silent)


@pytest.mark.press
def test_a_refinement_leaves_to_the_tables_what_acts_on_them(rig):
    """The piezoelectric constant scales every charge, and is in no press of a film of another modulus."""
    values = (0.3, 0.15)
    at = [switched(rig, "property-error", "film", (*values, d31)) for d31 in (0.0, 0.4)]
    rig.refine(at[1:], silent)
    without, scaled = (rig.predict(0, [setting])["voltage_V"] for setting in at)
    np.testing.assert_allclose(scaled, np.exp(0.4) * without, rtol=1e-9)


@pytest.mark.press
def test_a_compliant_rig_in_the_tables_is_one_in_the_3d_model(rig):
    """The same for one case that needs no press of its own: the fast suite too shall see the 3D model."""
    for error, effect in errors(rig, switched(rig, "rig-compliance", "rig", (0.3,))).values():
        assert effect > 0.1
        assert error < 0.02 * effect + KINKS


@pytest.mark.press
def test_all_off_is_the_baseline_exactly(rig):
    plain = rig.predict(0, [])
    for chosen in rig.candidates:
        off = rig.predict(0, [Setting(chosen, tuple(0.0 for _ in chosen.coordinates))])
        for name in plain:
            np.testing.assert_array_equal(off[name], plain[name])


@pytest.mark.press
def test_small_settings_add_up(rig):
    """To first order what two do together is the sum of what each does."""
    moduli = [rig.nuisance(f"modulus.{layer}") for layer in ("medium1", "medium2")]
    rig.prepare(moduli, silent)
    one, other = (Setting(modulus, (0.02,)) for modulus in moduli)
    plain = rig.predict(0, [])
    each = [rig.predict(0, [s]) for s in (one, other)]
    both = rig.predict(0, [one, other])
    for name in plain:
        alone = sum(part[name] - plain[name] for part in each)
        np.testing.assert_allclose(both[name] - plain[name], alone, atol=0.02 * peak(alone))


@pytest.mark.press
def test_a_nuisance_is_the_factor_of_the_candidate(rig):
    """The same presses serve both."""
    nuisance = rig.nuisance("modulus.medium1")
    rig.prepare([nuisance], silent)
    chosen = Setting(candidate(rig, "property-error", "medium1"), (0.2, 0.0))
    told, same = rig.predict(0, [Setting(nuisance, (0.2,))]), rig.predict(0, [chosen])
    for name in told:
        np.testing.assert_array_equal(told[name], same[name])


@pytest.mark.press
def test_d31_scales_the_voltage_and_leaves_the_force(rig):
    told, plain = rig.predict(0, [Setting(rig.nuisance("d31"), (np.log(1.1),))]), rig.predict(0, [])
    np.testing.assert_allclose(told["voltage_V"], 1.1 * plain["voltage_V"], rtol=1e-9)
    np.testing.assert_array_equal(told["force_N"], plain["force_N"])


@pytest.mark.press
def test_a_gap_is_a_later_touch(rig):
    """Lost motion of 0.02 mm is a press that is less deep by that much."""
    told = rig.predict(0, [Setting(candidate(rig, "contact-gap", "dot"), (0.02,))])
    shallower = rig.imagine(run(values=press(run().time_s) - 0.02), [])
    np.testing.assert_allclose(told["force_N"], shallower["force_N"], atol=1e-9)


@pytest.mark.press
def test_hum_has_the_amplitude_and_the_phase_that_its_coordinates_say(rig):
    """Sine and cosine from the first touch on, before the amplifier."""
    hum = candidate(rig, "mains-hum", "readout")
    time = rig.drives[0].time_s
    added = rig.predict(0, [Setting(hum, (0.03, 0.04))])["voltage_V"] - rig.predict(0, [])["voltage_V"]
    wave = 2.0 * np.pi * 50.0 * time
    np.testing.assert_allclose(added, 0.03 * np.sin(wave) + 0.04 * np.cos(wave), atol=1e-9)
    assert hum.parameters((0.03, 0.04))["amplitude_V"] == pytest.approx(0.05)


@pytest.mark.press
def test_what_stands_behind_the_film_leaves_the_course_of_the_dot(rig, monkeypatch):
    """Leaks of three sizes beside a softer medium: the dot is followed once."""
    softer = switched(rig, "property-error", "medium1", (-0.1, 0.0))
    leak = candidate(rig, "charge-leakage", "readout")
    followed = []
    monkeypatch.setattr(answer, "follow", lambda *given, follow=answer.follow: followed.append(1) or follow(*given))
    rig.prepare([leak], silent)
    most = leak.coordinates[0].high
    told = [rig.predict(0, [softer, Setting(leak, (share * most,))]) for share in (0.1, 0.2, 0.3)]
    assert len(followed) == 1
    np.testing.assert_array_equal(told[0]["force_N"], told[2]["force_N"])
    assert peak(told[0]["voltage_V"] - told[2]["voltage_V"]) > 0.01 * peak(told[0]["voltage_V"])


@pytest.mark.press
def test_what_was_not_prepared_is_refused(rig):
    chosen = candidate(rig, "delamination", "bond-base")
    with pytest.raises(ValueError, match="delamination of bond-base was not prepared"):
        rig.predict(0, [Setting(chosen, (0.1, 0.0))])
    with pytest.raises(ValueError, match="deeper than"):
        rig.imagine(run(values=press(run().time_s, 2.0 * DEPTH_MM)), [])
    with pytest.raises(ValueError, match="a dot at"):
        rig.imagine(run(dot_offset_mm=(0.2, 0.0)), [])


@pytest.mark.press
def test_another_resistor_is_that_of_its_run():
    both = engine(run(), run(label="two", readout=Readout(input_resistance_MOhm=100.0, input_capacitance_pF=100.0)))
    slow, fast = (both.predict(number, [])["voltage_V"] for number in (0, 1))
    held = (both.drives[0].time_s > 0.55) & (both.drives[0].time_s < 0.58)
    assert (fast[held] < 0.1 * slow[held]).all()


@pytest.mark.evidence
def test_a_force_drives_as_far_as_the_depth_says(rig):
    """Pushed by the force of a depth-driven press, the dot goes as deep as that press."""
    depth = press(run().time_s)
    force = rig.predict(0, [])["force_N"]
    pushed = engine(run(values=force, **FORCE))
    touching = depth > 0.02
    path = pushed.predict(0, [])["displacement_mm"]
    np.testing.assert_allclose(path[touching], depth[touching], atol=2 * KINKS * DEPTH_MM)


@pytest.mark.evidence
def test_a_softer_bond_lets_a_force_go_deeper_as_in_the_3d_model(rig):
    pushed = engine(run(values=0.6 * rig.predict(0, [])["force_N"], **FORCE))
    setting = switched(pushed, "adhesive-compliance", "bond-medium1-film", (1.5, 1.5))
    error, effect = errors(pushed, setting)["displacement_mm"]
    assert effect > 0.02
    assert error < 0.1 * effect + 2 * KINKS


@pytest.mark.press
def test_a_mechanism_that_is_as_good_as_off_changes_nothing(rig):
    """A fit may lead to values that no press has any weight at, also of what depends on the path."""
    without = rig.predict(0, [])
    for setting in (
        switched(rig, "stress-softening", "effector", (1e-15, 0.0)),
        switched(rig, "friction", "dot", (1e-15,)),
    ):
        told = rig.predict(0, [setting])
        for name in told:
            np.testing.assert_allclose(told[name], without[name], rtol=0.0, atol=1e-9 * peak(without[name]))


@pytest.mark.evidence
def test_softened_rubber_loses_on_the_way_back_and_the_second_time():
    """Twice to one depth: the second way down follows the first way up, and both are below the first way down."""
    time = run().time_s
    quick = {"rise_s": 0.2, "hold_s": 0.1}
    twice = np.maximum(press(time, touch_s=0.1, **quick), press(time, touch_s=0.9, **quick))
    of = engine(run(values=twice))
    setting = switched(of, "stress-softening", "effector", (0.3, 0.0))
    told, true = of.predict(0, [setting]), of.solve(0, [setting.candidate.as_mechanism(setting.values)], silent)
    assert peak(told["force_N"] - true["force_N"]) < 0.03 * peak(true["force_N"])
    first, second = (np.argmin(np.abs(time - t)) for t in (0.2, 1.0))
    assert twice[first] == pytest.approx(twice[second])
    lost = 1.0 - told["force_N"][second] / told["force_N"][first]
    assert lost == pytest.approx(setting.candidate.derived(setting.values)["loss_ratio"], abs=0.02)


@pytest.mark.evidence
def test_force_ratio_is_what_the_3d_model_gains_at_the_deepest_press(rig):
    setting = switched(rig, "hyperelastic-stiffening", "effector", (0.3, 0.2))
    true = rig.solve(0, [setting.candidate.as_mechanism(setting.values)], silent)
    plain = rig.solve(0, [], silent)
    gained = peak(true["force_N"]) / peak(plain["force_N"])
    assert setting.candidate.derived(setting.values)["force_ratio"] == pytest.approx(gained, rel=0.01)


RELAXES = {
    "name": "viscoelasticity",
    "component": "medium2",
    "parameters": {"relative_moduli": [0.3], "relaxation_times_s": [0.1]},
}
STRETCHED = {"name": "film-prestretch", "component": "film", "parameters": {"strain_x": 0.002, "strain_y": 0.002}}


@pytest.mark.press
@for_each(
    ("tables", "reason"),
    [
        ({"mechanisms": [RELAXES, STRETCHED]}, "viscoelasticity or film-prestretch, but not both"),
        ({"materials": {"pvdf": {"model": "piezoelectric-film", "coupling": "two-way"}}}, "two-way"),
    ],
)
def test_a_baseline_that_tables_cannot_describe_is_refused(tables, reason):
    with pytest.raises(InputError, match=reason):
        engine(**tables)


@pytest.mark.press
def test_a_run_deeper_than_the_stack_is_refused():
    with pytest.raises(InputError, match="run 'one' goes too deep"):
        engine(run(values=press(run().time_s, 4.0)))


@pytest.mark.press
def test_the_3d_model_refuses_what_the_rig_does_not_have(rig):
    with pytest.raises(ValueError, match="component"):
        rig.solve(0, [Mechanism(name="property-error", component="sides")], silent)


def touched(rig, monkeypatch, area):
    """What a touch that leaves charge gives where a table tells this contact area."""

    def followed(*given):
        path, outputs = given[-2:]
        path[:], outputs[:] = 0.1, 1e-9
        outputs[::2, 1] = area
        return 0

    monkeypatch.setattr(answer, "follow", followed)
    monkeypatch.setattr(rig, "_courses", Courses(1))  # nothing is kept of other tests, nor for them
    touch = candidate(rig, "contact-electrification", "film")
    rig.prepare([touch], silent)
    return rig.predict(0, [Setting(touch, (1.0, touch.coordinates[1].starts[0]))])


@pytest.mark.press
def test_an_area_just_below_none_between_the_presses_of_a_table_is_none(rig, monkeypatch):
    below, none = (touched(rig, monkeypatch, area)["voltage_V"] for area in (-1e-20, 0.0))
    np.testing.assert_array_equal(below, none)
    assert np.abs(below).max() > 0.0


@pytest.mark.press
def test_a_trial_whose_signals_are_beyond_all_numbers_is_rejected(rig, monkeypatch):
    with pytest.raises(ValueError, match="beyond all numbers"):
        touched(rig, monkeypatch, np.nan)

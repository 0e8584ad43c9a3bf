"""A coupon's candidates: off is the baseline, every start is a material, and parameters mean what they say."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import least_squares, nnls

from diagnose.engines.coupon.engine import coupon_engine
from diagnose.engines.coupon.improved_material import improved_material
from diagnose.engines.coupon.relaxation_spectrum import relaxation_times
from diagnose.fit.nuisances import declared_nuisances
from diagnose.forward import Setting
from diagnose.signals.recording import Recording
from diagnose.signals.time_scales import time_scales
from diagnose.vocabulary.layers.viscoelasticity import LINEAR
from foundation.errors import InputError
from softdot.config.loading import config_from
from solve.materials.parameters import Hyperfoam, Linear, MooneyRivlin, NeoHookean, Ogden, PiezoelectricFilm, Yeoh
from tests.cases import for_each
from tests.diagnose.coupon.coupons import RUBBER, TIME, TRAVEL, candidate, engine, run, silent, specimen

MATERIALS = [
    RUBBER,
    Linear(youngs_modulus_MPa=1.2, poisson_ratio=0.49),
    NeoHookean(youngs_modulus_MPa=0.1, poisson_ratio=0.3),
    MooneyRivlin(c10_MPa=0.15, c01_MPa=0.05),
    Yeoh(c10_MPa=0.2, c20_MPa=0.01),
    Ogden(mu_MPa=(0.5,), alpha=(1.6,)),
    Hyperfoam(mu_MPa=(0.03,), alpha=(8.0,), poisson_ratio=(0.1,)),
]
KINDS = ["tension", "compression", "shear"]


def force(of, *settings):
    """Of run 0."""
    return of.predict(0, settings)["force_N"]


def test_a_grip_adds_its_mass_times_the_acceleration_of_the_crosshead():
    """A crosshead that is set going at a m/s2: m a while it gathers speed, nothing at constant speed."""
    gathers, mass_g, acceleration_mm_per_s2 = 2.0, 700.0, 3.0
    early, speed = gathers > TIME, gathers * acceleration_mm_per_s2
    travel = np.where(early, 0.5 * acceleration_mm_per_s2 * TIME**2, speed * (TIME - 0.5 * gathers))
    of = coupon_engine(Recording((run(travel),), specimen()), {"mine": RUBBER}, silent)
    grip = candidate(of, "inertia")
    value = np.arcsinh(mass_g / 50.0)
    assert grip.parameters((value,)) == {"moving_mass_g": pytest.approx(mass_g)}
    added = force(of, Setting(grip, (value,))) - force(of)
    np.testing.assert_allclose(added[early][1:-1], 1e-6 * mass_g * acceleration_mm_per_s2, rtol=1e-6)
    np.testing.assert_allclose(added[gathers + 0.1 < TIME][:-1], 0.0, atol=1e-9)


def test_a_seal_rubs_with_the_same_force_at_any_speed():
    """A tenth of the largest force that was recorded, from a tenth of the travel on, of a slow and of a quick run."""
    of, values = engine("shear"), (0.0, 0.0, 0.0, 0.0, 0.1, 0.0)
    slider = candidate(of, "guide-friction").parameters(values)
    assert slider == {"friction_force_N": [pytest.approx(0.4)], "presliding_mm": [pytest.approx(0.8)]}
    rubbing = Setting(candidate(of, "guide-friction"), values)
    slow = replace(of.recording.runs[0], time_s=100.0 * TIME)
    for one in (of.recording.runs[0], slow):
        added = of.imagine(one, (rubbing,))["force_N"] - of.imagine(one, ())["force_N"]
        np.testing.assert_allclose(added[(TRAVEL >= 0.8) & (TIME <= 8.0)], 0.4, rtol=1e-9)
        np.testing.assert_allclose(added[(TRAVEL <= 6.4) & (TIME > 8.0) & (TIME <= 12.0)], -0.4, rtol=1e-9)
    assert not [one for one in engine(drive="force_N").candidates if one.mechanism == "guide-friction"]


def test_a_strip_that_is_pushed_bends_aside_at_eulers_load():
    """Half of its travel back beyond rest: a block would push with the whole force, a strip of 2 mm with 4 % of it."""
    travel = np.interp(TIME, [0.0, 5.0, 15.0, 20.0], [0.0, 4.0, -4.0, 0.0])
    pushed = coupon_engine(Recording((run(travel),), specimen()), {"mine": RUBBER}, silent)
    load_N = 4.0 * np.pi**2 * 1.2 * (5.0 * 2.0**3 / 12.0) / 20.0**2
    assert force(pushed).min() == pytest.approx(-load_N, rel=1e-6)
    assert force(pushed).max() > 4.0 * load_N
    thinner = specimen().model_copy(update={"thickness_mm": 0.2})
    slack = coupon_engine(Recording((run(travel),), thinner), {"mine": RUBBER}, silent)
    assert -force(slack).min() < 2e-3 * force(slack).max()


def test_a_staircase_is_as_quick_as_its_steps():
    """Ten steps of 0.5 s with rests of 60 s between them, and one loading of 5 s: the same quickest time."""
    stairs = np.linspace(0.0, 620.0, 12401)
    corners = np.concatenate([[n * 60.0 + 10.0, n * 60.0 + 10.5] for n in range(10)])
    heights = np.repeat(np.arange(11) * 0.8, 2)[1:-1]
    once = np.linspace(0.0, 620.0, 12401)
    made = []
    for time, travel in ((stairs, np.interp(stairs, corners, heights)), (once, np.interp(once, [10.0, 15.0], [0, 8]))):
        one = run()
        channels = {"displacement_mm": travel, "force_N": 0.5 * travel}
        there = {name: np.ones(len(time), dtype=bool) for name in channels}
        made.append(
            replace(one, time_s=time, channels=channels, valid=there, saturated={n: ~f for n, f in there.items()})
        )
    shortest = [relaxation_times(time_scales(Recording((one,), specimen())))[0] for one in made]
    assert shortest[0] == pytest.approx(shortest[1], rel=0.3)


def test_branches_at_fixed_times_meet_a_material_with_any_one_time():
    """Within 2 % of what relaxes in a hold, root mean square, as a sum of moduli that are not negative."""
    time = np.linspace(0.0, 60.0, 1201)
    pulled = np.interp(time, [0.0, 1.0, 60.0], [0.0, 8.0, 8.0])
    there = {name: np.ones(len(time), dtype=bool) for name in ("displacement_mm", "force_N")}
    channels = {"displacement_mm": pulled, "force_N": 0.5 * pulled}
    none = {name: ~flags for name, flags in there.items()}
    one = replace(run(), time_s=time, channels=channels, valid=there, saturated=none)
    times = relaxation_times(time_scales(Recording((one,), specimen())))
    faded = np.exp(-time[:, None] / np.array([np.inf, *times]))
    for tau in np.geomspace(times[0], times[-1], 25):
        missed = nnls(faded, np.exp(-time / tau))[1] / np.sqrt(len(time))
        assert missed < 0.021, (tau, times)


def test_a_grip_of_a_test_by_force_is_not_sought():
    assert not [one for one in engine(drive="force_N").candidates if one.mechanism == "inertia"]


@pytest.mark.press
@for_each("kind", KINDS)
@for_each("material", MATERIALS)
def test_every_candidate_is_off_at_zero_and_answers_within_its_bounds(kind, material):
    of = engine(kind, material)
    for one in of.candidates:
        assert np.array_equal(force(of, Setting(one, (0.0,) * len(one.coordinates))), force(of))
        for number, coordinate in enumerate(one.coordinates):
            at = np.zeros(len(one.coordinates))
            at[0] = 0.5 if coordinate is LINEAR else 0.0  # the share of branches that there are
            without = force(of, Setting(one, tuple(at)))
            for value in coordinate.starts:
                at[number] = value
                changed = force(of, Setting(one, tuple(at)))
                assert np.isfinite(changed).all(), (one.name, coordinate.name, value)
                assert not np.allclose(changed, without, rtol=1e-4), (one.name, coordinate.name, value)
                assert one.derived(tuple(at)).keys() | one.parameters(tuple(at)).keys() <= one.units.keys()


@pytest.mark.press
@for_each("material", MATERIALS)
def test_the_answer_leaves_the_baseline_smoothly(material):
    """Twice a small value does twice as much; laws of another family (linear, foam) start with a jump of their own."""
    of, other = engine("tension", material), isinstance(material, Linear)
    baseline = force(of)
    for one in of.candidates:
        if (other and one.mechanism == "hyperelastic-stiffening") or (
            one.mechanism == "foam-densification" and not isinstance(material, Hyperfoam)
        ):
            continue
        for number in range(len(one.coordinates)):
            once, twice = (
                force(of, Setting(one, tuple(value * np.eye(len(one.coordinates))[number]))) - baseline
                for value in (1e-4, 2e-4)
            )
            np.testing.assert_allclose(twice, 2.0 * once, atol=2e-3 * np.abs(twice).max() + 1e-9)


@pytest.mark.press
@for_each("kind", KINDS)
def test_driven_by_its_force_a_coupon_answers_with_travel(kind):
    of = engine(kind, drive="force_N")
    for one in of.candidates:
        for coordinate in one.coordinates:
            at = tuple(coordinate.starts[0] * float(c is coordinate) for c in one.coordinates)
            assert np.isfinite(of.predict(0, [Setting(one, at)])["displacement_mm"]).all()


def test_modulus_thickness_and_zero_are_nuisances():
    of = engine()
    baseline = force(of)
    modulus, thickness = (of.nuisance(f"{name}.specimen") for name in ("modulus", "thickness"))
    np.testing.assert_allclose(force(of, Setting(modulus, (0.1,))), 1.1 * baseline, rtol=1e-9)
    both = force(of, Setting(thickness, (0.1,)), Setting(modulus, (0.1,)))
    np.testing.assert_allclose(both, 1.21 * baseline, rtol=1e-9)
    shifted = force(of, Setting(of.nuisance("offset_mm"), (1.0,)))
    there = coupon_engine(Recording((run(TRAVEL - 1.0),), specimen()), {"mine": RUBBER}, silent)
    np.testing.assert_allclose(shifted, force(there), rtol=1e-9)
    assert of.nuisance("d31") is None


@for_each("kind", KINDS)
@for_each("material", [RUBBER, MATERIALS[3], MATERIALS[4], MATERIALS[5]])
def test_force_ratio_is_the_force_with_over_without_at_the_largest_strain(kind, material):
    of = engine(kind, material)
    one = candidate(of, "hyperelastic-stiffening")
    values = (0.8, 0.3, -0.1)[: len(one.coordinates)]
    deepest = int(np.argmax(TRAVEL))
    ratio = force(of, Setting(one, values))[deepest] / force(of)[deepest]
    assert ratio == pytest.approx(one.derived(values)["force_ratio"], rel=1e-6)
    early = int(np.argmax(TRAVEL > 0.0))
    assert force(of, Setting(one, values))[early] == pytest.approx(force(of)[early], rel=0.06)


@for_each("law", [np.arcsinh, lambda shear: np.sinh(0.5 * np.arcsinh(0.5 * shear)) / np.hypot(1.0, 0.5 * shear)])
def test_a_layer_gives_way_at_large_shear_by_laws_that_are_not_the_family(law):
    """The second is Ogden's of the exponent 1/2. To a shear of ten the family is within 1 % of either."""
    shear = np.linspace(0.0, 10.0, len(TIME))
    of = coupon_engine(Recording((run(20.0 * shear),), specimen("shear")), {"mine": RUBBER}, silent)
    one = candidate(of, "hyperelastic-stiffening")

    def shape(values):
        found = force(of, Setting(one, tuple(values)))
        return found / np.linalg.norm(found) - law(shear) / np.linalg.norm(law(shear))

    fit = least_squares(shape, (-0.5, 0.0, -0.5))
    assert np.linalg.norm(fit.fun) < 0.01
    assert one.derived(tuple(fit.x))["force_ratio"] < 0.5


def test_relaxed_fraction_is_what_a_coupon_held_at_small_strain_loses_between_a_tenth_and_ten_seconds():
    of = engine("shear")
    one = candidate(of, "viscoelasticity")
    values = tuple(0.3 + 0.1 * n for n in range(len(one.coordinates)))
    time = np.array([0.0, 0.1, 10.0])
    step = run(np.full(len(TIME), 8e-5))
    step = type(step)(**{**step.__dict__, "time_s": np.concatenate([time, 20.0 + np.arange(len(TIME) - 3)])})
    held = coupon_engine(Recording((step,), specimen("shear")), {"mine": RUBBER}, silent)
    found = held.predict(0, [Setting(one, values)])["force_N"]
    assert 1.0 - found[2] / found[1] == pytest.approx(one.derived(values)["relaxed_fraction"], rel=1e-9)


def test_solve_with_the_mechanism_is_predict_with_its_setting():
    of = engine()
    for one in of.candidates:
        setting = Setting(one, tuple(coordinate.starts[0] for coordinate in one.coordinates))
        solved = of.solve(0, [one.as_mechanism(setting.values)], silent)["force_N"]
        assert np.array_equal(solved, force(of, setting))


@for_each("kind", KINDS)
def test_an_answer_from_the_last_one_is_the_same(kind):
    of = engine(kind)
    quick = replace(of, last={})
    for one in of.candidates:
        for start in range(len(one.coordinates[0].starts)):
            values = tuple(each.starts[min(start, len(each.starts) - 1)] for each in one.coordinates)
            setting = Setting(one, values)
            np.testing.assert_allclose(force(quick, setting), force(of, setting), rtol=1e-7, atol=1e-8)
    assert len(quick.last["run", len(TIME)]) == len(TIME)


@for_each("kind", KINDS)
def test_a_number_that_is_told_is_the_same_quantity_at_all_values(kind):
    """Where one coordinate is off the others have the names that they have where it is next to nothing."""
    for one in engine(kind, MATERIALS[2]).candidates:
        on = np.array([0.5 * min(coordinate.starts, key=abs) for coordinate in one.coordinates])
        for n in range(len(on)):
            off, nothing = (numbers_told(one, np.where(np.arange(len(on)) == n, value, on)) for value in (0.0, 1e-9))
            for name in off.keys() & nothing.keys():
                assert off[name] == pytest.approx(nothing[name], rel=1e-6, abs=1e-6), (one.name, name)


def numbers_told(one, values):
    """By name, a list taken apart."""
    return {
        (name, n): number
        for name, each in (one.told or one.parameters)(values).items()
        for n, number in enumerate(np.ravel(each))
    }


def test_the_improved_material_is_one_that_a_segment_can_be_made_of():
    of = engine()
    settings = [
        Setting(candidate(of, "hyperelastic-stiffening"), (0.5, 0.1, 0.0)),
        Setting(candidate(of, "viscoelasticity"), (0.2,) * len(candidate(of, "viscoelasticity").coordinates)),
        Setting(of.nuisance("modulus.specimen"), (0.25,)),
        Setting(of.nuisance("offset_mm"), (0.25,)),
    ]
    better = improved_material(of, settings, "medium2")
    config = config_from({
        "segment": {"medium1": {"thickness_mm": 0.5}, "film": {"thickness_um": 28.0},
                    "medium2": {"thickness_mm": 2.0, "material": better.name}},
        "materials": {better.name: better.table},
        "mechanisms": list(better.mechanisms),
        "press": {"waveform": {"shape": "trapezoid"}},
    })  # fmt: skip
    law = config.materials["mine"]
    assert isinstance(law, Ogden)
    shares = 0.5 * np.multiply(law.mu_MPa, law.alpha)
    assert shares.sum() == pytest.approx(1.25 * 1.2 / (2.0 * 1.499))
    told = settings[0].candidate.told(settings[0].values)
    np.testing.assert_allclose(told["share_of_modulus"], shares / shares.sum())
    assert [one.component for one in config.mechanisms] == ["medium2"]


def test_what_is_no_coupon_test():
    film = PiezoelectricFilm()
    with pytest.raises(InputError, match="a film cannot be a coupon"):
        coupon_engine(Recording((run(),), specimen()), {"mine": film}, silent)
    with pytest.raises(InputError, match="reaches 25 mm, but the specimen is 20 mm thick"):
        coupon_engine(Recording((run(TRAVEL * 25.0 / 8.0),), specimen("compression")), {"mine": RUBBER}, silent)
    lone = run()
    lone = type(lone)(**{**lone.__dict__, "channels": {"displacement_mm": TRAVEL, "voltage_V": TRAVEL}})
    with pytest.raises(InputError, match="column force_N is missing"):
        coupon_engine(Recording((lone,), specimen()), {"mine": RUBBER}, silent)


def test_a_modulus_is_another_one_at_another_temperature_only():
    """Runs at one temperature share it."""

    def owners(*temperatures):
        runs = tuple(
            replace(run(), label=f"run {n}", temperature_C=at, nuisance={"modulus.specimen": 1.0})
            for n, at in enumerate(temperatures)
        )
        recording = Recording(runs, specimen("tension"))
        return [one.run for one in declared_nuisances(recording, coupon_engine(recording, {"mine": RUBBER}, silent))]

    assert owners(20.0, 20.0, None) == [None]
    assert owners(20.0, 50.0) == [0, 1]

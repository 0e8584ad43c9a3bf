"""The generator's own finite elements against closed forms and against the solver that they are to test."""

from dataclasses import replace

import numpy as np
import pytest

from softdot.studies.proof.world import laws
from softdot.studies.proof.world.effects import apply_effects
from softdot.studies.proof.world.laws import elastic_strain, shear_modulus
from softdot.studies.proof.world.made import Damage, Film, Layer, Made, Spectrum
from softdot.studies.proof.world.march import table, through_time
from softdot.studies.proof.world.memory_laws import at_rest, branches, relaxation, respond
from softdot.studies.proof.world.plastic import Flow, flow_step
from softdot.studies.proof.world.reality import baseline
from softdot.studies.proof.world.remembering_presses import AskedPath, scaled_memory, with_strength
from softdot.studies.proof.world.rigs import FREE
from softdot.studies.proof.world.runs import Run
from softdot.studies.proof.world.stack import Stack
from tests.cases import for_each

PAPER = Made(
    (
        Layer("medium2", 2.0, 1.0), Film(held=True), Layer("medium1", 0.5, 5.0, held=True),
        Layer("effector", 1.0, 1.0, held=True),
    ),
    2.5, 16.0, "ridge", 0.8125,
)  # fmt: skip


def pressed(made, depth_mm, steps=4):
    stack = Stack(made)
    state = stack.rest()
    for depth in depth_mm * np.arange(1, steps + 1) / steps:
        state = stack.press(state, depth, 0.0)
    return stack.answer(state)


def stretched(along, across=None):
    """F (1, 3, 3) of an incompressible bar, or of any stretch across."""
    across = along**-0.5 if across is None else across
    return np.diag([along, across, across])[None]


@for_each("layer", [Layer("a", 1.0, 3.0), Layer("a", 1.0, 3.0, gent_limit=2.0)])
def test_a_tangent_is_the_derivative_of_the_stress_and_this_of_the_energy(layer):
    rng = np.random.default_rng(3)
    f, way, h = np.eye(3)[None] + 0.2 * rng.standard_normal((1, 3, 3)), rng.standard_normal((1, 3, 3)), 1e-6
    _, p, tangent = laws.isochoric(layer, f)
    (up, p_up, _), (down, p_down, _) = laws.isochoric(layer, f + h * way), laws.isochoric(layer, f - h * way)
    np.testing.assert_allclose((up - down) / (2 * h), np.einsum("nij,nij->n", p, way), rtol=1e-6)
    np.testing.assert_allclose((p_up - p_down) / (2 * h), np.einsum("nijkl,nkl->nij", tangent, way), rtol=1e-6)


def test_uniaxial_neo_hookean_stress_is_that_of_the_textbook():
    # nominal stress mu (L - 1/L^2) of an incompressible bar: the pressure takes the stress across away
    layer = Layer("a", 1.0, 3.0, 0.5 - 1e-9)
    _, p, _ = laws.isochoric(layer, stretched(1.5))
    pressure = p[0, 1, 1] * stretched(1.5)[0, 1, 1]
    assert p[0, 0, 0] - pressure / 1.5 == pytest.approx(1.0 * (1.5 - 1.5**-2), rel=1e-6)


def test_gent_tends_to_neo_hookean_far_from_its_limit_and_stiffens_near_it():
    plain, far, near = (Layer("a", 1.0, 3.0, gent_limit=limit) for limit in (None, 1e7, 1.5))
    soft, same, stiff = (laws.isochoric(layer, stretched(1.5))[1][0, 0, 0] for layer in (plain, far, near))
    assert same == pytest.approx(soft, rel=1e-6)
    # W' = mu / 2 / (1 - (I1 - 3) / Jm)
    assert stiff / soft == pytest.approx(1.0 / (1.0 - (1.5**2 + 2 / 1.5 - 3.0) / 1.5))


def test_the_spectrum_is_that_of_a_fractional_zener_solid():
    # of order one half E(-x^(1/2)) = exp(x) erfc(x^(1/2)); x = t / tau
    from scipy.special import erfcx

    time = np.array([0.05, 0.4, 3.0])
    exact = 1.0 - 0.3 * (1.0 - erfcx(np.sqrt(time / 0.4)))
    np.testing.assert_allclose(relaxation(Spectrum(0.3, 0.4, 0.5), time), exact, atol=0.012)
    assert branches(Spectrum(0.3, 0.4))[0].sum() == pytest.approx(0.3)


def test_a_held_stretch_relaxes_along_the_spectrum():
    layer = Layer("a", 1.0, 3.0, spectrum=Spectrum(0.3, 0.4))
    times = np.geomspace(1e-3, 5.0, 120)
    p0, memory, found = laws.isochoric(layer, stretched(1.2))[1], at_rest(layer, 1), []
    _, _, memory = respond(layer, stretched(1.2), memory, 1e-9)
    for step in np.diff(times, prepend=0.0):
        p, _, memory = respond(layer, stretched(1.2), memory, step)
        found.append(p[0, 0, 0] / p0[0, 0, 0])
    np.testing.assert_allclose(found, relaxation(layer.spectrum, times), atol=5e-3)


def test_damage_softens_below_the_largest_strain_and_not_on_the_first_loading():
    layer, rest = Layer("a", 1.0, 3.0, damage=Damage(0.3, 1e-3)), None
    first = {}
    memory = at_rest(layer, 1)
    for stretch in (1.1, 1.2, 1.3):
        p, _, memory = respond(layer, stretched(stretch), memory, 0.0)
        first[stretch] = p[0, 0, 0]
        rest = laws.isochoric(layer, stretched(stretch))[1][0, 0, 0]
        assert p[0, 0, 0] == pytest.approx(rest)
    again = respond(layer, stretched(1.1), memory, 0.0)[0][0, 0, 0]
    assert again / first[1.1] == pytest.approx(0.7, abs=1e-3)  # far below the largest energy all of the loss


@pytest.mark.evidence
def test_a_finer_grid_changes_force_and_charge_by_less_than_a_fifth_of_a_percent():
    coarse, fine = pressed(PAPER, 0.2), pressed(replace(PAPER, fine=1.6), 0.2)
    assert coarse.force_N == pytest.approx(fine.force_N, rel=2e-3)
    assert coarse.charge_pC == pytest.approx(fine.charge_pC, rel=2e-3)


def test_a_memory_of_no_strength_gives_the_elastic_press_through_time():
    time = np.linspace(0.0, 1.0, 5)
    depth = 0.05 * np.sin(np.pi * time).clip(0.0)
    layers, small = list(PAPER.layers), replace(PAPER, fine=0.25)
    layers[0] = replace(layers[0], spectrum=Spectrum(1e-9, 0.4))
    relaxed = through_time(replace(small, layers=tuple(layers)), time, depth, 0.0)[1]
    elastic = through_time(with_strength(replace(small, layers=tuple(layers)), 0.0), time, depth, 0.0)[1]
    np.testing.assert_allclose(relaxed.force_N, elastic.force_N, atol=1e-6 * elastic.force_N.max())


@pytest.mark.press
def test_a_medium_that_relaxes_answers_no_earlier_than_the_dot_moves(tmp_path, monkeypatch):
    monkeypatch.setenv("SOFTDOT_PROOF_CACHE", str(tmp_path))
    press = Run("one", 0.1, 0.1, 0.4, count=1, lead_s=1.0, pause_s=0.1)
    time = press.times(250.0)
    path = press.depth(time)
    small = replace(PAPER, fine=0.3)
    made = replace(small, layers=(replace(small.layers[0], spectrum=Spectrum(0.2, 0.4)), *small.layers[1:]))
    elastic = table(small, 0.11).at(path)
    force = scaled_memory(made, AskedPath(time, path), elastic, elastic, 0.11).force_N
    peak = force.max()
    assert np.abs(force[path <= 0.0]).max() < 1e-3 * peak
    held = (time > 1.11) & (time < 1.5)
    np.testing.assert_array_less(np.diff(force[held]), 1e-4 * peak)  # it only falls, and not by the coming way back
    assert force[held][-1] > 0.8 * force[held][0]


@pytest.mark.press
def test_a_damaged_medium_remembers_the_deeper_press_of_an_earlier_run(tmp_path, monkeypatch):
    monkeypatch.setenv("SOFTDOT_PROOF_CACHE", str(tmp_path))
    small = replace(PAPER, fine=0.2)
    made = replace(small, layers=(replace(small.layers[0], damage=Damage(0.3, 1e-4)), *small.layers[1:]))
    time = np.linspace(0.0, 2.0, 41)
    path = np.interp(time, [0.0, 0.5, 1.0, 1.4, 2.0], [0.0, 0.1, 0.0, 0.05, 0.0])
    marks, whole = through_time(made, time, path, 0.0)
    second = time >= 1.0
    after, parted = through_time(made, time[second], path[second], 0.1)
    told = np.interp(time[second], time[second][after], parted.force_N)
    expected = np.interp(time[second], time[marks], whole.force_N)
    virgin = through_time(made, time[second], path[second], 0.0)[1].force_N
    np.testing.assert_allclose(told, expected, atol=0.01 * expected.max())
    assert virgin.max() > 1.02 * expected.max()


@pytest.mark.evidence
def test_both_codes_press_the_same_slice_alike():
    """On a layered mesh: those of pytetwild differ by a tenth of a percent of the force from run to run."""
    from softdot.config.loading import config_from
    from softdot.outcome import outcome

    found = outcome(config_from({
        "segment": {
            "width_mm": 16.0, "section": "plane-strain", "effector": {"height_mm": 1.0},
            "medium1": {"thickness_mm": 0.5}, "film": {"thickness_um": 28.0},
            "medium2": {"thickness_mm": 2.0, "material": "vnr-soft"},
        },
        "dot": {"shape": "ridge", "radius_mm": 0.8125},
        "press": {"indentation_mm": 0.3, "load_steps": 4},
        "mesh": {"mesher": "layered", "element_size_mm": 0.08, "contact_element_size_mm": 0.04},
    }))  # fmt: skip
    other = pressed(PAPER, 0.3)
    assert other.force_N == pytest.approx(found["reaction_force_N"][-1], rel=2e-3)
    assert other.charge_pC == pytest.approx(found["film_charge_pC"][-1], rel=2e-3)


@pytest.mark.press
@for_each("name", ["glue-above", "glue-below"])
def test_glue_of_no_strength_is_none_and_soft_glue_leaves_the_film_as_it_is(name):
    """A hidden glue once thinned the film, and stiffened it where it was weak: the truth then had another name."""
    coarse = replace(FREE, made=replace(FREE.made, fine=0.5))
    plain, weak, soft = (apply_effects(baseline(coarse), coarse, {name: s}).made for s in (0.0, 1e-9, 50.0))
    depth_mm = 0.5 * FREE.deepest_mm
    before, after, much = (pressed(made, depth_mm, 2) for made in (plain, weak, soft))
    assert after.force_N == pytest.approx(before.force_N, rel=3e-3)  # the grid has one more row of elements
    assert after.charge_pC == pytest.approx(before.charge_pC, rel=3e-3)
    assert much.force_N < 0.999 * before.force_N
    assert soft.height_mm == pytest.approx(plain.height_mm)
    assert soft.film == plain.film


def test_a_film_that_yields_stays_on_its_yield_surface_and_keeps_its_plastic_strain():
    film, rate = Film(poisson_ratio=0.5 - 1e-9, yield_MPa=40.0, hardening_MPa=60.0), np.diag([1.0, -0.5, -0.5])
    f = (np.eye(3) + 0.05 * rate)[None]
    _, _, flow = flow_step(film, f, Flow.none(1))
    strain = elastic_strain(film, f, flow.strain)
    deviator = 2.0 * shear_modulus(film) * (strain - np.trace(strain[0]) / 3.0 * np.eye(3))[0]
    size = np.sqrt(1.5 * (deviator**2).sum())
    assert size == pytest.approx(40.0 + 60.0 * flow.total[0], rel=1e-9)
    # in simple tension the stress of von Mises is E E_T / (E + E_T) beyond the yield strain
    along = 2.0 / 3.0 * (0.5 * ((1.05**2 - 1.0) - (0.975**2 - 1.0)))
    assert flow.total[0] == pytest.approx((2000.0 * along - 40.0) / 2060.0, rel=1e-6)
    back = flow_step(film, np.eye(3)[None] + 0.03 * rate, flow)[2]
    np.testing.assert_array_equal(back.strain, flow.strain)  # a small way back is elastic


def test_the_tangent_of_a_film_that_yields_is_the_derivative_of_its_stress():
    film, rng, h = Film(yield_MPa=30.0, hardening_MPa=40.0), np.random.default_rng(0), 1e-7
    first, way = np.eye(3) + 0.02 * rng.standard_normal((5, 3, 3)), rng.standard_normal((5, 3, 3))
    _, _, flow = flow_step(film, first, Flow.none(5))
    f = first + 0.02 * rng.standard_normal((5, 3, 3))
    change = (flow_step(film, f + h * way, flow)[0] - flow_step(film, f - h * way, flow)[0]) / (2.0 * h)
    expected = np.einsum("nijkl,nkl->nij", flow_step(film, f, flow)[1], way)
    np.testing.assert_allclose(change, expected, atol=1e-6 * np.abs(expected).max())


@pytest.mark.press
def test_a_film_that_has_yielded_leaves_a_charge_of_opposite_sign():
    made = replace(PAPER, fine=0.4)
    layers = tuple(replace(one, yield_MPa=30.0) if isinstance(one, Film) else one for one in made.layers)
    charges = {}
    for name, one in (("elastic", made), ("yields", replace(made, layers=layers))):
        stack = Stack(one)
        rest = stack.rest()
        deep = stack.press(rest, 0.3, 0.0)
        charges[name] = [stack.answer(x).charge_pC for x in (rest, deep, stack.press(deep, 0.0, 0.0))]
    assert charges["elastic"][2] == pytest.approx(charges["elastic"][0], abs=1e-3)
    assert charges["yields"][1] < 0.99 * charges["elastic"][1]
    assert charges["yields"][2] < -0.002 * charges["elastic"][1]


@pytest.mark.press
def test_one_long_step_finds_the_equilibrium_of_many_short_ones():
    made = replace(PAPER, fine=0.4)
    once, often = pressed(made, 0.3, 1), pressed(made, 0.3, 12)
    assert once.force_N == pytest.approx(often.force_N, rel=1e-6)
    assert once.charge_pC == pytest.approx(often.charge_pC, rel=1e-6)


@pytest.mark.press
def test_a_base_that_is_loose_on_one_side_gives_way_half_as_much_as_on_both():
    made = replace(PAPER, fine=0.4)
    bonded, left, both = (
        pressed(one, 0.2, 3).force_N
        for one in (made, replace(made, loose_from_mm=0.6, one_sided=True), replace(made, loose_from_mm=0.6))
    )
    assert bonded - left == pytest.approx(0.5 * (bonded - both), rel=0.15)

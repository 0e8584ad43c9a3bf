"""Plasticity of the film against closed forms of tension and shear, with isotropic and orthotropic elasticity."""

import numpy as np
import pytest

from solve.materials.film import film_law
from solve.materials.film_yield import YieldLaw, von_mises
from solve.materials.parameters import PiezoelectricFilm
from tests.cases import for_each

E, NU, G, YIELD = 2000.0, 0.29, 2000.0 / 2.58, 50.0  # MPa
ISOTROPIC = film_law(PiezoelectricFilm(youngs_modulus_MPa=E, poisson_ratio=NU), 0.0).stiffness / 1e6
DRAWN_MATERIAL = PiezoelectricFilm(youngs_modulus_MPa=E, youngs_modulus_2_MPa=1200.0, poisson_ratio=NU)
DRAWN = film_law(DRAWN_MATERIAL, 0.0).stiffness / 1e6
TURNED = film_law(DRAWN_MATERIAL, 30.0).stiffness / 1e6
STIFFNESS = {"isotropic": ISOTROPIC, "drawn": DRAWN, "drawn and turned": TURNED}
LAWS = {
    f"{name}, H = {hardening:g}": YieldLaw(stiffness, YIELD, hardening)
    for name, stiffness in STIFFNESS.items()
    for hardening in (0.0, 300.0, 1e5)
}


def plastic_work(answer):
    """S . dEp = q dkappa (n,), per volume."""
    return np.einsum("nv,nv->n", answer.stress, answer.plastic_strain)


class Specimen:
    """One point with its memory. Strains and stresses (6,)."""

    def __init__(self, law):
        self.law, self.plastic_strain, self.kappa = law, np.zeros(6), np.zeros(1)

    def strain(self, strain):
        """Stress at a strain, remembered."""
        answer = self.law.project((strain - self.plastic_strain)[None], self.kappa)
        self.plastic_strain, self.kappa = self.plastic_strain + answer.plastic_strain[0], answer.kappa
        return answer.stress[0], plastic_work(answer)[0]

    def pull(self, axial):
        """Stress along 1 at a strain along 1, with no other stress: Newton on the other five strains."""
        strain = np.zeros(6)
        strain[0] = axial
        for _ in range(30):
            answer = self.law.project((strain - self.plastic_strain)[None], self.kappa)
            residual, slope = answer.stress[0, 1:], answer.tangent[0, 1:, 1:]
            if np.abs(residual).max() < 1e-11:
                return self.strain(strain)[0][0]
            strain[1:] -= np.linalg.solve(slope, residual)
        raise AssertionError("no equilibrium across the specimen")


@for_each("stiffness", [ISOTROPIC, DRAWN], ids=["isotropic", "drawn"])
@for_each("hardening", [0.01, 300.0, 4000.0])
def test_tension_is_elastic_and_then_climbs_with_the_elastoplastic_modulus(stiffness, hardening):
    """S = E e up to sigma_y, then sigma_y + E H / (E + H) (e - sigma_y / E)."""
    specimen = Specimen(YieldLaw(stiffness, YIELD, hardening))
    for strain in np.linspace(0.0, 0.1, 41):
        beyond = max(strain - YIELD / E, 0.0)
        expected = E * (strain - beyond) + E * hardening / (E + hardening) * beyond
        assert specimen.pull(strain) == pytest.approx(expected, rel=1e-9)
    assert specimen.kappa[0] == pytest.approx(0.075 * E / (E + hardening), rel=1e-9)


@for_each("stiffness", STIFFNESS.values(), ids=STIFFNESS)
def test_perfect_plasticity_stays_on_the_yield_surface(stiffness):
    rng = np.random.default_rng(1)
    strain = 0.1 * rng.standard_normal((200, 6))
    answer = YieldLaw(stiffness, YIELD).project(strain, np.zeros(200))
    yielded = answer.kappa > 0.0
    assert yielded.sum() > 150
    np.testing.assert_allclose(von_mises(answer.stress[yielded]), YIELD, rtol=1e-12)
    change_of_volume = answer.plastic_strain[:, :3].sum(axis=1)
    np.testing.assert_allclose(change_of_volume, 0.0, atol=1e-14 * np.abs(answer.plastic_strain).max())


@for_each("law", LAWS.values(), ids=LAWS)
def test_projection_satisfies_hookes_law_flow_rule_and_hardening(law):
    rng = np.random.default_rng(7)
    strain, kappa = 0.08 * rng.standard_normal((100, 6)), 0.02 * rng.random(100)
    answer = law.project(strain, kappa)
    yielded = answer.kappa > kappa
    assert yielded.any()
    np.testing.assert_allclose(answer.stress, (strain - answer.plastic_strain) @ law.stiffness, atol=1e-9)
    q = von_mises(answer.stress)
    np.testing.assert_allclose(q[yielded], (law.yield_stress + law.hardening * answer.kappa)[yielded], rtol=1e-11)
    assert (q[~yielded] <= (law.yield_stress + law.hardening * kappa)[~yielded]).all()
    s = answer.stress - np.array([1, 1, 1, 0, 0, 0]) * answer.stress[:, :3].mean(axis=1, keepdims=True)
    normal = 1.5 * s * np.array([1, 1, 1, 2, 2, 2]) / q[:, None]
    np.testing.assert_allclose(answer.plastic_strain, (answer.kappa - kappa)[:, None] * normal, atol=1e-14)
    np.testing.assert_allclose(plastic_work(answer), q * (answer.kappa - kappa), rtol=1e-10)


def test_isotropic_projection_is_the_radial_return():
    """s = s_trial (1 - 3 G dkappa / q_trial), dkappa = f_trial / (3 G + H) (Simo and Hughes 1998, box 3.2)."""
    rng = np.random.default_rng(3)
    strain, hardening = 0.1 * rng.standard_normal((50, 6)), 400.0
    answer = YieldLaw(ISOTROPIC, YIELD, hardening).project(strain, np.zeros(50))
    trial = strain @ ISOTROPIC
    pressure = np.array([1, 1, 1, 0, 0, 0]) * trial[:, :3].mean(axis=1, keepdims=True)
    q = von_mises(trial)
    increment = np.maximum(q - YIELD, 0.0) / (3.0 * G + hardening)
    expected = pressure + (trial - pressure) * (1.0 - 3.0 * G * increment / q)[:, None]
    np.testing.assert_allclose(answer.kappa, increment, atol=1e-15)
    np.testing.assert_allclose(answer.stress, expected, rtol=1e-12, atol=1e-12)


@for_each("hardening", [0.0, 300.0])
def test_unloading_is_elastic_and_leaves_a_permanent_strain(hardening):
    """From strain e the stress falls by E de and vanishes at e - S / E."""
    specimen = Specimen(YieldLaw(DRAWN, YIELD, hardening))
    peak = specimen.pull(0.06)
    kappa = specimen.kappa.copy()
    permanent = 0.06 - peak / E
    assert specimen.pull(0.055) == pytest.approx(peak - 0.005 * E, rel=1e-9)
    assert specimen.pull(permanent) == pytest.approx(0.0, abs=1e-8)
    assert permanent == pytest.approx(kappa[0], rel=1e-9)
    np.testing.assert_array_equal(specimen.kappa, kappa)


@for_each("stiffness", [ISOTROPIC, DRAWN], ids=["isotropic", "drawn"])
def test_a_closed_cycle_of_strain_dissipates_the_area_of_its_loop(stiffness):
    """Shear between -g and g: a parallelogram of area 2 t (2 g - 2 t / G) with t = sigma_y / sqrt(3)."""
    law, shear = YieldLaw(stiffness, YIELD), stiffness[3, 3]
    limit = YIELD / np.sqrt(3.0)
    step = limit / shear / 10  # yield begins at the end of a step: the trapezoidal rule is exact
    specimen, strains, stresses, work = Specimen(law), [], [], 0.0
    turning = np.r_[0:30, 30:-30:-1, -30:31] * step
    for angle in turning:
        stress, done = specimen.strain(np.array([0, 0, 0, angle, 0, 0]))
        strains.append(angle)
        stresses.append(stress[3])
        work += done if len(strains) > 31 else 0.0  # the cycle begins at the first turning point
    area = np.trapezoid(stresses[30:], strains[30:])
    exact = 2.0 * limit * (2.0 * 30 * step - 2.0 * limit / shear)
    assert area == pytest.approx(exact, rel=1e-10)
    assert work == pytest.approx(exact, rel=1e-10)


@for_each("law", LAWS.values(), ids=LAWS)
def test_tangent_is_the_derivative_of_the_stress(law):
    rng = np.random.default_rng(11)
    strain, kappa = 0.06 * rng.standard_normal((30, 6)), 0.01 * rng.random(30)
    answer = law.project(strain, kappa)
    assert (answer.kappa > kappa).any()
    np.testing.assert_allclose(answer.tangent, answer.tangent.swapaxes(1, 2), atol=1e-9)
    for k, unit in enumerate(1e-6 * np.eye(6)):
        above, below = (law.project(strain + sign * unit, kappa).stress for sign in (1, -1))
        np.testing.assert_allclose(answer.tangent[:, :, k], (above - below) / 2e-6, atol=1e-6 * E)


@for_each("stiffness", STIFFNESS.values(), ids=STIFFNESS)
@for_each("yield_stress", [1e9, np.inf])
def test_without_yield_the_film_is_elastic_to_round_off(stiffness, yield_stress):
    strain = 0.1 * np.random.default_rng(0).standard_normal((20, 6))
    answer = YieldLaw(stiffness, yield_stress).project(strain, np.zeros(20))
    np.testing.assert_array_equal(answer.stress, strain @ stiffness)
    np.testing.assert_array_equal(answer.tangent, np.tile(stiffness, (20, 1, 1)))
    assert not answer.plastic_strain.any()
    assert not answer.kappa.any()


@for_each("overshoot", [1e-15, 1e-13, 1e-9, 1e-4, 1.0, 1e3])
@for_each("law", LAWS.values(), ids=LAWS)
def test_projection_converges_just_beyond_yield_and_far_beyond_it(law, overshoot):
    direction = np.array([1.0, -0.4, 0.1, 0.5, -0.3, 0.2])
    direction *= law.yield_stress / von_mises((direction @ law.stiffness)[None])
    answer = law.project((1.0 + overshoot) * direction[None], np.zeros(1))
    strength = law.yield_stress + law.hardening * answer.kappa
    assert von_mises(answer.stress) == pytest.approx(strength, rel=1e-12)
    assert answer.kappa >= 0.0


@for_each(
    ("changes", "message"),
    [
        ({"yield_stress": 0.0}, "yield stress = 0: must be above 0"),
        ({"yield_stress": np.nan}, "yield stress = nan: must be above 0"),
        ({"hardening": -1.0}, "hardening modulus = -1: must not be negative"),
        ({"stiffness": np.diag([1.0, 1.0, 0.0, 1.0, 1.0, 1.0])}, "the stiffness must be positive definite"),
    ],
)
def test_constants_without_a_stable_answer_are_refused(changes, message):
    with pytest.raises(ValueError, match=message):
        YieldLaw(**{"stiffness": ISOTROPIC, "yield_stress": YIELD, **changes})


def test_a_strain_that_is_no_number_is_refused():
    with pytest.raises(ArithmeticError, match="did not converge"):
        YieldLaw(ISOTROPIC, YIELD).project(np.full((1, 6), np.nan), np.zeros(1))

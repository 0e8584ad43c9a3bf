"""Stress of each law against closed forms and the slope of its energy, its tangent against the slope of its stress."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from solve.materials.hyperfoam import HyperfoamLaw
from solve.materials.laws import InvariantLaw, KnowlesLaw, LinearLaw, OgdenLaw, bulk_modulus
from solve.materials.parameters import Hyperfoam, Linear, MooneyRivlin, NeoHookean, Ogden, PiezoelectricFilm, Yeoh
from solve.tensors import from_voigt, to_voigt
from tests.cases import for_each

LAWS = {
    "neo-hookean": InvariantLaw(0.5, 0.0, 0.0, 0.0, 100.0),
    "mooney-rivlin": InvariantLaw(0.3, 0.2, 0.0, 0.0, 100.0),
    "yeoh": InvariantLaw(0.5, 0.0, 0.05, 0.002, 100.0),
    "knowles": KnowlesLaw(0.5, (1.2, 3.5), 100.0),
    "knowles softening": KnowlesLaw(0.5, (0.4, 0.5), 100.0),
    "fung": KnowlesLaw(0.5, (1.2, np.inf), 100.0),
    "linear": LinearLaw(1.0, 100.0),
    "ogden": OgdenLaw((0.63, 0.0012, -0.01, 0.1), (1.3, 5.0, -2.0, 0.0), 100.0),
    "hyperfoam": HyperfoamLaw((0.9, 0.1, 0.2), (12.0, -2.0, 3.0), (0.05 / 0.9, 0.0, 1.0)),
}
SOFTENING_LAWS = {  # small-strain stable, but no longer elliptic within the strains of the test
    "yeoh": InvariantLaw(0.5, 0.0, -0.2, 0.0, 100.0),
    "ogden": OgdenLaw((3.0, -1.0), (2.0, 4.0), 100.0),
    "hyperfoam": HyperfoamLaw((2.0, -1.0), (4.0, 8.0), (0.0, 0.0)),
}
STRETCHES = {
    "distinct": (0.7, 1.1, 1.4),
    "two equal": (1.2, 0.9, 1.2),
    "three equal": (1.1, 1.1, 1.1),
    "undeformed": (1.0, 1.0, 1.0),
    **{f"two within {gap:.0e}": (1.2, 0.9, 1.2 * (1 + gap)) for gap in (1e-15, 1e-9, 1e-7, 1e-5, 1e-3)},
    **{f"three within {gap:.0e}": (1.1, 1.1 * (1 - gap), 1.1 * (1 + gap)) for gap in (1e-15, 1e-9, 1e-6, 1e-3)},
}


def stretched(stretches, turned=True):
    """C (3, 3) of principal stretches along axes that are no coordinate axes."""
    axes = Rotation.from_rotvec([0.3, -0.5, 0.8]).as_matrix() if turned else np.eye(3)
    return axes @ np.diag(np.square(stretches)) @ axes.T


def nominal_stress(law, stretches, free_direction):
    """P1 of an incompressible block whose face normal to free_direction carries no traction."""
    c = np.diag(np.square(stretches))
    s = from_voigt(law.stress(c[None])[0][0])
    pressure = -s[free_direction, free_direction] * c[free_direction, free_direction]
    return stretches[0] * (s[0, 0] + pressure / c[0, 0])


@for_each(
    ("stretch", "uniaxial", "equibiaxial", "plane_strain"),
    [
        (0.7, -1.3408, -5.2499, -2.2155),
        (0.8, -0.7625, -2.2518, -1.1531),
        (1.5, 1.0556, 1.3683, 1.2037),
        (2.0, 1.7500, 1.9688, 1.8750),
    ],
)
def test_neo_hookean_table(stretch, uniaxial, equibiaxial, plane_strain):
    """Nominal stress over mu: L - L^-2, L - L^-5, L - L^-3 (Treloar, The Physics of Rubber Elasticity)."""
    law, x = LAWS["neo-hookean"], stretch
    assert nominal_stress(law, [x, x**-0.5, x**-0.5], 2) == pytest.approx(uniaxial, abs=5.01e-5)
    assert nominal_stress(law, [x, x, x**-2], 2) == pytest.approx(equibiaxial, abs=5.01e-5)
    assert nominal_stress(law, [x, 1.0, 1 / x], 2) == pytest.approx(plane_strain, abs=5.01e-5)


@for_each("x", [0.6, 0.9, 1.3, 2.5])
def test_mooney_rivlin_and_yeoh_in_uniaxial_tension(x):
    """P = 2 (L - L^-2)(W1 + W2 / L) with W1 = c10 + 2 c20 (I1 - 3) + 3 c30 (I1 - 3)^2."""
    i1 = x**2 + 2 / x - 3.0
    mooney = 2 * (x - x**-2) * (0.3 + 0.2 / x)
    yeoh = 2 * (x - x**-2) * (0.5 + 2 * 0.05 * i1 + 3 * 0.002 * i1**2)
    stretches = [x, x**-0.5, x**-0.5]
    assert nominal_stress(LAWS["mooney-rivlin"], stretches, 2) == pytest.approx(mooney, rel=1e-12)
    assert nominal_stress(LAWS["yeoh"], stretches, 2) == pytest.approx(yeoh, rel=1e-12)


@for_each("x", [0.6, 0.9, 1.3, 2.5])
@for_each(
    ("law", "slope"),
    [
        (LAWS["knowles"], lambda excess: 0.5 * (1 + 1.2 / 3.5 * excess) ** 2.5),
        (LAWS["fung"], lambda excess: 0.5 * np.exp(1.2 * excess)),
        (KnowlesLaw(0.5, (1.2, 2.0), 100.0), InvariantLaw(0.5, 0.0, 0.15, 0.0, 100.0)),
        (KnowlesLaw(0.5, (1.2, 1.0), 100.0), LAWS["neo-hookean"]),
    ],
    ids=["power", "exponential", "n = 2 is Yeoh's quadratic", "n = 1 is neo-Hookean"],
)
def test_knowles_in_uniaxial_tension(law, slope, x):
    """P = 2 (L - L^-2) W1 with W1 = c10 (1 + b / n (I1 - 3))^(n - 1) (Knowles 1977); exp(b (I1 - 3)) in the limit."""
    stretches = [x, x**-0.5, x**-0.5]
    if callable(slope):
        expected = 2 * (x - x**-2) * slope(x**2 + 2 / x - 3.0)
    else:
        expected = nominal_stress(slope, stretches, 2)
    assert nominal_stress(law, stretches, 2) == pytest.approx(expected, rel=1e-12)


@for_each("stretches", STRETCHES.values(), ids=STRETCHES)
@for_each("name", LAWS)
def test_tangent_is_the_derivative_of_the_stress(name, stretches):
    law, c = LAWS[name], stretched(stretches)
    tangent = law.stress(c[None])[1][0]
    step = 1e-6 * 2.0 * from_voigt(np.eye(6), 2.0)  # dC = 2 dE
    difference = (law.stress(c + step)[0] - law.stress(c - step)[0]) / 2e-6
    np.testing.assert_allclose(tangent.T, difference, atol=1e-8 * np.abs(tangent).max())
    np.testing.assert_allclose(tangent, tangent.T, atol=1e-12)


@for_each("name", LAWS)
def test_tangent_is_the_derivative_of_the_stress_at_random_states(name):
    rng = np.random.default_rng(0)
    f = np.eye(3) + 0.15 * rng.standard_normal((40, 3, 3))
    c, law = f.swapaxes(1, 2) @ f, LAWS[name]
    tangent = law.stress(c)[1]
    for column, unit in enumerate(np.eye(6)):
        step = 1e-6 * 2.0 * from_voigt(unit, 2.0)
        difference = (law.stress(c + step)[0] - law.stress(c - step)[0]) / 2e-6
        scale = np.abs(tangent).max(axis=(1, 2))[:, None]
        np.testing.assert_allclose(tangent[:, :, column] / scale, difference / scale, atol=1e-8)


@for_each("stretches", STRETCHES.values(), ids=STRETCHES)
@for_each("name", LAWS)
def test_stress_is_the_derivative_of_the_energy(name, stretches):
    """S = 2 dW/dC; W vanishes in the undeformed state."""
    law, c = LAWS[name], stretched(stretches)
    step = 1e-5 * 2.0 * from_voigt(np.eye(6), 2.0)
    difference = (law.energy(c + step) - law.energy(c - step)) / 2e-5
    np.testing.assert_allclose(law.stress(c[None])[0][0], difference, atol=1e-8)
    np.testing.assert_allclose(law.energy(np.eye(3)[None]), 0.0, atol=1e-16)


@for_each("name", ["neo-hookean", "mooney-rivlin", "yeoh", "knowles", "fung", "linear"])
def test_stress_is_the_complex_step_derivative_of_the_energy(name):
    c = stretched((0.7, 1.1, 1.4))
    slope = LAWS[name].energy(c + 1e-30j * 2.0 * from_voigt(np.eye(6), 2.0)).imag / 1e-30
    np.testing.assert_allclose(LAWS[name].stress(c[None])[0][0], slope, rtol=1e-12)


@for_each("name", LAWS)
def test_a_law_does_not_know_the_axes_or_the_unit(name):
    law, turn = LAWS[name], Rotation.from_rotvec([0.2, 0.9, -0.4]).as_matrix()
    c = stretched((0.7, 1.1, 1.4))
    s = from_voigt(law.stress(c[None])[0][0])
    turned = law.scale_moduli(1e6).stress((turn @ c @ turn.T)[None])[0][0]
    np.testing.assert_allclose(from_voigt(turned), 1e6 * turn @ s @ turn.T, atol=1e-8)
    np.testing.assert_allclose(law.scale_moduli(1e6).energy(c[None]), 1e6 * law.energy(c[None]), rtol=1e-14)
    assert law.scale_moduli(1e6).bulk_modulus == pytest.approx(1e6 * law.bulk_modulus)


@for_each("name", SOFTENING_LAWS)
def test_a_law_beyond_its_ellipticity_still_answers_with_numbers(name):
    """Strong ellipticity needs A_2121 = F22^2 CC_1212 + S_11 > 0 (Ogden, Non-linear Elastic Deformations, 1984,
    sec. 6.2); a pressure p J C^-1 cancels from it."""
    law = SOFTENING_LAWS[name]
    assert law.shear_modulus > 0.0
    assert law.bulk_modulus > 0.0
    c = np.array([np.diag(np.square([x, x**-0.5, x**-0.5])) for x in np.linspace(0.3, 3.0, 28)])
    stress, tangent = law.stress(c)
    assert np.isfinite(stress).all()
    assert np.isfinite(tangent).all()
    assert np.isfinite(law.energy(c)).all()
    acoustic = c[:, 1, 1] * tangent[:, 3, 3] + stress[:, 0]
    assert acoustic.min() < 0.0 < acoustic[7]  # lost somewhere, but not in the undeformed state


@for_each("name", LAWS)
def test_small_strain_is_hookes_law(name):
    """At C = 1 the isochoric tangent is 2 mu times the deviatoric projector; the whole one adds K tr E."""
    law = LAWS[name]
    stress, tangent = law.stress(np.eye(3)[None])
    np.testing.assert_allclose(stress, 0.0, atol=1e-14)
    strain = np.array([1.0, 2.0, -0.5, 0.3, 0.1, -0.2])
    tensor = from_voigt(strain, 2.0)
    deviator = tensor - np.trace(tensor) / 3.0 * np.eye(3)
    hooke = 2.0 * law.shear_modulus * deviator
    if law.compressible:
        hooke += law.bulk_modulus * np.trace(tensor) * np.eye(3)
    np.testing.assert_allclose(tangent[0] @ strain, to_voigt(hooke), atol=1e-12)


def test_the_law_has_the_moduli_of_the_constants():
    """G = E / (2 (1 + nu)), K = E / (3 (1 - 2 nu)), all in MPa."""
    rubber = NeoHookean(youngs_modulus_MPa=5.0, poisson_ratio=0.495).law
    assert rubber.shear_modulus == pytest.approx(5.0 / 2.99)
    assert rubber.bulk_modulus == pytest.approx(5.0 / 0.03)
    assert Linear(youngs_modulus_MPa=2.0, poisson_ratio=0.3).law.bulk_modulus == pytest.approx(2.0 / 1.2)
    assert MooneyRivlin(c10_MPa=0.3, c01_MPa=0.1).law.shear_modulus == pytest.approx(0.8)
    assert Yeoh(c10_MPa=0.3, c20_MPa=0.0, c30_MPa=0.0).law.shear_modulus == pytest.approx(0.6)
    ogden = Ogden(mu_MPa=(0.6, -0.01), alpha=(1.3, -2.0), poisson_ratio=0.49).law
    assert ogden.shear_modulus == pytest.approx(0.4)
    assert ogden.bulk_modulus == pytest.approx(2 * 0.4 * 1.49 / 0.06)
    foam = Hyperfoam(mu_MPa=(0.02, 0.01), alpha=(12.0, 8.0), poisson_ratio=(0.25, 0.0)).law
    assert foam.shear_modulus == pytest.approx(0.03)
    assert foam.bulk_modulus == pytest.approx(2 * 0.02 * (0.5 + 1 / 3) + 2 * 0.01 / 3)  # beta = 1/2 and 0
    assert bulk_modulus(1.0, 0.0) == pytest.approx(2.0 / 3.0)
    with pytest.raises(ValueError, match="piezoelectric-film is not a medium"):
        _ = PiezoelectricFilm().law

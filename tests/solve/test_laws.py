"""Stress of each law against closed forms, and its tangent against differences of the stress."""

import numpy as np
import pytest

from solve.materials.laws import InvariantLaw, LinearLaw, bulk_modulus, medium_law
from solve.materials.parameters import Linear, MooneyRivlin, NeoHookean, Yeoh
from solve.materials.voigt import from_voigt, to_voigt

LAWS = {
    "neo-hookean": InvariantLaw(0.5, 0.0, 0.0, 0.0, 100.0),
    "mooney-rivlin": InvariantLaw(0.3, 0.2, 0.0, 0.0, 100.0),
    "yeoh": InvariantLaw(0.5, 0.0, 0.05, 0.002, 100.0),
    "linear": LinearLaw(1.0, 100.0),
}


def nominal_stress(law, stretches, free_direction):
    """P1 of an incompressible block whose face normal to free_direction carries no traction."""
    c = np.diag(np.square(stretches))
    s = from_voigt(law.stress(c[None])[0][0])
    pressure = -s[free_direction, free_direction] * c[free_direction, free_direction]
    return stretches[0] * (s[0, 0] + pressure / c[0, 0])


@pytest.mark.parametrize(
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


@pytest.mark.parametrize("x", [0.6, 0.9, 1.3, 2.5])
def test_mooney_rivlin_and_yeoh_in_uniaxial_tension(x):
    """P = 2 (L - L^-2)(W1 + W2 / L) with W1 = c10 + 2 c20 (I1 - 3) + 3 c30 (I1 - 3)^2."""
    i1 = x**2 + 2 / x - 3.0
    mooney = 2 * (x - x**-2) * (0.3 + 0.2 / x)
    yeoh = 2 * (x - x**-2) * (0.5 + 2 * 0.05 * i1 + 3 * 0.002 * i1**2)
    stretches = [x, x**-0.5, x**-0.5]
    assert nominal_stress(LAWS["mooney-rivlin"], stretches, 2) == pytest.approx(mooney, rel=1e-12)
    assert nominal_stress(LAWS["yeoh"], stretches, 2) == pytest.approx(yeoh, rel=1e-12)


@pytest.mark.parametrize("name", LAWS)
def test_tangent_is_the_derivative_of_the_stress(name):
    rng = np.random.default_rng(0)
    f = np.eye(3) + 0.3 * rng.standard_normal((3, 3))
    c = f.T @ f
    tangent = LAWS[name].stress(c[None])[1][0]
    for column, unit in enumerate(np.eye(6)):
        step = 1e-6 * 2.0 * from_voigt(unit, 2.0)  # dC = 2 dE
        difference = (LAWS[name].stress((c + step)[None])[0] - LAWS[name].stress((c - step)[None])[0])[0] / 2e-6
        np.testing.assert_allclose(tangent[:, column], difference, atol=1e-7)
    np.testing.assert_allclose(tangent, tangent.T, atol=1e-12)


@pytest.mark.parametrize("name", LAWS)
def test_small_strain_is_hookes_law(name):
    """At C = 1 the isochoric tangent is 2 mu times the deviatoric projector."""
    law = LAWS[name]
    stress, tangent = law.stress(np.eye(3)[None])
    np.testing.assert_allclose(stress, 0.0, atol=1e-14)
    strain = np.array([1.0, 2.0, -0.5, 0.3, 0.1, -0.2])
    tensor = from_voigt(strain, 2.0)
    deviator = tensor - np.trace(tensor) / 3.0 * np.eye(3)
    np.testing.assert_allclose(tangent[0] @ strain, 2.0 * law.shear_modulus * to_voigt(deviator), atol=1e-12)


def test_constants_in_pascal():
    """G = E / (2 (1 + nu)), K = E / (3 (1 - 2 nu))."""
    rubber = medium_law(NeoHookean(youngs_modulus_MPa=5.0, poisson_ratio=0.495))
    assert rubber.shear_modulus == pytest.approx(5e6 / 2.99)
    assert rubber.bulk_modulus == pytest.approx(5e6 / 0.03)
    assert medium_law(Linear(youngs_modulus_MPa=2.0, poisson_ratio=0.3)).bulk_modulus == pytest.approx(2e6 / 1.2)
    assert medium_law(MooneyRivlin(c10_MPa=0.3, c01_MPa=0.1)).shear_modulus == pytest.approx(0.8e6)
    assert medium_law(Yeoh(c10_MPa=0.3, c20_MPa=0.0, c30_MPa=0.0)).shear_modulus == pytest.approx(0.6e6)
    assert bulk_modulus(1.0, 0.0) == pytest.approx(2.0 / 3.0)

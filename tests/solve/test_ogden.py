"""Ogden rubber against closed forms and against the laws that it contains."""

import numpy as np
import pytest

from solve.materials.laws import InvariantLaw, OgdenLaw
from tests.cases import for_each
from tests.solve.test_laws import STRETCHES, nominal_stress, stretched

# Ogden, Proc. R. Soc. Lond. A 326, 1972: three terms for the vulcanised rubber of Treloar (MPa)
MU, ALPHA = np.array([0.63, 0.0012, -0.01]), np.array([1.3, 5.0, -2.0])
TRELOAR = OgdenLaw(tuple(MU), tuple(ALPHA), 1000.0)


@for_each("x", [0.4, 0.7, 0.999, 1.0, 1.001, 2.0, 4.0, 7.0])
def test_treloars_rubber_in_tension_sheet_stretching_and_plane_strain(x):
    """P1 = sum mu (L^(alpha - 1) - L3^alpha / L) with the stretch L3 along the free direction."""

    def closed_form(free):
        return float(np.sum(MU * (x ** (ALPHA - 1.0) - free**ALPHA / x)))

    tension, sheet, plane = [x, x**-0.5, x**-0.5], [x, x, x**-2], [x, 1.0, 1.0 / x]
    for stretches in (tension, sheet, plane):
        expected = closed_form(stretches[2])
        assert nominal_stress(TRELOAR, stretches, 2) == pytest.approx(expected, rel=1e-12, abs=1e-14)


def test_simple_shear_of_treloars_rubber():
    """Cauchy shear stress (L dW/dL) / (L + 1/L) with L - 1/L = the amount of shear (Ogden 1984, sec. 4.3)."""
    amount = 1.5
    f = np.array([[1.0, amount, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    s = TRELOAR.stress((f.T @ f)[None])[0][0]
    cauchy = f @ np.array([[s[0], s[3], s[5]], [s[3], s[1], s[4]], [s[5], s[4], s[2]]]) @ f.T
    x = 0.5 * amount + np.sqrt(1.0 + 0.25 * amount**2)
    assert cauchy[0, 1] == pytest.approx(np.sum(MU * (x**ALPHA - x**-ALPHA)) / (x + 1.0 / x), rel=1e-12)


@for_each("stretches", STRETCHES.values(), ids=STRETCHES)
def test_exponents_2_and_minus_2_are_mooney_rivlin_to_round_off(stretches):
    """I1 - 3 and I2 - 3 are the sums of l^2 - 1 and l^-2 - 1: no digit is lost at equal or close stretches."""
    mooney, ogden = InvariantLaw(0.3, 0.2, 0.0, 0.0, 100.0), OgdenLaw((0.6, -0.4), (2.0, -2.0), 100.0)
    c = stretched(stretches)[None]
    for ours, reference in zip(ogden.stress(c), mooney.stress(c), strict=True):
        np.testing.assert_allclose(ours, reference, rtol=0.0, atol=5e-14)
    np.testing.assert_allclose(ogden.energy(c), mooney.energy(c), rtol=0.0, atol=1e-14)


@for_each("factor", [0.8, 1.25])
def test_a_change_of_volume_alone_costs_no_isochoric_energy(factor):
    c = factor**2 * np.eye(3)[None]
    np.testing.assert_allclose(TRELOAR.stress(c)[0], 0.0, atol=1e-15)
    np.testing.assert_allclose(TRELOAR.energy(c), 0.0, atol=1e-15)


def test_the_answer_does_not_depend_on_the_company_of_a_point():
    """Points are computed in batches: one alone answers as one among a thousand."""
    rng = np.random.default_rng(5)
    f = np.eye(3) + 0.2 * rng.standard_normal((1000, 3, 3))
    c = f.swapaxes(1, 2) @ f
    stress, tangent = TRELOAR.stress(c)
    for point in (0, 255, 256, 999):
        alone = TRELOAR.stress(c[point : point + 1])
        np.testing.assert_array_equal(alone[0][0], stress[point])
        np.testing.assert_array_equal(alone[1][0], tangent[point])

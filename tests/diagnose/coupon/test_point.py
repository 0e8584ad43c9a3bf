"""Coupons against closed forms: nominal stress of the laws, relaxation, softening, the tester's own compliance."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.special import erf

from diagnose.engines.coupon.kinematics import Equibiaxial, Planar, SimpleShear, Uniaxial
from diagnose.engines.coupon.point import MaterialPoint
from diagnose.engines.coupon.relaxation import NO_SERIES
from solve.materials.hyperfoam import HyperfoamLaw
from solve.materials.laws import InvariantLaw, LinearLaw, OgdenLaw
from solve.materials.mullins import Softening
from solve.materials.multiplicative import MultiplicativeMaxwell
from solve.materials.prony import Prony
from solve.solution.errors import NoEquilibriumError
from tests.cases import for_each

C10, C20, C30, STIFF = 0.4, 0.05, 0.01, 1e7
YEOH = InvariantLaw(C10, 0.0, C20, C30, STIFF)
LENGTH, AREA = 20.0, 3.0
TENSION, COMPRESSION, SHEAR = Uniaxial(1.0, LENGTH, AREA), Uniaxial(-1.0, LENGTH, AREA), SimpleShear(LENGTH, AREA)
BRANCHES = (0.5, 0.3), (0.2, 3.0)
TIME = np.linspace(0.0, 10.0, 501)
UP_AND_DOWN = np.interp(TIME, [0.0, 2.0, 4.0, 6.0, 8.0, 10.0], [0.0, 8.0, 1.0, 8.0, 0.0, 10.0])


def force(kinematics, law, travel, poisson_ratio=0.5, **others):
    """Of a travel without memory."""
    return MaterialPoint(kinematics, law, poisson_ratio, **others).answer(TIME, travel, "displacement_mm")


def yeoh_slope(excess):
    """dW / dI1."""
    return C10 + 2.0 * C20 * excess + 3.0 * C30 * excess**2


@for_each(
    ("kinematics", "stretch", "across"),
    [
        (TENSION, 1.0 + TIME / 5.0, (-0.5, -0.5)),
        (COMPRESSION, 1.0 - TIME / 20.0, (-0.5, -0.5)),
        (Planar(1.0, LENGTH, AREA), 1.0 + TIME / 5.0, (0.0, -1.0)),
        (Equibiaxial(1.0, LENGTH, AREA), 1.0 + TIME / 10.0, (1.0, -2.0)),
    ],
)
def test_incompressible_yeoh_along_a_strip_a_sheet_and_through_a_block(kinematics, stretch, across):
    """P = 2 (l - l3^2 / l) dW/dI1, the third stretch being free (Treloar, The Physics of Rubber Elasticity)."""
    travel = LENGTH * np.abs(stretch - 1.0)
    excess = stretch**2 + sum(stretch ** (2.0 * power) for power in across) - 3.0
    expected = AREA * np.abs(2.0 * (stretch - stretch ** (2.0 * across[1] - 1.0)) * yeoh_slope(excess))
    np.testing.assert_allclose(force(kinematics, YEOH, travel), expected, rtol=1e-5, atol=1e-6)


def test_shear_of_yeoh_needs_no_volume():
    """tau = 2 g dW/dI1 with I1 - 3 = g^2, for any bulk modulus."""
    shear = TIME / 4.0
    expected = AREA * 2.0 * shear * yeoh_slope(shear**2)
    soft = InvariantLaw(C10, 0.0, C20, C30, 1.0)
    np.testing.assert_allclose(force(SHEAR, soft, LENGTH * shear), expected, rtol=1e-9)


def test_small_strain_is_hookes_law_for_any_poisson_ratio():
    shear, ratio = 0.5, 0.3
    bulk = 2.0 * shear * (1.0 + ratio) / (3.0 * (1.0 - 2.0 * ratio))
    strain = 1e-5 * TIME
    for law in (LinearLaw(shear, bulk), InvariantLaw(0.5 * shear, 0.0, 0.0, 0.0, bulk), OgdenLaw((1.0,), (1.0,), bulk)):
        expected = AREA * 2.0 * shear * (1.0 + ratio) * strain
        np.testing.assert_allclose(force(TENSION, law, LENGTH * strain, ratio), expected, rtol=5e-4)


def test_a_foam_without_lateral_strain():
    """P = 2 mu / alpha (l^(alpha - 1) - 1 / l) for nu = 0."""
    stretch, mu, alpha = 1.0 - TIME / 15.0, 0.1, 8.0
    expected = AREA * 2.0 * mu / alpha * (1.0 / stretch - stretch ** (alpha - 1.0))
    foam = HyperfoamLaw((mu,), (alpha,), (0.0,))
    np.testing.assert_allclose(force(COMPRESSION, foam, LENGTH * (1.0 - stretch), 0.0), expected, rtol=1e-8, atol=1e-12)


def test_a_sheared_layer_relaxes_along_its_series():
    moduli, times = (0.3, 0.2), (0.5, 4.0)
    relaxed = force(SHEAR, YEOH, np.full(len(TIME), 5.0), series=Prony(moduli, times))
    fall = 1.0 - sum(g * (1.0 - np.exp(-TIME / tau)) for g, tau in zip(moduli, times, strict=True))
    np.testing.assert_allclose(relaxed / relaxed[0], fall, rtol=1e-12)


def test_a_quick_branch_of_a_layer_is_a_viscosity_that_grows_with_the_shear():
    """g mu tau (1 + g^2 / 3) times the rate: of S, S12 + g S22 with mu = 2 c10 and C^-1 of the shear g.

    A branch remembers its last tau, in which the shear grew by tau times the rate.
    """
    rate, share, tau = 1.0, 0.5, 1e-3
    law = InvariantLaw(C10, 0.0, 0.0, 0.0, STIFF)
    shear = rate * TIME
    whole = force(SHEAR, law, LENGTH * shear, series=Prony((share,), (tau,)))
    kept = (1.0 - share) * force(SHEAR, law, LENGTH * shear)
    expected = AREA * share * 2.0 * C10 * tau * rate * (1.0 + shear**2 / 3.0)
    np.testing.assert_allclose((whole - kept)[50:], expected[50:], rtol=0.03)


def test_a_strip_of_flowing_rubber_holds_what_its_branches_have_not_let_go():
    """P = (1 - g) P0 + g mu (l / c - l^-2 c^(1/2)), tau dc/dt = l^2 - (l^2 / c + 2 c^(1/2) / l) c / 3."""
    share, tau, stretch = 0.7, 2.0, 2.5
    law = InvariantLaw(C10, 0.0, 0.0, 0.0, STIFF)
    series = MultiplicativeMaxwell((share,), (tau,))
    time = np.linspace(0.0, 10.0, 4001)
    found = MaterialPoint(TENSION, law, 0.5, None, series).answer(time, np.full(4001, 1.5 * LENGTH), "displacement_mm")

    def rate(_, c):
        return (stretch**2 - (stretch**2 / c + 2.0 * np.sqrt(c) / stretch) * c / 3.0) / tau

    flowed = solve_ivp(rate, (0.0, 10.0), [1.0], t_eval=time, rtol=1e-10, atol=1e-12).y[0]
    mu = 2.0 * C10
    branch = mu * (stretch / flowed - np.sqrt(flowed) / stretch**2)
    expected = AREA * ((1.0 - share) * mu * (stretch - stretch**-2) + share * branch)
    np.testing.assert_allclose(found, expected, rtol=1e-3)


def test_rubber_in_tension_relaxes_as_its_second_piola_kirchhoff_stress_does():
    """The volume stays, so that S11 - S22 C22 / C11 relaxes and with it the force."""
    relaxed = force(TENSION, YEOH, np.full(len(TIME), 10.0), series=Prony((0.4,), (2.0,)))
    np.testing.assert_allclose(relaxed / relaxed[0], 0.6 + 0.4 * np.exp(-TIME / 2.0), rtol=1e-5)


def test_a_second_cycle_is_softer_by_the_error_function():
    law = InvariantLaw(C10, 0.0, 0.0, 0.0, STIFF)
    elastic = force(SHEAR, law, UP_AND_DOWN)
    soft = force(SHEAR, law, UP_AND_DOWN, softening=Softening(0.4, 0.0, 0.3))
    energy = C10 * (UP_AND_DOWN / LENGTH) ** 2
    largest = np.maximum.accumulate(energy)
    expected = elastic * (1.0 - 0.4 * erf((largest - energy) / (0.3 * np.maximum(largest, 1e-30))))
    np.testing.assert_allclose(soft, expected, rtol=1e-10, atol=1e-14)
    np.testing.assert_allclose(soft[:100], elastic[:100], rtol=1e-12)


@for_each("kinematics", [TENSION, COMPRESSION, SHEAR])
@for_each("series", [NO_SERIES, Prony(*BRANCHES), MultiplicativeMaxwell(*BRANCHES, 0.6)])
@for_each("law", [InvariantLaw(C10, 0.0, C20, C30, 80.0), OgdenLaw((0.5, 0.01), (1.5, 5.0), 80.0)])
def test_the_travel_of_a_force_is_the_travel_that_makes_it(kinematics, law, series):
    point = MaterialPoint(kinematics, law, 0.49, None, series)
    there = point.answer(TIME, UP_AND_DOWN, "displacement_mm")
    np.testing.assert_allclose(point.answer(TIME, there, "force_N"), UP_AND_DOWN, atol=1e-7)


def test_a_softening_coupon_driven_by_force():
    point = MaterialPoint(TENSION, YEOH, 0.5, Softening(0.3, 0.0, 0.3))
    there = point.answer(TIME, UP_AND_DOWN, "displacement_mm")
    rising = UP_AND_DOWN[:101]
    np.testing.assert_allclose(point.answer(TIME[:101], there[:101], "force_N"), rising, atol=1e-6)
    np.testing.assert_allclose(point.answer(TIME, there, "force_N"), UP_AND_DOWN, atol=1e-4)


def test_the_tester_takes_its_part_of_the_travel():
    compliance = 0.8
    stiff, soft = MaterialPoint(TENSION, YEOH, 0.5), MaterialPoint(TENSION, YEOH, 0.5, compliance_mm_per_N=compliance)
    pulled = stiff.answer(TIME, UP_AND_DOWN, "displacement_mm")
    travel = UP_AND_DOWN + compliance * pulled
    np.testing.assert_allclose(soft.answer(TIME, travel, "displacement_mm"), pulled, atol=1e-7)
    np.testing.assert_allclose(soft.answer(TIME, pulled, "force_N"), travel, atol=1e-6)


def test_a_law_that_turns_over_has_no_equilibrium_beyond():
    turning = InvariantLaw(C10, 0.0, -0.05, 0.0, STIFF)
    most = np.max(force(TENSION, turning, 0.4 * LENGTH * TIME / 10.0))
    with pytest.raises(NoEquilibriumError, match="the stress of its law falls"):
        MaterialPoint(TENSION, turning, 0.5).answer(TIME, 10.0 * most * TIME / 10.0, "force_N")

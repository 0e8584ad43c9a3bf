"""Maxwell branches that flow, at a material point."""

import numpy as np
from scipy.integrate import solve_ivp

from solve.materials.inelastic import StressResponse
from solve.materials.laws import InvariantLaw
from solve.materials.multiplicative import MultiplicativeMaxwell
from solve.materials.prony import Prony
from solve.tensors import from_voigt, to_voigt
from tests.cases import for_each

LAW = InvariantLaw(0.4, 0.1, 0.05, 0.01, 20.0)
G, TAU = (0.3, 0.2), (0.3, 2.0)
SERIES = MultiplicativeMaxwell(G, TAU, 1.0, LAW.shear_modulus)


def answer(series, strains, time):
    """Stress (t, 6) of a history of C (t, 3, 3), and the tangent at its end, from rest."""
    memory, found = series.start(1), []
    for c, step in zip(strains, np.diff(time, prepend=time[0]), strict=True):
        response, memory = series.update(elastic(c), memory, step)
        found.append(response.stress[0])
    return np.array(found), response.tangent[0]


def elastic(c):
    return StressResponse(*LAW.stress(c[None]), cauchy_green=c[None])


def sheared(shear):
    """C (t, 3, 3) of simple shear."""
    f = np.tile(np.eye(3), (len(shear), 1, 1))
    f[:, 0, 1] = shear
    return f.transpose(0, 2, 1) @ f


def isochoric(c):
    return np.linalg.det(c) ** (-1.0 / 3.0) * c


def integrated(course, time):
    """S (6,) of both branches at the end: tau dC_i/dt = C^ - (C^ : C_i^-1) / 3 C_i by an integrator of SciPy."""

    def rate(t, flat):
        flowed = flat.reshape(2, 3, 3)
        c = isochoric(course(t))
        share = np.einsum("ij,bji->b", c, np.linalg.inv(flowed)) / 3.0
        return ((c - share[:, None, None] * flowed) / np.array(TAU)[:, None, None]).ravel()

    found = solve_ivp(rate, (0.0, time), np.tile(np.eye(3), (2, 1, 1)).ravel(), rtol=1e-11, atol=1e-12)
    c, total = course(time), np.zeros((3, 3))
    for g, flowed in zip(G, found.y[:, -1].reshape(2, 3, 3), strict=True):
        inner = np.linalg.inv(flowed)
        deviator = inner - np.trace(c @ inner) / 3.0 * np.linalg.inv(c)
        total += g * LAW.shear_modulus * np.linalg.det(c) ** (-1.0 / 3.0) * deviator
    return to_voigt(total)


def course(t):
    """A shear of 1.2 with a stretch that changes the volume, up in a second and on."""
    f = np.array([[1.0 + 0.3 * t, 1.2 * np.sin(t), 0.1 * t], [0.0, 1.0 - 0.1 * t, 0.2 * t], [0.0, 0.0, 1.0 + 0.05 * t]])
    return f.T @ f


def test_the_branches_flow_as_the_differential_equation_says():
    """The explicit update is of second order, at strains of one too."""
    exact, errors = integrated(course, 1.5), []
    for steps in (40, 80, 160):
        time = np.linspace(0.0, 1.5, steps + 1)
        stress = answer(SERIES, np.array([course(t) for t in time]), time)[0][-1]
        never = (1.0 - sum(G)) * elastic(course(1.5)).stress[0]
        errors.append(np.abs(stress - never - exact).max() / np.abs(exact).max())
    assert errors[-1] < 3e-5
    np.testing.assert_allclose(np.log2(np.divide(errors[:-1], errors[1:])), 2.0, atol=0.1)


def test_at_small_strain_it_is_the_series_of_the_stress():
    time = np.linspace(0.0, 4.0, 60)
    strains = sheared(1e-5 * np.sin(3.0 * time))
    plain = answer(Prony(G, TAU), strains, time)[0]
    np.testing.assert_allclose(answer(SERIES, strains, time)[0][:, 3], plain[:, 3], rtol=1e-7, atol=1e-12)


def test_a_step_is_instantaneously_elastic_and_ends_at_what_never_relaxes():
    law = InvariantLaw(0.4, 0.0, 0.0, 0.0, 20.0)
    series, c = MultiplicativeMaxwell(G, TAU, 1.0, law.shear_modulus), sheared(np.array([2.0]))
    response = StressResponse(*law.stress(c), cauchy_green=c)
    at_once, memory = series.update(response, series.start(1), 0.0)
    np.testing.assert_allclose(at_once.stress, response.stress, atol=1e-12)
    np.testing.assert_allclose(at_once.tangent, response.tangent, atol=1e-12)
    late = series.update(response, series.update(response, memory, 1e3)[1], 1e3)[0]
    np.testing.assert_allclose(late.stress, 0.5 * response.stress, atol=1e-9)


def test_a_quick_branch_is_a_newtonian_fluid_however_large_the_shear():
    """Nominal shear stress S12 + g S22 = mu tau dg/dt (a Prony series of S makes it mu tau dg/dt (1 + g^2 / 3))."""
    tau, rate = 1e-3, 1.0
    series, time = MultiplicativeMaxwell((0.5,), (tau,), 1.0, LAW.shear_modulus), np.linspace(0.0, 10.0, 4001)
    shear = rate * time
    stress = answer(series, sheared(shear), time)[0]
    branch = stress - 0.5 * LAW.stress(sheared(shear))[0]
    nominal = branch[20:, 3] + shear[20:] * branch[20:, 1]
    np.testing.assert_allclose(nominal, 0.5 * LAW.shear_modulus * tau * rate, rtol=2e-3)


def test_what_does_not_flow_is_the_series_of_the_stress():
    time = np.linspace(0.0, 1.5, 31)
    strains = np.array([course(t) for t in time])
    flows, plain = answer(SERIES, strains, time)[0], answer(Prony(G, TAU), strains, time)[0]
    partly = answer(MultiplicativeMaxwell(G, TAU, 0.3, LAW.shear_modulus), strains, time)[0]
    np.testing.assert_allclose(partly, 0.3 * flows + 0.7 * plain, atol=1e-12)


@for_each("flowing", [1.0, 0.4])
def test_the_tangent_is_the_derivative_of_the_stress_and_symmetric(flowing):
    rng = np.random.default_rng(0)
    history = np.array([f.T @ f for f in np.eye(3) + 0.4 * rng.standard_normal((4, 3, 3))])
    time, change = np.array([0.0, 0.3, 0.6, 0.8]), 1e-6
    series = MultiplicativeMaxwell(G, TAU, flowing, LAW.shear_modulus)

    def end(strain):
        return answer(series, [*history[:-1], history[-1] + 2.0 * from_voigt(strain, 2.0)], time)

    slope = np.stack([(end(change * e)[0][-1] - end(-change * e)[0][-1]) / (2.0 * change) for e in np.eye(6)], axis=1)
    tangent = end(np.zeros(6))[1]
    np.testing.assert_allclose(tangent, slope, atol=1e-6)
    np.testing.assert_allclose(tangent, tangent.T, atol=1e-12)


@for_each("angle", [0.3, 2.0])
def test_a_rotation_of_the_reference_turns_the_stress_with_it(angle):
    turn = np.array([[np.cos(angle), -np.sin(angle), 0.0], [np.sin(angle), np.cos(angle), 0.0], [0.0, 0.0, 1.0]])
    time = np.linspace(0.0, 1.0, 11)
    strains = np.array([course(t) for t in time])
    plain = from_voigt(answer(SERIES, strains, time)[0][-1])
    turned = from_voigt(answer(SERIES, turn @ strains @ turn.T, time)[0][-1])
    np.testing.assert_allclose(turned, turn @ plain @ turn.T, atol=1e-12)

"""Ogden and Roxburgh's softening at a material point."""

import numpy as np
import pytest
from scipy.special import erf

from solve.materials.inelastic import StressResponse
from solve.materials.mullins import Softening
from tests.cases import for_each

STIFFNESS = 3.0
LAW = Softening(0.4, 0.01, 0.2)


def cycle(law, strains):
    """Stress (t,) and energy (t,) along strains of a uniaxial spring S0 = k e, W = k e^2 / 2."""
    memory, stress, energy = law.start(1), [], []
    for e in strains:
        s, w = np.zeros((1, 6)), np.array([0.5 * STIFFNESS * e**2])
        s[0, 0] = STIFFNESS * e
        response, memory = law.update(StressResponse(s, STIFFNESS * np.eye(6)[None], w), memory, 0.1)
        stress.append(response.stress[0, 0])
        energy.append(w[0])
    return np.array(stress), np.array(energy)


def test_the_first_loading_is_the_elastic_one():
    strains = np.linspace(0.0, 0.5, 6)
    assert np.array_equal(cycle(LAW, strains)[0], STIFFNESS * strains)


def test_unloading_follows_the_error_function():
    strains = np.array([0.5, 0.4, 0.2, 0.1])
    stress, energy = cycle(LAW, strains)
    eta = 1.0 - 0.4 * erf((energy[0] - energy) / (0.01 + 0.2 * energy[0]))
    np.testing.assert_allclose(stress, eta * STIFFNESS * strains, rtol=1e-14)
    assert (eta[1:] < 1.0).all()


def test_reloading_retraces_the_unloading_and_joins_the_first_curve_where_it_was_left():
    down = np.linspace(0.5, 0.1, 9)
    stress, _ = cycle(LAW, np.concatenate([down, down[::-1], [0.6]]))
    np.testing.assert_allclose(stress[9:18], stress[8::-1], rtol=1e-14)
    assert stress[17] == STIFFNESS * 0.5
    assert stress[18] == STIFFNESS * 0.6


def test_the_work_lost_in_a_cycle_is_that_of_the_law():
    """int (1 - eta) dW from 0 to W_max = loss [x erf x + (exp(-x^2) - 1) / sqrt(pi)] width, x = W_max / width."""
    strains = np.concatenate([np.linspace(0.0, 0.5, 4001), np.linspace(0.5, 0.0, 4001)])
    stress, energy = cycle(LAW, strains)
    work = np.sum(0.5 * (stress[1:] + stress[:-1]) * np.diff(strains))
    width = 0.01 + 0.2 * energy.max()
    x = energy.max() / width
    lost = 0.4 * width * (x * erf(x) + (np.exp(-(x**2)) - 1.0) / np.sqrt(np.pi))
    assert work == pytest.approx(lost, rel=1e-6)


def test_no_loss_is_elastic():
    strains = np.array([0.1, 0.5, 0.3, 0.0])
    assert np.array_equal(cycle(Softening(0.0), strains)[0], STIFFNESS * strains)


@for_each("energy", [-5e-17, 0.0, 2e-16])
@for_each("largest", [0.0, 1e-16])
def test_rounding_of_the_energy_at_rest_softens_nothing(energy, largest):
    elastic = StressResponse(np.zeros((1, 6)), STIFFNESS * np.eye(6)[None], np.array([energy]))
    softened, _ = Softening(0.4, 0.0, 0.2).update(elastic, (np.array([largest]),), 0.1)
    np.testing.assert_allclose(softened.tangent, elastic.tangent, rtol=0.01)


def test_the_tangent_below_the_largest_energy_is_consistent():
    law, stiffness = Softening(0.3, 0.02, 0.3), np.diag(np.arange(1.0, 7.0))

    def response(strain):
        energy = 0.5 * np.array([strain @ stiffness @ strain])
        return law.update(StressResponse((strain @ stiffness)[None], stiffness[None], energy), (np.array([0.5]),), 1.0)[
            0
        ]

    strain, change = np.linspace(0.05, 0.2, 6), 1e-6
    slope = [(response(strain + change * e).stress - response(strain - change * e).stress)[0] for e in np.eye(6)]
    np.testing.assert_allclose(response(strain).tangent[0], np.stack(slope, axis=1) / (2.0 * change), atol=1e-7)
    assert response(strain).energy[0] < 0.5

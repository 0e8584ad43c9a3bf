"""What cannot be told apart, on subspaces whose angles are known."""

import numpy as np
import pytest
from scipy.linalg import subspace_angles
from scipy.stats import norm

from diagnose.statistics.nuisance_projection import Marginal
from diagnose.statistics.separation import least_separation
from tests.diagnose.statistics.rejections import is_fair

E = np.eye(8)


def test_nuisances_can_make_two_mechanisms_alike():
    """They differ only along a nuisance that may float."""
    first, second = E[:, [0]] + E[:, [5]], E[:, [0]] - E[:, [5]]
    assert subspace_angles(first, second)[0] == pytest.approx(np.pi / 2.0)
    marginal = Marginal(E[:, [5]], np.array([np.inf]))
    assert subspace_angles(marginal(first), marginal(second))[0] == pytest.approx(0.0, abs=1e-7)


def test_two_predictions_at_the_least_separation_are_confused_as_often_as_stated():
    distance = least_separation(0.05)
    assert distance == pytest.approx(2.0 * norm.isf(0.05))
    noise = np.random.default_rng(91).standard_normal((400, 8))
    wrong = np.linalg.norm(noise - distance * E[0], axis=1) < np.linalg.norm(noise, axis=1)
    assert is_fair(int(wrong.sum()), 400, 0.05)

"""What cannot be told apart, on subspaces whose angles are known."""

import numpy as np
import pytest
from scipy.linalg import subspace_angles
from scipy.stats import norm

from diagnose.statistics.nuisance_projection import Marginal
from diagnose.statistics.separation import ambiguity_groups, distance_to_rival, least_separation, separations
from tests.diagnose.statistics.rejections import is_fair

E = np.eye(8)


def turned(angle):
    return np.cos(angle) * E[0] + np.sin(angle) * E[1]


def test_nuisances_can_make_two_mechanisms_alike():
    """They differ only along a nuisance that may float."""
    first, second = E[:, [0]] + E[:, [5]], E[:, [0]] - E[:, [5]]
    assert subspace_angles(first, second)[0] == pytest.approx(np.pi / 2.0)
    marginal = Marginal(E[:, [5]], np.array([np.inf]))
    assert subspace_angles(marginal(first), marginal(second))[0] == pytest.approx(0.0, abs=1e-7)


def test_the_distance_to_a_rival_is_length_times_sine():
    assert distance_to_rival(20.0 * turned(0.3), E[:, [0]]) == pytest.approx(20.0 * np.sin(0.3))
    assert distance_to_rival(20.0 * turned(0.3), E[:, [0, 1]]) == pytest.approx(0.0, abs=1e-12)


def test_the_easier_imitation_counts():
    """The wide mechanism can look like the narrow one, not the reverse."""
    found = separations([5.0 * E[0], 5.0 * E[0] + 5.0 * E[1]], [E[:, [0]], E[:, [0, 1]]])
    np.testing.assert_allclose(found, 0.0, atol=1e-12)
    assert distance_to_rival(5.0 * E[0] + 5.0 * E[1], E[:, [0]]) == pytest.approx(5.0)


def test_two_predictions_at_the_least_separation_are_confused_as_often_as_stated():
    distance = least_separation(0.05)
    assert distance == pytest.approx(2.0 * norm.isf(0.05))
    noise = np.random.default_rng(91).standard_normal((400, 8))
    wrong = np.linalg.norm(noise - distance * E[0], axis=1) < np.linalg.norm(noise, axis=1)
    assert is_fair(int(wrong.sum()), 400, 0.05)


def matrix(pairs, count, far=100.0):
    found = np.full((count, count), far)
    for (a, b), value in pairs.items():
        found[a, b] = found[b, a] = value
    np.fill_diagonal(found, 0.0)
    return found


def test_groups_are_the_blocks():
    found = ambiguity_groups(matrix({(0, 2): 0.5, (0, 4): 1.0, (2, 4): 1.5, (1, 3): 2.0}, 6), least=3.0, largest=3)
    assert found.groups == ((0, 2, 4), (1, 3), (5,))
    assert found.split == ()


def test_a_chain_is_no_group_and_its_broken_link_is_named():
    """0 is like 1 and 1 like 2, but 0 and 2 can be told apart."""
    found = ambiguity_groups(matrix({(0, 1): 1.0, (1, 2): 2.0}, 3), least=3.0, largest=3)
    assert found.groups == ((0, 1), (2,))
    assert found.split == ((1, 2),)


def test_groups_stay_within_their_size():
    found = ambiguity_groups(matrix({(a, b): 1.0 + a for a in range(4) for b in range(a)}, 4), least=9.0, largest=2)
    assert sorted(map(len, found.groups)) == [2, 2]
    assert len(found.split) == 4


def test_one_model_is_a_group_of_its_own():
    assert ambiguity_groups(np.zeros((1, 1)), 3.0, 3).groups == ((0,),)

"""Who can explain the excess."""

import numpy as np
import pytest

from diagnose.inference.localisation import shares_of_excess
from diagnose.statistics.component_shares import component_shares

RNG = np.random.default_rng(31)
BASIS, _ = np.linalg.qr(RNG.standard_normal((50, 6)))
EITHER, POSITIVE = np.array([False]), np.array([True])


def test_orthogonal_components_share_by_their_sums_of_squares():
    residual = 3.0 * BASIS[:, 0] + 4.0 * BASIS[:, 1]
    shares = component_shares(residual, [BASIS[:, [0]] * 1e-6, BASIS[:, [1]]], [POSITIVE, EITHER])
    np.testing.assert_allclose(shares, [9.0 / 25.0, 16.0 / 25.0])


def test_noise_is_no_excess_and_what_nobody_explains_is_left_over():
    residual = RNG.standard_normal(50) + 30.0 * BASIS[:, 0] + 30.0 * BASIS[:, 1]
    shares = component_shares(residual, [BASIS[:, [0]], BASIS[:, [2]]], [EITHER, EITHER])
    assert shares[0] == pytest.approx(0.5, abs=0.05)
    assert shares[1] < 0.02
    assert 1.0 - shares.sum() == pytest.approx(0.5, abs=0.05)


def test_components_that_look_alike_share_alike():
    residual = 5.0 * BASIS[:, 0]
    shares = component_shares(residual, [BASIS[:, [0]], 2.0 * BASIS[:, [0]], BASIS[:, [1]]], [POSITIVE] * 3)
    np.testing.assert_allclose(shares, [0.5, 0.5, 0.0], atol=1e-12)


def test_the_impossible_sign_explains_nothing():
    shares = component_shares(-5.0 * BASIS[:, 0], [BASIS[:, [0]], BASIS[:, [0]]], [POSITIVE, EITHER])
    np.testing.assert_allclose(shares, [0.0, 1.0], atol=1e-12)


def test_shares_are_never_negative_and_add_up_to_the_joint_fit():
    columns = [RNG.standard_normal((50, 2)) for _ in range(4)]
    residual = 4.0 * RNG.standard_normal(50)
    shares = component_shares(residual, columns, [np.array([False, False])] * 4)
    fit, *_ = np.linalg.lstsq(np.column_stack(columns), residual)
    explained = residual @ residual - np.sum((residual - np.column_stack(columns) @ fit) ** 2)
    assert np.all(shares >= 0.0)
    assert shares.sum() == pytest.approx(explained / (residual @ residual - 50.0))


def test_cells_share_what_is_above_their_degrees_of_freedom():
    shares = shares_of_excess(np.array([40.0, 10.0, 70.0]), np.array([10.0, 12.0, 60.0]))
    np.testing.assert_allclose(shares, [0.75, 0.0, 0.25])
    np.testing.assert_array_equal(shares_of_excess(np.ones(2), np.full(2, 3.0)), 0.0)


def test_too_many_components_are_refused():
    with pytest.raises(ValueError, match="at most 10"):
        component_shares(np.ones(50), [BASIS[:, [0]]] * 11, [EITHER] * 11)

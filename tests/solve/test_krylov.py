"""Flexible GMRES against dense solutions and SciPy's GMRES."""

import numpy as np
import pytest
from scipy.sparse.linalg import gmres

from solve.solution.krylov import flexible_gmres
from tests.cases import for_each

COUNT = 60
RNG = np.random.default_rng(3)
MATRIX = np.diag(np.linspace(1.0, 50.0, COUNT)) + RNG.normal(size=(COUNT, COUNT))
RHS = RNG.normal(size=COUNT)


def product(vector):
    return MATRIX @ vector


def by_the_diagonal(vector):
    return vector / np.diag(MATRIX)


@for_each("tolerance", [1e-3, 1e-8, 1e-13])
def test_the_residual_is_as_small_as_asked(tolerance):
    found = flexible_gmres(product, by_the_diagonal, RHS, tolerance, COUNT)
    assert np.linalg.norm(RHS - MATRIX @ found) <= 1.01 * tolerance * np.linalg.norm(RHS)


def test_a_preconditioner_in_single_precision_costs_no_digit():
    """The inverse, rounded to seven digits, is another preconditioner at every vector."""
    inverse = np.linalg.inv(MATRIX).astype(np.float32)
    found = flexible_gmres(product, lambda v: (inverse @ v.astype(np.float32)).astype(np.float64), RHS, 1e-13, 8)
    assert found == pytest.approx(np.linalg.solve(MATRIX, RHS), rel=1e-11)


def test_it_takes_no_more_preconditionings_than_iterations_of_scipy():
    """Right-preconditioned GMRES minimises the same residual over the same space."""
    counted, theirs = [], []
    flexible_gmres(product, lambda v: counted.append(1) or by_the_diagonal(v), RHS, 1e-6, COUNT)
    columns = MATRIX / np.diag(MATRIX)
    gmres(columns, RHS, rtol=1e-6, restart=COUNT, callback=theirs.append, callback_type="pr_norm")
    assert len(counted) <= len(theirs)


def test_overflow_is_told_by_nan_and_a_zero_right_hand_side_has_no_solution_to_seek():
    assert np.isnan(flexible_gmres(lambda v: np.inf * v, by_the_diagonal, RHS, 1e-3, 5)).all()
    assert not flexible_gmres(product, by_the_diagonal, np.zeros(COUNT), 1e-3, 5).any()

"""A factorisation with constraints closed serves a matrix in which some of them are open."""

import numpy as np
import pytest
import scipy.sparse as sp

from solve.fem.sparsity import Tangent
from solve.solution.factorisation import Pardiso, SuperLU
from solve.solution.preconditioner import Preconditioner

BODY, HELD = 120, 16


@pytest.fixture
def closed():
    """A body with all constraints closed: full matrix."""
    rng = np.random.default_rng(3)
    stiffness = sp.random(BODY, BODY, 0.05, random_state=rng).toarray()
    constraint = sp.random(HELD, BODY, 0.2, random_state=rng).toarray()
    full = np.zeros((BODY + HELD, BODY + HELD))
    full[:BODY, :BODY] = stiffness @ stiffness.T + np.eye(BODY)
    full[BODY:, :BODY], full[:BODY, BODY:] = constraint, constraint.T
    return full


def opened(full, rows):
    """The same with some constraints open: minus one on the diagonal and nothing else."""
    full = full.copy()
    full[rows], full[:, rows] = 0.0, 0.0
    full[rows, rows] = -1.0
    return full


def tangent(full):
    pattern = np.abs(full) + np.eye(len(full)) > 0.0
    row, column = np.nonzero(np.triu(pattern))
    upper = sp.csr_matrix((full[row, column], (row, column)), full.shape)
    upper.sort_indices()
    return Tangent(upper)


@pytest.mark.parametrize(("kind", "digits"), [(SuperLU, 9), (Pardiso, 3)])
def test_released_constraints_are_as_if_they_had_never_been_held(closed, kind, digits):
    rows = BODY + np.array([1, 4, 5, 11])
    inverse = Preconditioner(kind(), np.arange(BODY, BODY + HELD))
    inverse.factorise(tangent(closed), np.full(len(closed), 1e-12) * (np.arange(len(closed)) >= BODY))
    rhs = np.random.default_rng(1).standard_normal(len(closed))
    for some in (rows, rows[:2], rows[1:], rows[:0]):
        now = opened(closed, some)
        assert inverse.changed(tangent(now)) == (0, len(some))
        inverse.adapt(tangent(now))
        wanted = np.linalg.solve(now, rhs)
        np.testing.assert_allclose(inverse(rhs), wanted, atol=10.0**-digits * np.abs(wanted).max())
    assert inverse.back_substitutions == 4
    inverse.direct.free()


def test_a_constraint_that_closed_since_is_counted(closed):
    inverse = Preconditioner(SuperLU(), np.arange(BODY, BODY + HELD))
    inverse.factorise(tangent(opened(closed, BODY + np.array([2, 3]))), np.zeros(len(closed)))
    assert inverse.changed(tangent(opened(closed, BODY + np.array([3, 7])))) == (1, 1)

"""A factorisation serves a matrix in which other constraints are open."""

import numpy as np
import pytest
import scipy.sparse as sp

from solve.fem.tangent import Tangent
from solve.solution.factorisation import Pardiso, SuperLU
from solve.solution.preconditioner import Preconditioner
from tests.cases import for_each

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
    return tangent_on(full, full)


def tangent_on(largest, full):
    """On the pattern of another matrix."""
    pattern = np.abs(largest) + np.eye(len(full)) > 0.0
    row, column = np.nonzero(np.triu(pattern))
    upper = sp.csr_matrix((full[row, column], (row, column)), full.shape)
    upper.sort_indices()
    return Tangent(upper)


@for_each(("kind", "digits"), [(SuperLU, 9), (Pardiso, 3)])
def test_released_constraints_are_as_if_they_had_never_been_held(closed, kind, digits):
    rows = BODY + np.array([1, 4, 5, 11])
    inverse = Preconditioner(kind(), np.arange(BODY, BODY + HELD))
    inverse.factorise(tangent(closed), np.full(len(closed), 1e-12) * (np.arange(len(closed)) >= BODY))
    rhs = np.random.default_rng(1).standard_normal(len(closed))
    for some in (rows, rows[:2], rows[1:], rows[:0]):
        now = opened(closed, some)
        assert inverse.changed_constraints(tangent(now)) == len(some)
        inverse.adapt(tangent(now))
        wanted = np.linalg.solve(now, rhs)
        np.testing.assert_allclose(inverse(rhs), wanted, atol=10.0**-digits * np.abs(wanted).max())
    assert inverse.back_substitutions == 4
    inverse.direct.free()


@for_each(("kind", "digits"), [(SuperLU, 9), (Pardiso, 3)])
def test_constraints_that_close_are_as_if_they_had_always_been_held(closed, kind, digits):
    """Some close, some open, and some do so again; a gap is scaled otherwise than a pressure."""
    scale = np.where(np.arange(len(closed)) < BODY, 1.0, 1e-4)
    closed = scale[:, None] * closed * scale
    some, others = BODY + np.array([1, 4, 5]), BODY + np.array([2, 11])
    inverse = Preconditioner(kind(), np.arange(BODY, BODY + HELD))
    inverse.factorise(tangent_on(closed, opened(closed, some)), np.zeros(len(closed)))
    rhs = np.random.default_rng(1).standard_normal(len(closed))
    for now_open in (some[:0], others, some[1:], np.append(some[:2], others), some):
        now = opened(closed, now_open)
        assert inverse.changed_constraints(tangent_on(closed, now)) == len(set(some) ^ set(now_open))
        inverse.adapt(tangent_on(closed, now))
        wanted = np.linalg.solve(now, rhs)
        for part in (slice(BODY), slice(BODY, None)):
            largest = np.abs(wanted[part]).max()
            np.testing.assert_allclose(inverse(rhs)[part], wanted[part], atol=10.0**-digits * largest)
    inverse.direct.free()

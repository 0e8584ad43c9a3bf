"""The linear solver: right answers, and never a wrong one without notice."""

import warnings

import numpy as np
import pytest
import scipy.sparse as sp

import solve.solution.linear
from solve.fem.tangent import Tangent
from solve.solution.factorisation import Pardiso, PivotingPardiso, SinglePardiso, SuperLU
from solve.solution.linear import LinearSolveError, LinearSolver
from tests.cases import for_each

TOLERANCE = 1e-10


@pytest.fixture
def saddle():
    """A symmetric indefinite matrix with a zero block, as contact makes it: (upper triangle, right-hand side)."""
    rng = np.random.default_rng(0)
    n, m = 200, 20
    stiffness = sp.random(n, n, 0.02, random_state=rng)
    stiffness = stiffness @ stiffness.T + sp.identity(n)
    constraint = sp.random(m, n, 0.1, random_state=rng)
    full = sp.bmat([[stiffness, constraint.T], [constraint, sp.csr_matrix((m, m))]])
    upper = sp.triu(full + 1e-300 * sp.identity(n + m), format="csr")  # every diagonal entry is stored
    upper.sort_indices()
    return upper, rng.standard_normal(n + m)


def shift(upper, contact_rows=20):
    """What the solver adds to the contact rows of the matrix that it factorises."""
    value = np.zeros(upper.shape[0])
    value[-contact_rows:] = -1e-4
    return value


@for_each(
    "registry",
    [[SinglePardiso], [Pardiso], [PivotingPardiso], [SuperLU]],
    ids=["single", "pardiso", "pivoting", "superlu"],
)
def test_saddle_point_system(saddle, registry):
    upper, rhs = saddle
    solver = LinearSolver(shift(upper))
    solver._registry = list(registry)
    full = (upper + sp.triu(upper, 1).T).toarray()
    np.testing.assert_allclose(solver.solve(Tangent(upper), rhs, TOLERANCE), np.linalg.solve(full, rhs), rtol=1e-6)
    solver.close()


def test_a_matrix_beyond_single_precision_is_solved_in_double_without_a_warning(saddle):
    upper, rhs = saddle
    solver = LinearSolver(1e60 * shift(upper))
    full = (upper + sp.triu(upper, 1).T).toarray()
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always")  # as a user has it: here a RuntimeWarning is an error
        solution = solver.solve(Tangent(1e60 * upper), rhs, TOLERANCE)
    np.testing.assert_allclose(1e60 * solution, np.linalg.solve(full, rhs), rtol=1e-6)
    assert solver.name == "pardiso"
    assert not warned
    solver.close()


@for_each(
    "registry",
    [[SinglePardiso], [Pardiso], [PivotingPardiso], [SuperLU]],
    ids=["single", "pardiso", "pivoting", "superlu"],
)
def test_unsymmetric_system(saddle, registry):
    upper, rhs = saddle
    excess = sp.triu(upper, 1, format="csr") * 0.3
    tangent = Tangent(upper, sp.csr_matrix((padded(excess, upper), upper.indices, upper.indptr), upper.shape))
    full = (upper + 1.3 * sp.triu(upper, 1).T).toarray()
    np.testing.assert_allclose(tangent @ rhs, full @ rhs, atol=1e-12)
    np.testing.assert_allclose(tangent.full().toarray(), full, atol=1e-12)
    solver = LinearSolver(shift(upper))
    solver._registry = list(registry)
    np.testing.assert_allclose(solver.solve(tangent, rhs, TOLERANCE), np.linalg.solve(full, rhs), rtol=1e-6)
    solver.close()


def padded(strict, upper):
    """Values of a strict triangle on the pattern that has the diagonal too."""
    rows = np.repeat(np.arange(upper.shape[0]), np.diff(upper.indptr))
    return np.asarray(strict[rows, upper.indices]).ravel()


def test_product_with_the_upper_triangle(saddle):
    upper, rhs = saddle
    full = (upper + sp.triu(upper, 1).T).toarray()
    np.testing.assert_allclose(Tangent(upper) @ (rhs), full @ rhs, atol=1e-12)


class Wrong(SuperLU):
    """Gives a wrong answer without an error, as PARDISO can on a weak diagonal."""

    name = "wrong"

    def back_substitute(self, rhs):
        return 1e30 * rhs[::-1]


class Absent(SuperLU):
    """A library that is not installed."""

    name = "absent"

    def __init__(self):
        raise ImportError("no MKL here")


@for_each("bad", [Wrong, Absent])
def test_a_bad_factorisation_is_noticed_and_replaced(saddle, bad):
    upper, rhs = saddle
    solver = LinearSolver(shift(upper))
    solver._registry = [bad, SuperLU]
    solution = solver.solve(Tangent(upper), rhs, TOLERANCE)
    assert np.linalg.norm(rhs - Tangent(upper) @ (solution)) <= TOLERANCE * np.linalg.norm(rhs)
    assert solver.name == "superlu"


def test_a_singular_matrix_is_refused(saddle):
    upper, rhs = saddle
    singular = upper.copy()
    singular.data[:] = 0.0
    solver = LinearSolver(np.zeros(len(rhs)))
    with pytest.raises(LinearSolveError, match=r"pardiso.*superlu"):
        solver.solve(Tangent(singular), rhs, TOLERANCE)


def test_an_old_factorisation_serves_a_similar_matrix(saddle, monkeypatch):
    upper, rhs = saddle
    solver = LinearSolver(shift(upper))
    solver.solve(Tangent(upper), rhs, TOLERANCE)
    monkeypatch.setattr(LinearSolver, "_factorise", lambda *_: pytest.fail("factorised again"))
    similar = upper.copy()
    similar.data *= 1.0 + 1e-3 * np.sin(np.arange(len(upper.data)))
    solution = solver.solve(Tangent(similar), rhs, 1e-6, similar=True)
    assert np.linalg.norm(rhs - Tangent(similar) @ (solution)) <= 1e-6 * np.linalg.norm(rhs)
    assert solve.solution.linear.KRYLOV_ITERATIONS < 20


@pytest.fixture
def stiff_on_soft():
    """A stiff chain glued to a soft one, 1e7 times softer, as a film on a foam: (upper triangle, right-hand side).

    The load pulls on both so that the stiff chain moves as a rigid body, in which its forces cancel.
    """
    n = 60
    springs = np.concatenate([np.full(n, 1e7), np.ones(n)])
    diagonal = springs + np.append(springs[1:], 1.0)
    upper = sp.diags_array([diagonal, -springs[1:]], offsets=[0, 1], format="csr")
    upper = sp.csr_matrix(upper)
    upper[0, 0] -= springs[0]  # free at the stiff end, held at the soft one
    upper.sort_indices()
    return upper, np.full(2 * n, 1.0)


@for_each(
    "registry",
    [[SinglePardiso], [Pardiso], [PivotingPardiso], [SuperLU]],
    ids=["single", "pardiso", "pivoting", "superlu"],
)
def test_bad_scaling_is_no_failure(stiff_on_soft, registry):
    """Rounding of the stiff chain's forces alone leaves more than 1e-8 of the load, in the right solution too."""
    upper, rhs = stiff_on_soft
    solver = LinearSolver(np.zeros(len(rhs)))
    solver._registry = list(registry)
    solution = solver.solve_to_round_off(Tangent(upper), rhs)
    full = (upper + sp.triu(upper, 1).T).toarray()
    size = np.abs(full) @ np.abs(solution) + np.abs(rhs)
    assert np.max(np.abs(rhs - full @ solution) / size) < 1e-12
    assert np.linalg.norm(rhs - full @ solution) > 1e-8 * np.linalg.norm(rhs)
    through = np.arange(1, len(rhs) + 1) / np.append(np.full(59, 1e7), np.ones(61))  # stretch of each spring
    np.testing.assert_allclose(solution, np.cumsum(through[::-1])[::-1], rtol=1e-5)


def test_one_wrong_answer_does_not_dismiss_a_solver(saddle):
    """A solver that failed on one matrix is asked first for the next one; after two in a row it rests, then returns."""
    upper, rhs = saddle

    class Moody(SuperLU):
        name = "moody"
        wrong = True
        asked = 0

        def factorise(self, tangent):
            Moody.asked += 1
            super().factorise(tangent)

        def back_substitute(self, rhs):
            return 1e30 * rhs[::-1] if self.wrong else super().back_substitute(rhs)

    def used():
        solver.solve(Tangent(upper), rhs, TOLERANCE)
        return solver.name

    solver = LinearSolver(shift(upper))
    solver._registry = [Moody, SuperLU]
    assert used() == "superlu"
    Moody.wrong = False
    assert used() == "moody"
    Moody.wrong, Moody.asked = True, 0
    assert {used() for _ in range(40)} == {"superlu"}
    assert Moody.asked < 8
    Moody.wrong = False
    assert "moody" in {used() for _ in range(64)}
    assert used() == "moody"


def test_size_of_an_unsymmetric_tangent(saddle):
    upper, _ = saddle
    excess = sp.triu(upper, 1, format="csr") * -1.7
    tangent = Tangent(upper, sp.csr_matrix((padded(excess, upper), upper.indices, upper.indptr), upper.shape))
    np.testing.assert_allclose(tangent.absolute().full().toarray(), np.abs(tangent.full().toarray()), atol=1e-12)

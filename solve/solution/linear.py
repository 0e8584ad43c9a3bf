"""Solution of the indefinite tangent, with a residual check after every solve.

A factorisation whose answer is wrong is replaced by the next one of solve.solution.factorisation: PARDISO in single and
in double precision, PARDISO with stronger pivoting, SuperLU. Each is asked again later, so that one bad matrix does not
slow down all that follow.
Two measures: Newton's method asks for a relative residual |r| / |b|, which its next iteration mends anyway. Where
nothing comes after, as in derivatives, that measure is no good: with a film a million times stiffer than its medium
rounding alone leaves a |r| / |b| of 1e-7 of a right solution, while 1e-9 may hide an error of 3 % in the soft part. The
measure there is the componentwise backward error, max |r|_i / (|A| |x| + |b|)_i (Oettli and Prager, Numer. Math. 6,
1964), brought to round-off by iterative refinement (Arioli, Demmel and Duff, SIAM J. Matrix Anal. Appl. 10, 1989;
Higham, Accuracy and Stability of Numerical Algorithms, 2002, ch. 12).
The contact rows have a zero diagonal, which costs pivots; the matrix that is factorised carries a small negative one
instead, and GMRES preconditioned by it solves the true system in a few back substitutions (Saad, Iterative Methods
for Sparse Linear Systems, 2003, ch. 9). A factorisation costs tens of them, so one of an earlier Newton step is used
again where the tangent has changed little; constraints that have opened or closed since are changed in it too
(solve.solution.preconditioner).
"""

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from foundation.arrays import Floats
from solve.fem.tangent import Tangent
from solve.solution.factorisation import Factorisation, Pardiso, PivotingPardiso, SinglePardiso, SuperLU
from solve.solution.krylov import flexible_gmres
from solve.solution.preconditioner import Preconditioner

KRYLOV_ITERATIONS = 18  # with a factorisation of the same matrix
REFINEMENTS = 5  # as LAPACK's xSYRFS; each must at least halve the error
REFINED_ERROR, ACCEPTED_ERROR = 1e-12, 1e-10
"""Backward errors: refinement goes on down to the first, the second will do."""
WEAK_SHIFT = 1e-4  # of Newton's: many right-hand sides share the factorisation, and each then takes fewer iterations
EXACT_RESIDUAL = 1e-8  # relative residual: far below what a Newton step is off by itself
LONGEST_REST = 64  # solutions
REFINEMENT_SAFETY, LEAST_REFINEMENT_GAIN = 0.3, 0.1
"""Factor by which a refinement is to gain more than is wanted; and the least that it gains, a digit."""
EASY_BACK_SUBSTITUTIONS = 4  # back substitutions of a solution that the factorisation fits well
BACK_SUBSTITUTIONS_A_STATE = 2.0  # that has changed since, of an unsymmetric tangent
BACK_SUBSTITUTIONS_A_CONSTRAINT = 0.25  # that has closed or opened since, of a symmetric one
EVENS_OUT = 15_000, 14.0, 2.0 / 3.0  # unknowns, back substitutions that cost as much as a factorisation, exponent


class LinearSolveError(RuntimeError):
    """No solver gave a solution with a small residual: the tangent is singular."""


class LinearSolver:
    """Solves with the first factorisation of the registry that passes the residual check.

    shift : (count,) added to the diagonal of what is factorised, not of what is solved.
    """

    def __init__(self, shift: Floats) -> None:
        self._shift = shift
        self._multipliers = np.flatnonzero(shift)
        self._registry: list[type[Factorisation]] = [SinglePardiso, Pardiso, PivotingPardiso, SuperLU]
        self._current: Preconditioner | None = None
        self._excess = 0  # back substitutions since the factorisation that one of the same tangent would have saved
        self._failures: Counter[str] = Counter()  # one after the other
        self._rest: Counter[str] = Counter()  # solutions for which each is not asked
        self.name = self._registry[0].name
        """Name of the factorisation used last."""
        self.exact = False
        """Whether every tangent is factorised, and its system solved to EXACT_RESIDUAL: where inexact steps have
        failed, the equilibrium that is met must not depend on them."""

    def solve(self, tangent: Tangent, rhs: Floats, tolerance: float, similar: bool = False) -> Floats:
        """Solve A x = rhs to a relative residual.

        similar : the tangent has changed little since the last factorisation.
        LinearSolveError when every factorisation fails.
        """
        wanted = min(tolerance, EXACT_RESIDUAL) if self.exact else tolerance
        return self._solve(tangent, rhs, similar, _Goal(_relative_residual, wanted, wanted, tolerance, 1.0, 0))

    def solve_to_round_off(self, tangent: Tangent, rhs: Floats, similar: bool = False) -> Floats:
        """Solve A x = rhs by iterative refinement until x is exact for coefficients that differ by round-off.

        similar : the tangent is that of the last such solution. LinearSolveError when every factorisation fails.
        """
        goal = _Goal(_backward_error, 1e-8, REFINED_ERROR, ACCEPTED_ERROR, WEAK_SHIFT, REFINEMENTS)
        return self._solve(tangent, rhs, similar, goal) if rhs.any() else np.zeros_like(rhs)

    def _solve(self, tangent: Tangent, rhs: Floats, similar: bool, goal: "_Goal") -> Floats:
        """Solve with the last factorisation where that will do, else with the first of the registry that does."""
        reason = ""
        if similar and self._current is not None:
            try:
                solution, error = self._solve_with_last(tangent, rhs, goal)
            except Exception:  # PARDISO finds a zero pivot in a back substitution too
                self.close()
            else:
                if error <= goal.accepted:
                    return solution
        asked = self._solvers_to_try()
        for kind in asked:
            try:
                self._factorise(tangent, kind, goal.shift)
                solution, error = self._refine(tangent, rhs, KRYLOV_ITERATIONS, goal, REFINEMENTS)
            except Exception as failure:  # MKL absent, zero pivot, out of memory: the next one may do
                reason = str(failure)
                self.close()
            else:
                if error <= goal.accepted:
                    self._remember_success(kind, asked)
                    return solution
                reason = f"{goal.measure.__name__.strip('_').replace('_', ' ')} {error:.1e}"
        raise LinearSolveError(f"{', '.join(kind.name for kind in asked)}: {reason}")

    def _solve_with_last(self, tangent: Tangent, rhs: Floats, goal: "_Goal") -> tuple[Floats, float]:
        """Solve with the last factorisation; the solution and its error."""
        assert self._current is not None
        before = self._current.back_substitutions
        self._current.adapt(tangent)
        solution, error = self._refine(tangent, rhs, self._patience, goal, goal.similar_refinements)
        self._excess += max(self._current.back_substitutions - before - EASY_BACK_SUBSTITUTIONS, 0)
        return solution, error

    def _solvers_to_try(self) -> list[type[Factorisation]]:
        """Factorisations of the registry without those that rest, but for the last one, which always answers."""
        awake = [kind for kind in self._registry if not self._rest[kind.name]]
        self._rest -= Counter(self._rest.keys())
        return awake or self._registry[-1:]

    def _remember_success(self, kind: type[Factorisation], asked: list[type[Factorisation]]) -> None:
        """Let those that failed on a matrix rest, which this one solved: from the second time on for 2, 6, 14 ...
        solutions, then they are asked again.
        """
        self._failures[kind.name] = 0
        for failed in asked[: asked.index(kind)]:
            self._failures[failed.name] += 1
            self._rest[failed.name] = min(2 ** self._failures[failed.name] - 2, LONGEST_REST)
        self.name = kind.name

    def may_reuse(self, tangent: Tangent, changed: int | None) -> bool:
        """Whether the last factorisation is worth trying for a tangent.

        changed : number of discrete states that differ from those of the last solution, None after another load; of a
        symmetric tangent the constraints that differ from the factorised ones tell more.
        """
        if self.exact or self._current is None or self._excess > 2 * self._patience:
            return False
        if tangent.excess is not None:
            return changed is not None and BACK_SUBSTITUTIONS_A_STATE * changed <= self._patience // 2
        return BACK_SUBSTITUTIONS_A_CONSTRAINT * self._current.changed_constraints(tangent) <= self._patience

    @property
    def _patience(self) -> int:
        """Back substitutions that cost half a factorisation: more would be wasted if they fail (ski rental)."""
        unknowns, worth, exponent = EVENS_OUT
        return int(0.5 * worth * max(1.0, len(self._shift) / unknowns) ** exponent)

    def close(self) -> None:
        """Give the memory of the factorisation back."""
        if self._current is not None:
            self._current.direct.free()
        self._current = None

    def _factorise(self, tangent: Tangent, kind: type[Factorisation], shift: float) -> None:
        """Factorise the tangent with a share of the shift."""
        if self._current is None or type(self._current.direct) is not kind:
            self.close()
            self._current = Preconditioner(kind(), self._multipliers)
        self._current.factorise(tangent, shift * self._shift)
        self._excess = 0

    def _refine(
        self, tangent: Tangent, rhs: Floats, iterations: int, goal: "_Goal", refinements: int
    ) -> tuple[Floats, float]:
        """Solve by GMRES, then again for what is left of the right-hand side while that at least halves the error."""
        solution = self._solve_by_gmres(tangent, rhs, goal.krylov, iterations)
        residual = rhs - tangent @ solution
        error = goal.measure(tangent, rhs, solution, residual)
        for _ in range(refinements):
            if error <= goal.refined or not np.isfinite(error):
                break
            wanted = max(goal.krylov, min(REFINEMENT_SAFETY * goal.refined / error, LEAST_REFINEMENT_GAIN))
            finer = solution + self._solve_by_gmres(tangent, residual, wanted, iterations)
            left = rhs - tangent @ finer
            less = goal.measure(tangent, rhs, finer, left)
            if not less < error:
                break
            enough, solution, residual, error = less > 0.5 * error, finer, left, less
            if enough:
                break
        return solution, error if np.isfinite(error) else np.inf

    def _solve_by_gmres(self, tangent: Tangent, rhs: Floats, tolerance: float, iterations: int) -> Floats:
        """Solve by GMRES, preconditioned from the right by the last factorisation."""
        assert self._current is not None
        return flexible_gmres(lambda v: tangent @ v, self._current, rhs, 0.9 * tolerance, iterations)


Measure = Callable[[Tangent, Floats, Floats, Floats], float]
"""Of a tangent, a right-hand side, a solution and its residual."""


@dataclass(frozen=True)
class _Goal:
    """Goal of a linear solution. krylov : relative residual of one run of GMRES; refined, accepted : by the measure,
    what ends the refinement and what will do. shift : share of the solver's. similar_refinements : with a factorisation
    of another tangent.
    """

    measure: Measure
    krylov: float
    refined: float
    accepted: float
    shift: float
    similar_refinements: int


def _relative_residual(_tangent: Tangent, rhs: Floats, _solution: Floats, residual: Floats) -> float:
    """Relative residual |r| / |b| of a solution."""
    return float(np.linalg.norm(residual)) / (float(np.linalg.norm(rhs)) or 1.0)


def _backward_error(tangent: Tangent, rhs: Floats, solution: Floats, residual: Floats) -> float:
    """Componentwise backward error of a solution; a row without anything in it is solved by anything."""
    size = tangent.absolute() @ np.abs(solution) + np.abs(rhs)
    rows = size > 0.0
    return float(np.max(np.abs(residual[rows]) / size[rows], initial=0.0))

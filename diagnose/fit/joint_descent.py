"""Mechanisms and nuisances fitted together: bounded Levenberg-Marquardt where both are far from linear.

The objective is the square of the residual, with discrepancies integrated out, plus that of the nuisances in units of
their priors. Variances and discrepancies stay those of the system from which it starts.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from diagnose.fit.descent import TIGHTEST, Place, bounded_step, bounds, descent, settings
from diagnose.fit.linearised_system import LinearisedSystem
from diagnose.fit.marginal_likelihood import Quadratic
from diagnose.fit.nuisances import Nuisance
from diagnose.fit.observed_model import ObservedModel
from diagnose.forward import Candidate
from foundation.arrays import Floats

JOINT_ITERATIONS = 30
JOINT_LEAST_GAIN = 0.01  # in half squares: less is no progress
JOINT_STILL = 0.05  # of a standard error: a step below it is none


@dataclass(frozen=True)
class Joint:
    """values : (q,) of the mechanisms. nuisances : (p,). cost : half the objective."""

    values: Floats
    nuisances: Floats
    cost: float


class _Problem:
    def __init__(self, model: ObservedModel, system: LinearisedSystem, candidates: Sequence[Candidate]) -> None:
        self.model, self.system, self.candidates = model, system, tuple(candidates)
        self.count = len(bounds(candidates))
        self.nuisance_design = Quadratic(
            system.weighted(system.nuisance_design[:, len(system.values) :]), system.sigma[len(system.values) :]
        )
        self.precision = np.concatenate([np.zeros(self.count), 1.0 / model.sigma**2])
        own = np.array([_limits(nuisance) for nuisance in model.nuisances]).reshape(-1, 2)
        self.limits = np.concatenate([bounds(candidates), own])

    def residual(self, point: Floats) -> tuple[Floats, float]:
        """Weighted (l,), and the cost; infinite where the model has no answer."""
        try:
            predicted = self.model.vector(point[self.count :], settings(self.candidates, point[: self.count]))
        except ValueError:
            return np.zeros(int(self.system.informative.sum())), np.inf
        left = self.system.weighted(self.model.samples.recorded - predicted)
        return left, 0.5 * self.nuisance_design.square(left) + 0.5 * float(self.precision @ point**2)

    def columns(self, point: Floats) -> Floats:
        """Weighted slopes (l, q + p)."""
        values, nuisances = point[: self.count], point[self.count :]
        on = settings(self.candidates, values)
        problem = descent(self.model, _at(self.system, nuisances), self.candidates, on)
        predicted = self.model.vector(nuisances, on)
        slopes = problem.slopes(Place(values, predicted, np.zeros(0), 0.0))
        return self.system.weighted(np.column_stack([slopes, self.model.tangents(nuisances, on)]))


def _at(system: LinearisedSystem, nuisances: Floats) -> LinearisedSystem:
    return replace(system, values=nuisances)


def _limits(nuisance: Nuisance) -> tuple[float, float]:
    if nuisance.candidate is None:
        return -np.inf, np.inf
    coordinate = nuisance.candidate.coordinates[nuisance.coordinate]
    return coordinate.low, coordinate.high


def fitted_jointly(
    model: ObservedModel, system: LinearisedSystem, candidates: Sequence[Candidate], start: Floats
) -> Joint:
    """From values (q,) and the system's own nuisances."""
    problem = _Problem(model, system, candidates)
    point = np.clip(np.concatenate([start, system.values]), *problem.limits.T)
    left, cost = problem.residual(point)
    damping = 1e-3
    for _ in range(JOINT_ITERATIONS if np.isfinite(cost) else 0):
        columns = problem.columns(point)
        cleared = problem.nuisance_design.cleared(columns)
        hessian = columns.T @ cleared + np.diag(problem.precision)
        gradient = cleared.T @ left - problem.precision * point
        gain, still = 0.0, False
        while damping < TIGHTEST and not still:
            step = bounded_step(hessian, gradient, damping, point, problem.limits)
            after, lower = problem.residual(point + step)
            gain, still = cost - lower, float(step @ hessian @ step) < JOINT_STILL**2
            if gain > 0.0:
                point, left, cost, damping = point + step, after, lower, damping / 10.0
                break
            damping = max(10.0 * damping, 1e-3)
        if gain < JOINT_LEAST_GAIN or still:
            break
    return Joint(point[: problem.count], point[problem.count :], cost)

"""Mechanisms and nuisances fitted together: bounded Levenberg-Marquardt where both are far from linear.

The objective is the square of the residual, with discrepancies integrated out, plus that of the nuisances in units of
their priors. Variances and discrepancies stay those of the system from which it starts.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from diagnose.fit.descent import Place, bounds, descent, settings
from diagnose.fit.levenberg_marquardt import Patience, minimised
from diagnose.fit.linearised_system import LinearisedSystem
from diagnose.fit.marginal_likelihood import Quadratic
from diagnose.fit.nuisances import Nuisance
from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.secant_slopes import SecantSlopes
from diagnose.forward import Candidate
from foundation.arrays import Floats

ITERATIONS, LEAST_GAIN, STILL = 30, 0.01, 0.05


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
            system.weighted_rows(system.nuisance_design[:, len(system.values) :]), system.sigma[len(system.values) :]
        )
        self.precision = np.concatenate([np.zeros(self.count), 1.0 / model.sigma**2])
        own = np.array([_limits(nuisance) for nuisance in model.nuisances]).reshape(-1, 2)
        self.limits = np.concatenate([bounds(candidates), own])
        self.slopes = SecantSlopes(self.differenced)

    def at(self, point: Floats) -> Place:
        """Residual and cost at a point (q + p,); the cost is infinite where the model has no answer."""
        try:
            predicted = self.model.vector(point[self.count :], settings(self.candidates, point[: self.count]))
        except ValueError:
            return Place(point, np.zeros(0), np.zeros(int(self.system.informative.sum())), np.inf)
        left = self.system.weighted_rows(self.model.samples.recorded_vector - predicted)
        cost = 0.5 * self.nuisance_design.square(left) + 0.5 * float(self.precision @ point**2)
        return Place(point, predicted, left, cost)

    def expansion(self, here: Place, anew: bool) -> tuple[Floats, Floats]:
        """Hessian (q + p, q + p) and downhill gradient of the cost. anew : see minimised."""
        columns = self.system.weighted_rows(self.slopes.at(here, anew))
        cleared = self.nuisance_design.apply_inverse(columns)
        gradient = cleared.T @ here.left - self.precision * here.values
        return columns.T @ cleared + np.diag(self.precision), gradient

    def differenced(self, here: Place) -> Floats:
        """Slopes (n, q + p) at a place."""
        values, nuisances = here.values[: self.count], here.values[self.count :]
        on = settings(self.candidates, values)
        problem = descent(self.model, _at(self.system, nuisances), self.candidates, on)
        slopes = problem.slopes(Place(values, here.predicted, np.zeros(0), 0.0))
        return np.column_stack([slopes, self.model.tangents(nuisances, on)])


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
    """Fit mechanisms and nuisances together, from values (q,) and the system's own nuisances."""
    problem = _Problem(model, system, candidates)
    start = np.concatenate([start, system.values])
    patience = Patience(ITERATIONS, LEAST_GAIN, STILL, 0.5 * max(float(system.informative.sum()), 1.0))
    found = minimised(problem.at, problem.expansion, start, problem.limits, patience)
    return Joint(found.values[: problem.count], found.values[problem.count :], found.cost)

"""Mechanisms fitted to all samples, with the nuisances and the model-form error renewed until they stand still."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from diagnose.fit import discrepancy
from diagnose.fit.descent import Place, descended, descent, settings
from diagnose.fit.discrepancy import FORM_ERROR
from diagnose.fit.joint_descent import fitted_jointly
from diagnose.fit.linearised_system import LinearisedSystem, linearised
from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.samples import Samples
from diagnose.forward import Candidate, Setting
from diagnose.statistics.error_rates import LARGEST_FORM_SHARE
from foundation.arrays import Floats

ROUNDS = 2
NEAR = 1.0  # standard deviations: variances stay so far
FORM_ERRORS = np.array([0.0, 0.125, 0.25, 0.5, 1.0])  # of the largest model-form error


@dataclass(frozen=True)
class Fitted:
    """candidates and their values (q,). system : linear about them. slopes : (n, q) change per unit of each value.

    largest_form_error : model-form error that is allowed. evidence : logarithm of the marginal likelihood at these
    values, but for a constant.
    """

    candidates: tuple[Candidate, ...]
    values: Floats
    system: LinearisedSystem
    slopes: Floats
    largest_form_error: float
    evidence: float

    @property
    def settings(self) -> tuple[Setting, ...]:
        """As the engine has them."""
        return settings(self.candidates, self.values)

    def nuisances(self, model: ObservedModel) -> Floats:
        """Those (p,) with which it comes closest to the recording, within what the engine has an answer to."""
        return model.answered(self.system.values, self.system.closest(), self.settings)


def common_metric(samples: Samples, baseline: LinearisedSystem) -> LinearisedSystem:
    """The baseline with one model-form error for all candidates, as if its residual were the effect."""
    excess = discrepancy.allowance(samples, baseline.residual, [1.0] * len(samples.channels))
    return replace(baseline, unit_form_variance=excess, form_error=FORM_ERROR)


def fitted(
    model: ObservedModel, system: LinearisedSystem, candidates: Sequence[Candidate], start: Floats, excess: float
) -> Fitted:
    """system : from where nuisances start, with the rows that are looked at. excess : see largest_form_error.

    The model-form error is the likeliest up to the largest.
    """
    values, nuisances = start, system.values
    for _ in range(ROUNDS):
        system = linearised(model, nuisances, settings(candidates, values), FORM_ERROR, system.informative)
        system = replace(system, form_error=largest_form_error(system, excess))
        found = fitted_jointly(model, system, candidates, values)
        change = model.vector(found.nuisances, settings(candidates, found.values)) - model.vector(
            nuisances, settings(candidates, values)
        )
        values, nuisances = found.values, found.nuisances
        if np.linalg.norm(system.weighted(change)) < NEAR:
            break
    system = linearised(model, nuisances, settings(candidates, values), FORM_ERROR, system.informative)
    largest = largest_form_error(system, excess)
    likeliest = max(largest * FORM_ERRORS, key=lambda error: _evidence(replace(system, form_error=error)))
    system = replace(system, form_error=likeliest)
    system, place, slopes = _moved(model, system, candidates, values)
    return Fitted(tuple(candidates), place.values, system, slopes, largest, _evidence(system))


def largest_form_error(system: LinearisedSystem, excess: float) -> float:
    """FORM_ERROR, or less where that would account for more than LARGEST_FORM_SHARE of the excess.

    excess : sum of squares above noise.
    """
    at_one = float((system.unit_form_variance / system.numerical)[system.informative].sum())
    if at_one <= 0.0:
        return FORM_ERROR
    return min(FORM_ERROR, float(np.sqrt(LARGEST_FORM_SHARE * max(excess, 0.0) / at_one)))


def _moved(
    model: ObservedModel, system: LinearisedSystem, candidates: Sequence[Candidate], values: Floats
) -> tuple[LinearisedSystem, Place, Floats]:
    """The best place in the metric of a system about values (q,); the system with the residual there; the slopes."""
    problem = descent(model, system, candidates, settings(candidates, values))
    place, slopes = descended(problem, values)
    change = place.predicted - problem.vector(values)
    return replace(system, residual=system.residual - change, effect=system.effect + change), place, slopes


def _evidence(system: LinearisedSystem) -> float:
    """Logarithm of the marginal likelihood, but for a constant."""
    square = system.quadratic.square(system.weighted(system.residual))
    return -0.5 * square - system.quadratic.log_scale + float(np.log(system.weight[system.informative]).sum())

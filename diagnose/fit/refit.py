"""Mechanisms fitted to all samples, with nuisances and model-form error renewed until neither changes."""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

from diagnose.fit import discrepancy
from diagnose.fit.descent import Place, descended, descent, settings
from diagnose.fit.discrepancy import FORM_ERROR
from diagnose.fit.joint_descent import fitted_jointly
from diagnose.fit.linearised_system import LinearisedSystem, linearise
from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.samples import Samples
from diagnose.forward import Candidate, NoAnswerError, Setting
from diagnose.statistics.error_rates import LARGEST_FORM_SHARE
from foundation.arrays import Floats

MAX_REFIT_ROUNDS = 2
NEAR_CHANGE_SIGMAS = 1.0  # of the whitened prediction: for a smaller change variances need not be renewed
START_SHARES = (1.0, 0.5, 0.25, 0.1, 0.01)  # of the values from which a fit is asked to start
FORM_ERROR_SHARES = np.array([0.0, 0.125, 0.25, 0.5, 1.0])  # of the largest model-form error


@dataclass(frozen=True)
class Fitted:
    """A fit of candidates with values (q,). system : linear about them. slopes : (n, q) change per unit of each value.

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
        """Candidates at their fitted values, as an engine takes them."""
        return settings(self.candidates, self.values)

    def closest_nuisances(self, model: ObservedModel) -> Floats:
        """Nuisances (p,) that come closest to the recording, within what the engine has an answer to."""
        return model.answerable_nuisances(self.system.values, self.system.closest_nuisances(), self.settings)


def common_metric(samples: Samples, baseline: LinearisedSystem) -> LinearisedSystem:
    """Baseline system with one model-form error for all candidates, as if its residual were the effect."""
    excess = discrepancy.rough_variance(samples, baseline.residual, [1.0] * len(samples.channels))
    return replace(baseline, unit_form_variance=excess, form_error=FORM_ERROR)


def fit_mechanisms(
    model: ObservedModel, system: LinearisedSystem, candidates: Sequence[Candidate], start: Floats, excess: float
) -> Fitted:
    """Fit candidates from values `start` (q,), with the model-form error the likeliest up to the largest.

    system : holds the nuisances to start from, and the rows that are looked at. excess : see largest_form_error. Where
    the model has no answer there the fit starts nearer to where they are off.
    """
    values, nuisances = _answerable_start(model, system.values, candidates, start)
    for _ in range(MAX_REFIT_ROUNDS):
        system = linearise(model, nuisances, settings(candidates, values), FORM_ERROR, system.informative)
        system = replace(system, form_error=largest_form_error(system, excess))
        found = fitted_jointly(model, system, candidates, values)
        if not np.isfinite(found.cost):
            break
        change = model.vector(found.nuisances, settings(candidates, found.values)) - model.vector(
            nuisances, settings(candidates, values)
        )
        values, nuisances = found.values, found.nuisances
        if np.linalg.norm(system.weighted_rows(change)) < NEAR_CHANGE_SIGMAS:
            break
    system = linearise(model, nuisances, settings(candidates, values), FORM_ERROR, system.informative)
    largest = largest_form_error(system, excess)
    likeliest = max(largest * FORM_ERROR_SHARES, key=lambda error: _log_evidence(replace(system, form_error=error)))
    system = replace(system, form_error=likeliest)
    system, place, slopes = _descend_in_metric(model, system, candidates, values)
    return Fitted(tuple(candidates), place.values, system, slopes, largest, _log_evidence(system))


def _answerable_start(
    model: ObservedModel, nuisances: Floats, candidates: Sequence[Candidate], start: Floats
) -> tuple[Floats, Floats]:
    """Values (q,) and nuisances (p,) to which the model has an answer, on the way from a start to where all is off."""
    for share in START_SHARES:
        with suppress(NoAnswerError):
            model.signals(nuisances, settings(candidates, share * start))
            return share * start, nuisances
    return 0.0 * start, model.answerable_nuisances(0.0 * nuisances, nuisances, ())


def largest_form_error(system: LinearisedSystem, excess: float) -> float:
    """Largest model-form error: FORM_ERROR, or less where that would explain too much of the excess.

    It may explain LARGEST_FORM_SHARE. excess : sum of squares above noise.
    """
    at_one = float((system.unit_form_variance / system.numerical)[system.informative].sum())
    if at_one <= 0.0:
        return FORM_ERROR
    return min(FORM_ERROR, float(np.sqrt(LARGEST_FORM_SHARE * max(excess, 0.0) / at_one)))


def _descend_in_metric(
    model: ObservedModel, system: LinearisedSystem, candidates: Sequence[Candidate], values: Floats
) -> tuple[LinearisedSystem, Place, Floats]:
    """Descend in the metric of a system about values (q,).

    Returns the system with the residual at the best place, that place, and the slopes (n, q) there.
    """
    problem = descent(model, system, candidates, settings(candidates, values))
    place, slopes = descended(problem, values)
    change = place.predicted - problem.vector(values)
    return replace(system, residual=system.residual - change, effect=system.effect + change), place, slopes


def _log_evidence(system: LinearisedSystem) -> float:
    """Logarithm of the marginal likelihood of a system, but for a constant."""
    square = system.quadratic.square(system.weighted_rows(system.residual))
    return -0.5 * square - system.quadratic.log_scale + float(np.log(system.weight[system.informative]).sum())

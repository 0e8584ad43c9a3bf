"""Mechanisms fitted to all samples, with the nuisances and the error of form renewed until they stand still."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from diagnose.fit import discrepancy
from diagnose.fit.descent import Place, descended, descent, fitted_jointly, settings
from diagnose.fit.discrepancy import FORM
from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.samples import Samples
from diagnose.fit.system import LinearisedSystem, linearised
from diagnose.forward import Candidate, Setting
from diagnose.statistics.abstain import LARGEST_FORM
from geometry.arrays import Floats

ROUNDS = 2
NEAR = 1.0  # standard deviations: variances stay so far
FORMS = np.array([0.0, 0.125, 0.25, 0.5, 1.0])  # of the largest error of form


@dataclass(frozen=True)
class Fitted:
    """candidates and their values (q,). system : linear about them. slopes : (n, q) change per unit of each value.

    largest_form : error of form that is allowed. evidence : logarithm of the marginal likelihood at these values, but
    for a constant.
    """

    candidates: tuple[Candidate, ...]
    values: Floats
    system: LinearisedSystem
    slopes: Floats
    largest_form: float
    evidence: float

    @property
    def settings(self) -> tuple[Setting, ...]:
        """As the engine has them."""
        return settings(self.candidates, self.values)


def common_metric(samples: Samples, baseline: LinearisedSystem) -> LinearisedSystem:
    """The baseline with the same variance for every candidate's error of form: as if its residual were the effect."""
    excess = discrepancy.allowance(samples, baseline.residual, [1.0] * len(samples.channels))
    return replace(baseline, formal=excess, form=FORM)


def fitted(
    model: ObservedModel, system: LinearisedSystem, candidates: Sequence[Candidate], start: Floats, excess: float
) -> Fitted:
    """system : from where nuisances start, with the rows that are looked at. excess : see largest_form.

    The error of form is the likeliest up to the largest.
    """
    values, nuisances = start, system.values
    for _ in range(ROUNDS):
        system = linearised(model, nuisances, settings(candidates, values), FORM, system.informative)
        system = replace(system, form=largest_form(system, excess))
        found = fitted_jointly(model, system, candidates, values)
        change = model.vector(found.nuisances, settings(candidates, found.values)) - model.vector(
            nuisances, settings(candidates, values)
        )
        values, nuisances = found.values, found.nuisances
        if np.linalg.norm(system.weighted(change)) < NEAR:
            break
    system = linearised(model, nuisances, settings(candidates, values), FORM, system.informative)
    largest = largest_form(system, excess)
    system = replace(system, form=max(largest * FORMS, key=lambda form: _evidence(replace(system, form=form))))
    system, place, slopes = _moved(model, system, candidates, values)
    return Fitted(tuple(candidates), place.values, system, slopes, largest, _evidence(system))


def largest_form(system: LinearisedSystem, excess: float) -> float:
    """FORM, or less where that would excuse more than LARGEST_FORM of the excess (a sum of squares above noise)."""
    nuisance_design = float((system.formal / system.numerical)[system.informative].sum())
    return (
        min(FORM, float(np.sqrt(LARGEST_FORM * max(excess, 0.0) / nuisance_design))) if nuisance_design > 0.0 else FORM
    )


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

"""Mechanisms fitted to all samples, with the nuisances and the model-form error renewed until they stand still.

The baseline, fitted fairly: nuisances alone, under their priors, from several starts.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from diagnose.fit import discrepancy
from diagnose.fit.descent import Place, descended, descent, fitted_jointly, settings
from diagnose.fit.discrepancy import FORM_ERROR
from diagnose.fit.observed_model import Nuisance, ObservedModel, late
from diagnose.fit.samples import Samples
from diagnose.fit.system import LinearisedSystem, Quadratic, linearised
from diagnose.forward import Candidate, Setting
from diagnose.statistics.abstain import LARGEST_FORM_SHARE
from geometry.arrays import Bools, Floats

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


BASELINE_ROUNDS = 12
CLOSE = 0.01  # of a posterior standard deviation: another step is not worth it
LAGS = 41  # over three deviations either way
HALVINGS = 5
PLAUSIBLE = 2.0  # deviations of a prior
CAP = 4.0  # the same: what an explanation may not pull a nuisance beyond


def fitted_baseline(model: ObservedModel) -> LinearisedSystem:
    """Linear about the best nuisances that were found from 0, from aligned lags and from the starts of free ones."""
    systems = [_descended(model, start) for start in _starts(model)]
    return min(systems, key=lambda system: _misfit(model, system.values, system))


def believed(model: ObservedModel, system: LinearisedSystem) -> LinearisedSystem:
    """The system about nuisances that their priors find plausible: far out they stand in for what is missing."""
    values = plausible(system.values, model.sigma)
    return system if np.array_equal(values, system.values) else linearised(model, values)


def plausible(values: Floats, sigma: Floats) -> Floats:
    """Clipped to so many deviations of their priors."""
    return np.asarray(np.clip(values, -PLAUSIBLE * sigma, PLAUSIBLE * sigma))


def within_priors(system: LinearisedSystem, fitted: LinearisedSystem) -> LinearisedSystem:
    """A system about plausible nuisances, with those that the fit strains held there: what the experimenter declared.

    Otherwise a modulus that is ten deviations off, once learnt from one press, predicts all others.
    """
    count = len(fitted.values)
    return _held(system, np.abs(fitted.values) > PLAUSIBLE * system.sigma[:count], system.values)


def capped(system: LinearisedSystem) -> LinearisedSystem:
    """The system with nuisances held at CAP deviations of their priors where the recording pulls them farther out."""
    values = system.nuisances(system.residual)
    reach = CAP * system.sigma[: len(values)]
    return _held(system, np.abs(values) > reach, np.clip(values, -reach, reach))


def _held(system: LinearisedSystem, which: Bools, values: Floats) -> LinearisedSystem:
    """Some nuisances, (p,) flags, do not float any more: their values (p,) are given."""
    number = np.flatnonzero(which)
    residual, sigma = system.residual.copy(), system.sigma_of_one.copy()
    residual[system.informative] -= system.nuisance_design[:, number] @ values[number]
    sigma[number] = 0.0
    return replace(system, residual=residual, sigma_of_one=sigma)


def _starts(model: ObservedModel) -> list[Floats]:
    zero = np.zeros(len(model.nuisances))
    starts = [zero]
    for number, nuisance in enumerate(model.nuisances):
        if np.isinf(nuisance.sigma) and nuisance.candidate is not None:
            for value in nuisance.candidate.coordinates[nuisance.coordinate].starts:
                starts.append(zero.copy())
                starts[-1][number] = value
    return [_aligned(model, start) for start in starts]


def _aligned(model: ObservedModel, values: Floats) -> Floats:
    """Lags that are wide against the sampling step, at the best correlation of their run."""
    values = values.copy()
    for number, nuisance in enumerate(model.nuisances):
        if nuisance.name == "lag_s" and nuisance.run is not None:
            run = model.runs[nuisance.run]
            if nuisance.sigma > 2.0 * run.step_s:
                values[number] = _best_lag(model, nuisance, values)
    return values


def _best_lag(model: ObservedModel, nuisance: Nuisance, values: Floats) -> float:
    """The lag at which the channels that have it correlate best with their prediction, under its prior's reach."""
    number = nuisance.run
    assert number is not None
    run = model.runs[number]
    raw = model.signals(values)[number]
    start = float(values[model.nuisances.index(nuisance)])
    grid = start + np.linspace(-3.0, 3.0, LAGS) * nuisance.sigma
    own = [b for b in model.samples.blocks if b.run == number and late(run, b.channel)]
    channels = [block for block in own if nuisance.acts_on(block.channel)]

    def likeness(lag: float) -> float:
        total = 0.0
        for block in channels:
            there = block.observed
            moved = np.interp(run.time_s - lag, run.time_s, raw[block.channel])[there]
            seen = run.channels[block.channel][there]
            spread = float(np.std(moved) * np.std(seen))
            total += float(np.mean((moved - moved.mean()) * (seen - seen.mean()))) / spread if spread > 0.0 else 0.0
        return total

    return float(max(grid, key=likeness))


def _descended(model: ObservedModel, values: Floats) -> LinearisedSystem:
    """Gauss-Newton with halved steps where a step does not help."""
    system = linearised(model, values)
    for _ in range(BASELINE_ROUNDS if len(values) else 0):
        target = system.nuisances(system.residual)
        step, now = target - system.values, _misfit(model, system.values, system)
        for _ in range(HALVINGS):
            if _misfit(model, model.possible(system.values + step), system) <= now:
                break
            step = 0.5 * step
        else:
            return system
        moved = model.possible(system.values + step)
        done = _length(system, moved - system.values) < CLOSE
        system = linearised(model, moved)
        if done:
            break
    return system


def _misfit(model: ObservedModel, values: Floats, system: LinearisedSystem) -> float:
    """Twice the negative log posterior of nuisances, but for a constant; discrepancies integrated out by the system.

    Infinite where the model has no answer.
    """
    try:
        predicted = model.vector(values)
    except ValueError:
        return np.inf
    count = len(values)
    others: Bools = np.arange(system.nuisance_design.shape[1]) >= count
    left = model.samples.recorded - predicted
    columns, sigma = system.weighted(system.nuisance_design[:, others]), system.sigma[others]
    return Quadratic(columns, sigma).square(system.weighted(left)) + float(((values / model.sigma) ** 2).sum())


def _length(system: LinearisedSystem, step: Floats) -> float:
    """How far a step is in posterior standard deviations, about."""
    change = system.weighted(system.nuisance_design[:, : len(step)] @ step)
    return float(np.sqrt(system.quadratic.square(change)))

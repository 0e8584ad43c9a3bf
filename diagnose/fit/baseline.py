"""The baseline, fitted fairly: nuisances alone, under their priors, from several starts."""

from dataclasses import replace

import numpy as np

from diagnose.fit.linearised_system import LinearisedSystem, linearised
from diagnose.fit.marginal_likelihood import Quadratic
from diagnose.fit.nuisances import Nuisance, late
from diagnose.fit.observed_model import ObservedModel
from foundation.arrays import Bools, Floats

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

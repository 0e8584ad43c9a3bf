"""Fit of the baseline: nuisances alone, under their priors, from several starts."""

from contextlib import suppress
from dataclasses import replace

import numpy as np

from diagnose.fit.linearised_system import LinearisedSystem, linearise
from diagnose.fit.marginal_likelihood import Quadratic
from diagnose.fit.nuisances import Nuisance, is_on_lagging_clock
from diagnose.fit.observed_model import ObservedModel
from diagnose.forward import NoAnswerError
from foundation.arrays import Bools, Floats
from solve.solution.errors import NoEquilibriumError

MAX_BASELINE_ITERATIONS = 12
NEGLIGIBLE_STEP_SIGMAS = 0.01  # posterior standard deviations: another step is not worth it
LAG_GRID_POINTS = 41  # over three deviations either way
MAX_HALVINGS = 5
PLAUSIBLE_SIGMAS = 2.0  # of a prior
CAP_SIGMAS = 4.0  # of a prior: no explanation may pull a nuisance farther


def fit_baseline(model: ObservedModel) -> LinearisedSystem:
    """System linear about the best nuisances of the baseline.

    They are sought from 0, from aligned lags and from the starts of free ones. NoEquilibriumError where the model has
    no answer at any of them.
    """
    systems = []
    for start in _starting_points(model):
        with suppress(NoAnswerError):
            systems.append(_gauss_newton(model, start))
    if not systems:
        raise NoEquilibriumError("the model as rig.toml states it has no answer to these runs", np.zeros(0), None)
    return min(systems, key=lambda system: _misfit(model, system.values, system))


def linearise_at_plausible(model: ObservedModel, system: LinearisedSystem) -> LinearisedSystem:
    """System about nuisances clipped to what their priors find plausible: far out they stand in for what is missing."""
    values = clip_to_plausible(system.values, model.sigma)
    return system if np.array_equal(values, system.values) else linearise(model, values)


def clip_to_plausible(values: Floats, sigma: Floats) -> Floats:
    """Nuisances (p,) clipped to PLAUSIBLE_SIGMAS deviations (p,) of their priors."""
    return np.asarray(np.clip(values, -PLAUSIBLE_SIGMAS * sigma, PLAUSIBLE_SIGMAS * sigma))


def hold_strained_nuisances(system: LinearisedSystem, fitted: LinearisedSystem) -> LinearisedSystem:
    """System about plausible nuisances, in which those that the fit strains are held at what the experimenter declared.

    Otherwise a modulus that is ten deviations off, once learnt from one press, predicts all others.
    """
    count = len(fitted.values)
    return _hold_nuisances(system, np.abs(fitted.values) > PLAUSIBLE_SIGMAS * system.sigma[:count], system.values)


def cap_nuisances(system: LinearisedSystem) -> LinearisedSystem:
    """System with nuisances held at CAP_SIGMAS deviations of their priors where the recording pulls them beyond."""
    values = system.best_nuisances(system.residual)
    reach = CAP_SIGMAS * system.sigma[: len(values)]
    return _hold_nuisances(system, np.abs(values) > reach, np.clip(values, -reach, reach))


def _hold_nuisances(system: LinearisedSystem, which: Bools, values: Floats) -> LinearisedSystem:
    """System in which some nuisances, (p,) flags, do not float any more: they have the given values (p,)."""
    number = np.flatnonzero(which)
    residual, sigma = system.residual.copy(), system.sigma_of_one.copy()
    residual[system.informative] -= system.nuisance_design[:, number] @ values[number]
    sigma[number] = 0.0
    return replace(system, residual=residual, sigma_of_one=sigma)


def _starting_points(model: ObservedModel) -> list[Floats]:
    """Nuisances (p,) to start from: 0, and each start of a free nuisance, all with aligned lags."""
    zero = np.zeros(len(model.nuisances))
    starts = [zero]
    for number, nuisance in enumerate(model.nuisances):
        if np.isinf(nuisance.sigma) and nuisance.candidate is not None:
            for value in nuisance.candidate.coordinates[nuisance.coordinate].starts:
                starts.append(zero.copy())
                starts[-1][number] = value
    return [_align_lags(model, start) for start in starts]


def _align_lags(model: ObservedModel, values: Floats) -> Floats:
    """Nuisances (p,) with lags that are wide against the sampling step at the best correlation of their run."""
    values = values.copy()
    for number, nuisance in enumerate(model.nuisances):
        if nuisance.name == "lag_s" and nuisance.run is not None:
            run = model.runs[nuisance.run]
            if nuisance.sigma > 2.0 * run.step_s:
                values[number] = _best_lag_s(model, nuisance, values)
    return values


def _best_lag_s(model: ObservedModel, nuisance: Nuisance, values: Floats) -> float:
    """Lag in s at which the channels that have it correlate best with their prediction, within reach of its prior."""
    number = nuisance.run
    assert number is not None
    run = model.runs[number]
    try:
        raw = model.signals(values)[number]
    except NoAnswerError:
        return float(values[model.nuisances.index(nuisance)])
    start = float(values[model.nuisances.index(nuisance)])
    grid = start + np.linspace(-3.0, 3.0, LAG_GRID_POINTS) * nuisance.sigma
    own = [b for b in model.samples.blocks if b.run == number and is_on_lagging_clock(run, b.channel)]
    channels = [block for block in own if nuisance.acts_on(block.channel)]

    def correlation(lag: float) -> float:
        total = 0.0
        for block in channels:
            there = block.observed_mask
            moved = np.interp(run.time_s - lag, run.time_s, raw[block.channel])[there]
            seen = run.channels[block.channel][there]
            spread = float(np.std(moved) * np.std(seen))
            total += float(np.mean((moved - moved.mean()) * (seen - seen.mean()))) / spread if spread > 0.0 else 0.0
        return total

    return float(max(grid, key=correlation))


def _gauss_newton(model: ObservedModel, values: Floats) -> LinearisedSystem:
    """System about the nuisances of least misfit, by Gauss-Newton with halved steps where a step does not help."""
    system = linearise(model, values)
    for _ in range(MAX_BASELINE_ITERATIONS if len(values) else 0):
        target = system.best_nuisances(system.residual)
        step, now = target - system.values, _misfit(model, system.values, system)
        for _ in range(MAX_HALVINGS):
            if _misfit(model, model.clip_to_bounds(system.values + step), system) <= now:
                break
            step = 0.5 * step
        else:
            return system
        moved = model.clip_to_bounds(system.values + step)
        done = _step_sigmas(system, moved - system.values) < NEGLIGIBLE_STEP_SIGMAS
        system = linearise(model, moved)
        if done:
            break
    return system


def _misfit(model: ObservedModel, values: Floats, system: LinearisedSystem) -> float:
    """Twice the negative log posterior of nuisances (p,), but for a constant.

    The system integrates discrepancies out. Infinite where the model has no answer.
    """
    try:
        predicted = model.vector(values)
    except NoAnswerError:
        return np.inf
    count = len(values)
    others: Bools = np.arange(system.nuisance_design.shape[1]) >= count
    left = model.samples.recorded_vector - predicted
    columns, sigma = system.weighted_rows(system.nuisance_design[:, others]), system.sigma[others]
    return Quadratic(columns, sigma).square(system.weighted_rows(left)) + float(((values / model.sigma) ** 2).sum())


def _step_sigmas(system: LinearisedSystem, step: Floats) -> float:
    """Approximate length of a step (p,) in posterior standard deviations."""
    change = system.weighted_rows(system.nuisance_design[:, : len(step)] @ step)
    return float(np.sqrt(system.quadratic.square(change)))

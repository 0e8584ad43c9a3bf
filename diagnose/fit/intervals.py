"""Intervals of parameters by the profile likelihood, for any function of the fitted coordinates.

The profile interval of g is the range of g over all values whose log-likelihood is within half the chi-square
quantile of the best (Venzon and Moolgavkar, Appl. Stat. 37 (1988) 87). Its ends are found by steps that are exact where
the likelihood is quadratic and g linear: with Hessian H and slope a of g, to the end of the ellipsoid along H^-1 a.
"""

from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from numbers import Real
from typing import Any

import numpy as np
from scipy.stats import chi2

from diagnose.findings import Interval
from diagnose.fit import discrepancy
from diagnose.fit.descent import bounds, descent, settings
from diagnose.fit.levenberg_marquardt import scales
from diagnose.fit.linearised_system import engine_errors
from diagnose.fit.nuisances import slope_by_step
from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.refit import Fitted
from diagnose.fit.trials import rejected
from diagnose.forward import Candidate, NoAnswerError, Setting
from foundation.arrays import Bools, Floats

INTERVAL_LEVEL = 0.9
MAX_STEPS_TO_END = 8
UNUSED_SHARE = 0.1  # of the allowed fall of the likelihood: more of it is left where a bound ended a search
NEGLIGIBLE_STEP_SHARE = 0.01  # of the half width: another step is not worth it
GRADIENT_STEP_SHARE = 1e-4  # of the width of a coordinate's range, for slopes of g

Function = Callable[[Floats], float]


def profile_intervals(model: ObservedModel, fit: Fitted) -> tuple[Mapping[str, Interval], ...]:
    """Profile intervals of the parameters and derived quantities of each mechanism of a fit, by name.

    All leave room for what every rig has a little of; the low end of a gap or of friction also for what of it is that.
    """
    fit = _with_everyday_flaws(model, _with_depth_error(model, _with_law_error(fit)))
    return tuple(_mechanism_intervals(model, fit, number) for number in range(len(fit.candidates)))


def point_intervals(fit: Fitted) -> tuple[Mapping[str, Interval], ...]:
    """Fitted values of each mechanism by name, as intervals without width."""
    return tuple(
        {
            name: Interval(value, value, value, _parameter_unit(one.candidate, name))
            for name, value in _told(one).items()
        }
        for one in fit.settings
    )


def _with_law_error(fit: Fitted) -> Fitted:
    """Fit with the model-form error at its largest, where the law is one of several: those have derived quantities."""
    if not any(_derived(one) for one in fit.settings):
        return fit
    return replace(fit, system=replace(fit.system, form_error=fit.largest_form_error))


def _with_depth_error(model: ObservedModel, fit: Fitted) -> Fitted:
    """Fit with an error over depth that no further run averages out, as all runs have it.

    A name needs no such allowance.
    """
    shown = model.signals(fit.system.values, fit.settings)
    columns, sigma = discrepancy.depth_columns(
        model.samples, discrepancy.error_scale_signals(shown), engine_errors(model)
    )
    return replace(fit, system=fit.system.with_nuisance_columns(columns, sigma))


def _with_everyday_flaws(model: ObservedModel, fit: Fitted) -> Fitted:
    """Fit with columns for what a careful laboratory has too, softness at the first touch or friction, of either sign.

    It is no finding, but takes the place of a part of what is.
    """
    more = [one for one in model.engine.candidates if one.everyday and one not in fit.candidates]
    columns = [column for one in more for column in _everyday_changes(model, fit, one)]
    if not columns:
        return fit
    return replace(fit, system=fit.system.with_nuisance_columns(np.column_stack(columns), np.ones(len(columns))))


def _everyday_changes(model: ObservedModel, fit: Fitted, candidate: Candidate) -> Iterator[Floats]:
    """Changes (n,) by an everyday amount of a candidate, one for each coordinate.

    Together their squares are that of one such amount.
    """
    without, count = model.vector(fit.system.values, fit.settings), len(candidate.coordinates)
    for number, coordinate in enumerate(candidate.coordinates):
        at = np.where(np.arange(count) == number, coordinate.starts[0], 0.0)
        one = Setting(candidate, tuple(at.tolist()))
        with suppress(NoAnswerError):
            share = min(usual / _quantity(one, name) for name, usual in candidate.everyday.items())
            change = model.vector(fit.system.values, [*fit.settings, one]) - without
            yield np.asarray(share / np.sqrt(count) * change)


def _mechanism_intervals(model: ObservedModel, fit: Fitted, number: int) -> Mapping[str, Interval]:
    """Profile intervals of one mechanism of a fit, by name of the parameter or derived quantity."""

    def function(name: str) -> Function:
        return lambda values: _quantity(settings(fit.candidates, values)[number], name)

    names = _told(fit.settings[number])
    candidate = fit.candidates[number]
    found = {name: _interval(model, fit, function(name), _parameter_unit(candidate, name)) for name in names}
    less = {name: max(found[name].low - usual, 0.0) for name, usual in candidate.everyday.items()}
    return {name: replace(one, low=less.get(name, one.low)) for name, one in found.items()}


def _parameter_unit(candidate: Candidate, name: str) -> str:
    """Unit of a parameter; relative_moduli[0] has that of relative_moduli."""
    return candidate.units.get(name.partition("[")[0], "")


def _derived(one: Setting) -> dict[str, float]:
    """Derived quantities of a setting, none where the model has no answer to it."""
    with suppress(NoAnswerError), rejected():
        return one.candidate.derived(one.values)
    return {}


def _told(one: Setting) -> dict[str, float]:
    """Numbers of the verdict, and derived quantities where the model has an answer, of a setting by name."""
    return {**_numbers(one), **_flat(_derived(one))}


def _numbers(one: Setting) -> dict[str, float]:
    """Numbers of the verdict of a setting, but for what is derived, by name."""
    return _flat((one.candidate.told or one.candidate.parameters)(one.values))


def _quantity(one: Setting, name: str) -> float:
    """A number of the verdict or derived quantity of a setting. NoAnswerError.

    What a simpler law has no number for is 0: the quality of one RC stage, the modulus of a branch that is off.
    """
    given = _numbers(one)
    if name in given:
        return given[name]
    with rejected():
        return _flat(one.candidate.derived(one.values)).get(name, 0.0)


def _flat(values: Mapping[str, Any]) -> dict[str, float]:
    """Numbers by name, lists taken apart: name[0], name[1]; a single value keeps its name."""
    flat: dict[str, float] = {}
    for name, value in values.items():
        items = list(value) if isinstance(value, list | tuple) else [value]
        for n, item in enumerate(items):
            if isinstance(item, Real):
                flat[name if len(items) == 1 else f"{name}[{n}]"] = float(item)
    return flat


def _interval(model: ObservedModel, fit: Fitted, function: Function, unit: str) -> Interval:
    """Profile interval of a function of the fitted values; fixed where it does not depend on them."""
    value = function(fit.values)
    if not _gradient(function, fit.values, bounds(fit.candidates)).any():
        return Interval(value, value, value, unit, fixed=True)
    ends = [_interval_end(model, fit, function, side) for side in (-1.0, 1.0)]
    low, high = min(value, ends[0][0]), max(value, ends[1][0])
    return Interval(value, low, high, unit, ends[0][1], ends[1][1])


def _interval_end(model: ObservedModel, fit: Fitted, function: Function, side: float) -> tuple[float, bool]:
    """End of g on one side, and whether the bounds of the search set it and not the data.

    They do where the likelihood would allow more, and a bound holds a coordinate that would take g farther.
    """
    limits, best = bounds(fit.candidates), function(fit.values)
    problem = descent(model, fit.system, fit.candidates, fit.settings)
    here, reached = problem.at(fit.values), best
    room = 0.5 * float(chi2.ppf(INTERVAL_LEVEL, 1))
    allowed = here.cost + room
    for _ in range(MAX_STEPS_TO_END):
        slope = side * _gradient(function, here.values, limits)
        if not slope.any():
            break
        columns = fit.system.weighted_rows(problem.slopes(here))
        cleared = fit.system.quadratic.apply_inverse(columns)
        step = _step_to_end(columns.T @ cleared, cleared.T @ here.left, slope, allowed - here.cost, here.values, limits)
        after = problem.at(np.clip(here.values + step, *limits.T))
        if not np.isfinite(after.cost):
            break
        try:
            before, reached = reached, function(after.values)
        except NoAnswerError:
            break
        here = after
        if abs(reached - before) <= NEGLIGIBLE_STEP_SHARE * abs(reached - best):
            break
    slope = side * _gradient(function, here.values, limits)
    held = (here.values <= limits[:, 0]) & (slope < 0.0) | (here.values >= limits[:, 1]) & (slope > 0.0)
    return reached, bool(held.any() and allowed - here.cost > UNUSED_SHARE * room)


def _step_to_end(
    hessian: Floats, gradient: Floats, slope: Floats, room: float, values: Floats, limits: Floats
) -> Floats:
    """Farthest step (q,) along a slope (q,) that a quadratic log-likelihood allows; gradient (q,) : of the likelihood.

    Coordinates that would leave their bounds are held there, and the others are solved anew.
    """
    free: Bools = np.ones(len(values), dtype=bool)
    step = np.zeros(len(values))
    for _ in range(len(values) + 1):
        if not free.any():
            break
        own = hessian[np.ix_(free, free)]
        pull = gradient[free] - hessian[np.ix_(free, ~free)] @ step[~free]
        scale = scales(own)
        inverse = np.linalg.inv(own / np.outer(scale, scale) + 1e-9 * np.eye(len(own))) / np.outer(scale, scale)
        fixed = step[~free]
        held = float(0.5 * fixed @ hessian[np.ix_(~free, ~free)] @ fixed - gradient[~free] @ fixed)
        radius = max(room - held + 0.5 * float(pull @ inverse @ pull), 0.0)
        along = float(slope[free] @ inverse @ slope[free])
        step[free] = inverse @ pull + (np.sqrt(2.0 * radius / along) * (inverse @ slope[free]) if along > 0.0 else 0.0)
        target = values + step
        outside = free & ((target < limits[:, 0]) | (target > limits[:, 1]))
        if not outside.any():
            break
        step[outside] = np.clip(target, *limits.T)[outside] - values[outside]
        free &= ~outside
    return step


def _gradient(function: Function, values: Floats, limits: Floats) -> Floats:
    """Gradient (q,) of a function, by differences towards the inside of its limits (q, 2), or where it has a value."""
    slope, here = np.zeros(len(values)), function(values)
    for n, row in enumerate(np.eye(len(values))):
        step = GRADIENT_STEP_SHARE * (limits[n, 1] - limits[n, 0])
        step = -step if values[n] + step > limits[n, 1] else step

        def change(by: float, along: Floats = row) -> Floats:
            return np.array([function(values + by * along) - here])

        slope[n] = slope_by_step(change, step, 1)[0]
    return slope

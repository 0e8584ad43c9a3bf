"""What findings keep of fits: models, nuisances, signals and information."""

from collections.abc import Mapping, Sequence
from functools import partial

import numpy as np

from diagnose.findings import Detection, FittedModel
from diagnose.fit.intervals import point_intervals, profile_intervals
from diagnose.fit.nuisances import Nuisance
from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.refit import Fitted
from diagnose.forward import Setting, Signals
from diagnose.inference.choice import Judged
from diagnose.inference.residual_test import Checked
from diagnose.statistics.error_rates import RATES
from foundation.arrays import Floats


def fitted_model(model: ObservedModel, one: Judged, probability: float, detailed: bool) -> FittedModel:
    """The model as findings keep it, with its probability. detailed : whether intervals may be asked for."""
    each = zip(model.nuisances, one.fit.closest_nuisances(model), strict=True)
    return FittedModel(
        settings=one.fit.settings,
        parameters=point_intervals(one.fit),
        gain=one.gain.mean,
        gain_lower=one.gain.lower,
        probability=probability,
        p_left=one.p_left,
        intervals=partial(profile_intervals, model, one.fit) if detailed else None,
        shared={nuisance.name: float(value) for nuisance, value in each if nuisance.run is None},
    )


def detection(model: ObservedModel, found: Checked) -> Detection:
    """How sure it is that there is a mismatch, by the largest score of all cells."""
    noise = model.samples.noise_summaries()
    return Detection(float(found.scores.max()), found.p_value, RATES.level, noise, found.least_p_value)


def nuisance_values(model: ObservedModel, values: Floats) -> dict[str, tuple[float, float]]:
    """Name, "name of run" or "name of run, channel" -> value and prior sigma."""
    each = zip(model.nuisances, values, model.sigma, strict=True)
    return {_label(one, model): (one.stated_value(float(value)), float(sigma)) for one, value, sigma in each}


def _label(nuisance: Nuisance, model: ObservedModel) -> str:
    if nuisance.run is None:
        return nuisance.name
    channel = "" if nuisance.channel is None else f", {nuisance.channel}"
    return f"{nuisance.name} of {model.runs[nuisance.run].label}{channel}"


def labelled(model: ObservedModel, values: Floats, settings: Sequence[Setting]) -> Mapping[str, Signals]:
    """Label -> what the instruments of that run show."""
    return {run.label: shown for run, shown in zip(model.runs, model.signals(values, settings), strict=True)}


def improved_signals(model: ObservedModel, chosen: Judged) -> Mapping[str, Signals]:
    """Label -> what the instruments of that run show with the mechanisms of the model."""
    return labelled(model, chosen.fit.closest_nuisances(model), chosen.fit.settings)


def information(fits: Sequence[Fitted]) -> Floats:
    """(p, p) of the coordinates of models, nuisances integrated out, one block each."""
    count = sum(len(fit.values) for fit in fits)
    total, first = np.zeros((count, count)), 0
    for fit in fits:
        last = first + len(fit.values)
        columns = fit.system.weighted_rows(fit.slopes)
        total[first:last, first:last] = fit.system.quadratic.inner_products(columns, columns)
        first = last
    return total

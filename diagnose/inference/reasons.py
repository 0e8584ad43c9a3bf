"""Names of explanations, and what makes findings less sure than they look, in sentences for somebody at a bench."""

import numpy as np

from diagnose.figures import figure
from diagnose.fit.linearised_system import LinearisedSystem
from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.refit import Fitted
from diagnose.verdict.names import join_words

FAR_SIGMAS = 3.0  # of a prior


def named(fit: Fitted) -> str:
    """Names such as charge-leakage (readout) and friction (dot)."""
    return join_words([f"{one.mechanism} ({one.component})" for one in fit.candidates])


def warnings_of(model: ObservedModel, baseline: LinearisedSystem) -> tuple[str, ...]:
    """Sentences on what makes the findings less sure than they look."""
    said = _strained(model, baseline)
    folds = len(np.unique(model.samples.fold))
    if len(model.samples.presses) < 2:
        held = "its phases were held out in turn instead" if folds > 1 else "nothing could be held out"
        more = "A second press at another speed or depth would make the result surer."
        said.append(f"There is only one press, so {held}. {more}")
    return tuple(said)


def _strained(model: ObservedModel, baseline: LinearisedSystem) -> list[str]:
    """Nuisances that lie farther from 0 than rig.toml says, a sentence for each name."""
    far: dict[str, list[tuple[float, float, str]]] = {}
    for nuisance, value in zip(model.nuisances, baseline.values, strict=True):
        deviations = abs(value) / nuisance.sigma
        if deviations > FAR_SIGMAS:
            of = "all runs" if nuisance.run is None else f"run '{model.runs[nuisance.run].label}'"
            of += "" if nuisance.channel is None else f" ({nuisance.channel})"
            far.setdefault(nuisance.name, []).append((deviations, nuisance.stated_value(value), of))
    said = []
    for name, each in far.items():
        deviations, value, of = max(each)
        others = f", and by less in {len(each) - 1} more" if len(each) > 1 else ""
        said.append(
            f"Your simulation fits best with {name} = {figure(value)} in {of}, {figure(deviations)} times the stated "
            f"uncertainty{others}: this value may stand in for what is missing."
        )
    return said

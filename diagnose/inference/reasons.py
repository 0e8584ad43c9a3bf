"""What findings rest on, in sentences for somebody at a bench."""

from collections.abc import Sequence

import numpy as np

from diagnose.figures import figure, p_equals, part_percent, percent
from diagnose.findings import Fit
from diagnose.fit.linearised_system import LinearisedSystem
from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.refit import Fitted
from diagnose.forward import Candidate
from diagnose.inference.choice import Choice, Judged, criteria
from diagnose.verdict.names import join_words

FAR = 3.0  # deviations of a prior


def named(fit: Fitted) -> str:
    """charge-leakage (readout) and friction (dot)."""
    return _names(fit.candidates)


def _names(candidates: Sequence[Candidate]) -> str:
    return join_words([f"{one.mechanism} ({one.component})" for one in candidates])


def reasons_of(p_mismatch: float, choice: Choice | None) -> tuple[str, ...]:
    """Why something is named, or why not."""
    if choice is None:
        return (f"The residual is no larger than noise and the errors of the model make it ({p_equals(p_mismatch)}).",)
    if not choice.models:
        return choice.decision.reasons
    best = choice.models[0]
    return (_for(best), *choice.decision.reasons, *_alternatives(choice))


def _for(best: Judged) -> str:
    share = part_percent(1.0 - min(best.left, 1.0))
    return (
        f"The best explanation is {named(best.fit)}. It accounts for {share} of what your simulation leaves "
        f"unexplained and predicts held-out presses better by {figure(best.gain.mean)} nats per press (at least "
        f"{figure(best.gain.lower)})."
    )


def _alternatives(choice: Choice) -> tuple[str, ...]:
    others = [named(choice.models[n].fit) for n in choice.groups[0] if n > 0]
    return (f"These recordings cannot tell it from {' or from '.join(others)}.",) if others else ()


def warnings_of(model: ObservedModel, baseline: LinearisedSystem, choice: Choice | None) -> tuple[str, ...]:
    """What makes the findings less sure than they look."""
    said = _strained(model, baseline)
    folds = len(np.unique(model.samples.fold))
    if len(model.samples.presses) < 2:
        held = "its phases were held out in turn instead" if folds > 1 else "nothing could be held out"
        more = "A second press at another speed or depth would make the result surer."
        said.append(f"There is only one press, so {held}. {more}")
    if choice is not None and len(choice.models) > 1:
        said += _second_opinion(choice)
    return tuple(said)


def _strained(model: ObservedModel, baseline: LinearisedSystem) -> list[str]:
    """Nuisances that lie farther from 0 than rig.toml says, a sentence for each name."""
    far: dict[str, list[tuple[float, float, str]]] = {}
    for nuisance, value in zip(model.nuisances, baseline.values, strict=True):
        deviations = abs(value) / nuisance.sigma
        if deviations > FAR:
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


def _second_opinion(choice: Choice) -> list[str]:
    """Schwarz's criterion, where it prefers another model by more than ten to one."""
    badness = criteria(choice.models)
    least = int(np.argmin(badness))
    if least == 0 or badness[0] - badness[least] < 2.0 * np.log(10.0):
        return []
    return [f"By the fit to all presses alone (BIC), {named(choice.models[least].fit)} would be preferred."]


def beside(fit: Fitted, first: int, held_out: Fit) -> str:
    """How the mechanisms after the first few came to be named."""
    verb = "shows" if len(fit.candidates) == first + 1 else "show"
    return (
        f"{_names(fit.candidates[first:])} {verb} in what the first explanation leaves of presses that took no part in "
        f"the fit: the error falls further, to {percent(held_out.nrmse_after)}."
    )


def closest(fit: Fitted, share: float) -> str:
    """What comes closest where errors count by their squares and nothing is a main part."""
    verb, it = ("comes", "It accounts") if len(fit.candidates) == 1 else ("come", "They account")
    return (
        f"Where errors count by their squares, {named(fit)} {verb} closest. {it} for {part_percent(max(share, 0.0))} "
        f"of the excess in conditions that took no part in the fit; a main part accounts for more, and in all of them."
    )

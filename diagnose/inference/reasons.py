"""What the findings rest on, in sentences for somebody at a bench."""

import numpy as np

from diagnose.inference.choice import Choice, Judged, criteria
from diagnose.inference.observed_model import ObservedModel
from diagnose.inference.refit import Fitted
from diagnose.inference.system import System

FAR = 3.0  # deviations of a prior


def named(fit: Fitted) -> str:
    """charge-leakage of the readout and friction of the dot."""
    return " and ".join(f"{candidate.mechanism} of the {candidate.component}" for candidate in fit.candidates)


def reasons_of(p_mismatch: float, choice: Choice | None) -> tuple[str, ...]:
    """Why something is named, or why not."""
    if choice is None:
        return (f"The residual is as large as noise and the errors of the model make it (p = {p_mismatch:.3g}).",)
    if not choice.models:
        return choice.decision.reasons
    best = choice.models[0]
    return (_for(best), *choice.decision.reasons, *_alternatives(choice))


def _for(best: Judged) -> str:
    share = 100.0 * (1.0 - min(best.left, 1.0))
    return (
        f"Best is {named(best.fit)}: it explains {share:.0f} % of what the baseline leaves unexplained and predicts "
        f"presses that it was not fitted to better by {best.gain.mean:,.0f} nats each, {best.gain.lower:,.0f} at least."
    )


def _alternatives(choice: Choice) -> tuple[str, ...]:
    others = [named(choice.models[n].fit) for n in choice.groups[0] if n > 0]
    return (f"These recordings cannot tell it from {' or from '.join(others)}.",) if others else ()


def warnings_of(model: ObservedModel, baseline: System, choice: Choice | None) -> tuple[str, ...]:
    """What makes the findings less sure than they look."""
    said = _strained(model, baseline)
    folds = len(np.unique(model.samples.fold))
    if len(model.samples.presses) < 2:
        held = "its phases were held out instead" if folds > 1 else "nothing could be held out"
        said.append(f"There is one press only: {held}. A second press of another speed or depth makes the name surer.")
    if choice is not None and len(choice.models) > 1:
        said += _second_opinion(choice)
    return tuple(said)


def _strained(model: ObservedModel, baseline: System) -> list[str]:
    """What floats farther than rig.toml says, a sentence for each name."""
    far: dict[str, list[tuple[float, float, str]]] = {}
    for nuisance, value in zip(model.nuisances, baseline.values, strict=True):
        deviations = abs(value) / nuisance.sigma
        if deviations > FAR:
            of = "all runs" if nuisance.run is None else f"run '{model.runs[nuisance.run].label}'"
            far.setdefault(nuisance.name, []).append((deviations, value, of))
    said = []
    for name, each in far.items():
        deviations, value, of = max(each)
        others = f", and less far in {len(each) - 1} more" if len(each) > 1 else ""
        said.append(
            f"The baseline fits best with {name} = {value:.3g} in {of}, {deviations:.1f} times the stated "
            f"deviation{others}: it stands in for what is missing."
        )
    return said


def _second_opinion(choice: Choice) -> list[str]:
    """Schwarz's criterion, where it prefers another model by more than ten to one."""
    badness = criteria(choice.models)
    least = int(np.argmin(badness))
    if least == 0 or badness[0] - badness[least] < 2.0 * np.log(10.0):
        return []
    return [f"The fit to all presses alone (BIC) would prefer {named(choice.models[least].fit)}."]

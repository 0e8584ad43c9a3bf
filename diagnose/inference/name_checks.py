"""What the errors on held-out presses say against a name."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from diagnose.figures import percent
from diagnose.findings import Fit
from diagnose.fit.observed_model import ObservedModel
from diagnose.inference.choice import Judged
from diagnose.inference.reasons import named
from diagnose.inference.screening import Screening
from diagnose.inference.true_refit import trained_and_held
from diagnose.statistics.abstain import Decision

SAME = 0.05  # relative: errors on held-out presses that are as large as each other


def agreeing(decision: Decision, held_out: Fit | None) -> Decision:
    """Nothing is named where held-out presses are predicted with more error, whatever their log-score says."""
    if not decision.named or held_out is None or held_out.improves:
        return decision
    reason = (
        f"Fitted to the other presses, it predicts the held-out ones with an error of {percent(held_out.nrmse_after)} "
        f"instead of {percent(held_out.nrmse_before)}, although it gains in the score that weighs errors by the noise."
    )
    return replace(decision, named=False, unexplained=True, reasons=(*decision.reasons, reason))


def alone(model: ObservedModel, screening: Screening, models: Sequence[Judged]) -> dict[str, Fit]:
    """Held-out errors of each single mechanism of a pair, which is the first of the models."""
    pair, found = models[0].fit.candidates, {}
    for one in models[1:] if len(pair) > 1 else ():
        if len(one.fit.candidates) == 1 and one.fit.candidates[0] in pair:
            held_out = trained_and_held(model, screening, one.fit, np.zeros(0))[1]
            assert held_out is not None
            found[named(one.fit)] = held_out
    return found


def worth_both(decision: Decision, together: Fit, alone: Mapping[str, Fit]) -> Decision:
    """No pair is named where one of the two alone predicts held-out presses with less error."""
    for name, fit in alone.items():
        if fit.nrmse_after * (1.0 + SAME) < together.nrmse_after:
            reason = (
                f"Fitted to the other presses, {name} alone predicts the held-out ones with an error of "
                f"{percent(fit.nrmse_after)}, both together with {percent(together.nrmse_after)}."
            )
            return replace(decision, named=False, unexplained=True, reasons=(*decision.reasons, reason))
    return decision

"""What else shows beside the first explanation."""

from dataclasses import replace

import numpy as np

from diagnose.findings import Findings, Fit, Remainder
from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.signal_discrepancy import phase_shares
from diagnose.inference.choice import implausible
from diagnose.inference.findings_of_fits import fitted_model, improved_signals, information, nuisance_values
from diagnose.inference.main_part import NEARLY_ALL, flaws_alone
from diagnose.inference.reasons import beside
from diagnose.inference.screening import Screening
from diagnose.inference.stepwise import Joined, joined
from diagnose.inference.tolerant_judge import residual_beside
from diagnose.inference.true_refit import trained_and_held
from diagnose.signals.phases import PHASES
from foundation.progress import Report


def with_more(model: ObservedModel, screening: Screening, findings: Findings, report: Report) -> Findings:
    """With what else shows beside the first explanation, where it has no rival and leaves more than flaws of a rig.

    It is fitted anew beside what it leaves, so that no detail that it cannot have outweighs the rest. One whose kind
    alone could be told, as it leaves too much, is named with what takes the rest away.
    """
    held_out = findings.held_out
    if not (findings.best or findings.kind) or held_out is None or flaws_alone(held_out) or len(findings.groups[0]) > 1:
        return findings
    first = findings.models[0]
    more = joined(model, screening, first.settings, report)
    grown = len(more.fit.candidates) > len(first.settings)
    judge, one = more.judge, more.judge.judged(more.fit)
    train, after = trained_and_held(judge.model, judge.found, more.fit, np.array([one.gain.mean]))
    assert after is not None
    if after.nrmse_after > held_out.nrmse_after:  # such as far beyond the strains that it was fitted to
        return findings
    rest = _remainder(more, after) if findings.unexplained else None
    if findings.best is None and (not grown or rest is None or rest.share < NEARLY_ALL or implausible(more.fit)):
        return findings
    whole = fitted_model(judge.model, one, first.probability, detailed=True)
    before = (replace(first, probability=0.0, intervals=None),) if grown else ()
    return replace(
        findings,
        models=(whole, *before, *findings.models[1:]),
        best=whole,
        groups=((0,), *(tuple(n + len(before) for n in group) for group in findings.groups[0 if grown else 1 :])),
        train=train,
        held_out=after,
        unnamed=None,
        closest=None,
        improved=improved_signals(judge.model, one),
        nuisances=nuisance_values(judge.model, more.fit.closest_nuisances(judge.model)),
        information=information([more.fit]),
        remainder=rest,
        kind="",
        reasons=(*findings.reasons, beside(more.fit, len(first.settings), after)) if grown else findings.reasons,
        black_box_gain=0.0,
    )


def _remainder(more: Joined, held_out: Fit) -> Remainder:
    squares = more.judge.tolerance.squares(residual_beside(more.judge, more.fit.settings))
    return Remainder(held_out.share, phase_shares(more.judge.model.samples, squares, PHASES))

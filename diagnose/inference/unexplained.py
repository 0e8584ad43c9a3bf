"""What is told of a mismatch without a name: its main part, its kind, or what comes closest."""

from dataclasses import replace

import numpy as np

from diagnose.findings import Findings, Fit, Remainder
from diagnose.inference.choice import Choice, Judged
from diagnose.inference.findings_of_fits import fitted_model, improved_signals, information, nuisance_values
from diagnose.inference.main_part import MainPart, confirmed
from diagnose.inference.reasons import closest, named
from diagnose.inference.true_refit import trained_and_held
from diagnose.verdict.names import common_words


def with_main_part(findings: Findings, main: MainPart, choice: Choice, rng: np.random.Generator) -> Findings:
    """What is unexplained as a whole, with its main part, or what comes closest where a true refit does not confirm it.

    Of several that are as good the one comes first that then predicts with the least error: what is held out in main
    was predicted linear about the fit to all.
    """
    several = main.models[: len(main.group) if main.most and main.nameable else 1]
    refits = [trained_and_held(main.model, main.found, one.fit, np.array([one.gain.mean])) for one in several]
    errors = [held_out.nrmse_after if held_out is not None else 0.0 for _, held_out in refits]
    order = sorted(range(len(several)), key=errors.__getitem__)
    train, held_out = refits[order[0]]
    if not main.most or (held_out is not None and not confirmed(held_out)):
        return _with_closest(findings, main, refits[0][1], rng)
    if not main.nameable or _told_by_tolerating(main, choice):
        return _with_kind(findings, main, refits[0][1], rng)
    chances, best = main.probabilities(rng), main.models[order[0]]
    order += [n for n in range(len(main.models)) if n not in main.group]
    models = tuple(fitted_model(main.model, main.models[n], float(chances[n]), n in main.group) for n in order)
    return replace(
        findings,
        models=models,
        best=models[0],
        groups=(main.group,),
        train=train,
        held_out=held_out,
        unnamed=None,
        closest=None,
        improved=improved_signals(main.model, best),
        nuisances=nuisance_values(main.model, best.fit.closest_nuisances(main.model)),
        information=information([main.models[n].fit for n in order[: len(main.group)]]),
        remainder=Remainder(main.share, main.left_by_phase),
        reasons=_not_everything(findings, choice, best),
        black_box_gain=0.0,  # of another metric
    )


def _told_by_tolerating(main: MainPart, choice: Choice) -> bool:
    """Whether it was not told apart by the noise alone: then it is not by tolerating more.

    What all that was not told apart has in it was no part of the question.
    """
    group = [choice.models[n].fit.candidates for n in choice.groups[0]] if choice.decision.ambiguous else []
    return any(one not in candidates for one in main.models[0].fit.candidates for candidates in group)


def _not_everything(findings: Findings, choice: Choice, main: Judged) -> tuple[str, ...]:
    """Why a main part is not all: what spoke against it, or against another one that comes first by the noise alone."""
    first, reasons = choice.models[:1], findings.reasons[1:]  # the first of them praises the best
    if not first or first[0].fit.candidates == main.fit.candidates:
        return reasons
    return (f"By the noise alone {named(first[0].fit)} comes first, which is not named either.", *reasons)


def _with_kind(findings: Findings, main: MainPart, held_out: Fit | None, rng: np.random.Generator) -> Findings:
    """What is unexplained, with what all explanations of most of it have in common, if anything.

    A kind that was told by the noise stays: what was not told apart is not by tolerating more.
    """
    kind = common_words([main.models[n].fit.settings for n in main.group])
    return replace(_by_squares(findings, main, held_out, rng), kind=kind) if kind and not findings.kind else findings


def _with_closest(findings: Findings, main: MainPart, held_out: Fit | None, rng: np.random.Generator) -> Findings:
    """What is unexplained, with what comes closest by the squares of errors, if it predicts held-out presses better.

    A kind that was told by the noise stays, with the explanations that it is true of.
    """
    before = findings.unnamed
    if findings.kind or before is None or held_out is None or held_out.nrmse_after >= before.nrmse_after:
        return findings
    said = closest(main.models[0].fit, main.share)
    return replace(_by_squares(findings, main, held_out, rng), reasons=(*findings.reasons, said))


def _by_squares(findings: Findings, main: MainPart, held_out: Fit | None, rng: np.random.Generator) -> Findings:
    """Models without a name as they come by the squares of their errors. held_out : of the first."""
    group = [main.models[n].fit for n in main.group]
    chances = main.probabilities(rng)
    models = tuple(fitted_model(main.model, one, float(chances[n]), False) for n, one in enumerate(main.models))
    return replace(
        findings,
        models=models,
        groups=(main.group,),
        unnamed=held_out,
        closest=improved_signals(main.model, main.models[0]),
        ambiguous=False,
        information=information(group),
        black_box_gain=0.0,  # of another metric
    )

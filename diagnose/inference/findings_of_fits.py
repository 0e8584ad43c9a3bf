"""What findings keep of hypotheses: evidence, verdict, models, nuisances, signals and information."""

from collections.abc import Mapping, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np

from diagnose.findings import Detection, Findings, Fit, FittedModel, Remainder
from diagnose.fit.intervals import point_intervals, profile_intervals
from diagnose.fit.linearised_system import LinearisedSystem
from diagnose.fit.nuisances import Nuisance
from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.refit import Fitted
from diagnose.fit.rig_discrepancy import VISIBLE_ERROR
from diagnose.forward import Setting, Signals
from diagnose.inference.equal_explanations import explanations_as_good
from diagnose.inference.grades import Evidence, Identified, KindOnly, MainPart, Unexplained, Verdict, judged
from diagnose.inference.hypotheses import Compared, Hypothesis, implausible
from diagnose.inference.localisation import explanations, places, shares
from diagnose.inference.reasons import named, warnings_of
from diagnose.inference.residual_test import Checked
from diagnose.inference.true_refit import trained_and_held, unimproved
from diagnose.signals.phases import PHASES
from diagnose.statistics.error_rates import RATES
from diagnose.verdict.names import common_words
from foundation.arrays import Floats
from foundation.progress import Report

FEWEST_PRESSES_TO_HALVE = 4
"""With fewer presses one half of them is a single one."""


def baseline_findings(
    model: ObservedModel, baseline: LinearisedSystem, found: Checked, reasons: tuple[str, ...]
) -> Findings:
    """Findings of a baseline that agrees: nothing else is looked at."""
    return Findings(
        engine=model.engine.name,
        engine_accuracy=model.engine.accuracy,
        detection=detection(model, found),
        places=(),
        shares={},
        screened={},
        mismatch=False,
        unexplained=False,
        reasons=reasons,
        models=(),
        best=None,
        groups=(),
        train=None,
        held_out=None,
        nuisances=nuisance_values(model, baseline.values),
        baseline=labelled(model, baseline.values, ()),
        improved=None,
        black_box_gain=0.0,
        warnings=warnings_of(model, baseline),
    )


class Judgement(NamedTuple):
    """A verdict on hypotheses with what it rests on. train, held_out : the best, fitted to half of the presses."""

    found: Compared
    train: Fit
    held_out: Fit | None
    group: list[int]
    evidence: Evidence
    verdict: Verdict


def judgement(found: Compared, detected: Checked) -> Judgement:
    """The verdict on the best explanation."""
    best = found.best
    gains = best.scored.log_scores - found.nothing.scored.log_scores if best is not None else np.zeros(0)
    train, held_out = trained_and_held(found.judge.found, best or found.nothing, gains)
    group = explanations_as_good(found)
    evidence = evidence_of(found, detected, group, held_out)
    return Judgement(found, train, held_out, group, evidence, judged(evidence))


def judgement_of_best_part(found: Compared, detected: Checked) -> Judgement:
    """The verdict on the best explanation; where several mechanisms together may not be named, that on the first part
    of them that is the main part.
    """
    whole = judgement(found, detected)
    if isinstance(whole.verdict, Unexplained):
        parts = (judgement(found.with_first(number), detected) for number in found.parts_of_best)
        return next((one for one in parts if isinstance(one.verdict, MainPart)), whole)
    return whole


def findings_of(compared: Compared, detected: Checked, report: Report) -> Findings:
    """All findings where there is a mismatch."""
    report("held-out presses", 0, 1)
    found, train, held_out, group, evidence, verdict = judgement_of_best_part(compared, detected)
    judge, best = found.judge, found.best
    model, screening = judge.model, judge.found
    named_all, told = isinstance(verdict, Identified), isinstance(verdict, Identified | MainPart)
    fits = [one.fit for one in found.explained if one.fit is not None]
    left = {one.component for n in group for one in found.explained[n].candidates} if told else None
    explained = explanations(screening, fits, left)
    order = [*group, *(n for n in range(len(found.explained)) if n not in group)]
    models = tuple(
        _fitted_model(found, found.explained[n], float(found.probabilities[n]), told and n in group) for n in order
    )
    first = models[0].with_intervals() if models and told else None
    improved = best.fit if best is not None and told else None
    nuisances = improved.closest_nuisances(model) if improved is not None else screening.baseline.values
    signals = improved_signals(model, best.fit) if best is not None and best.fit is not None else None
    return Findings(
        engine=model.engine.name,
        engine_accuracy=model.engine.accuracy,
        detection=detection(model, detected),
        places=places(model.samples, detected, screening, explained),
        shares=shares(screening, explained),
        screened={c.name: float(p) for c, p in zip(screening.candidates, screening.tests.p_values, strict=True)},
        mismatch=True,
        unexplained=not named_all,
        reasons=verdict.reasons,
        models=models if first is None else (first, *(one.with_intervals() for one in models[1:])),
        best=first,
        groups=(tuple(range(len(group))),) if group else (),
        train=train if told else unimproved(train),
        held_out=held_out if told or held_out is None else unimproved(held_out),
        unnamed=None if told else held_out if best is not None else None,
        closest=None if told else signals,
        nuisances=nuisance_values(model, nuisances),
        baseline=labelled(model, screening.start.values, ()),
        improved=signals if told else None,
        black_box_gain=_per_fold(found.something_else, best) if best is not None else 0.0,
        warnings=warnings_of(model, screening.baseline),
        information=information([found.explained[n].fit for n in group]) if group else None,
        remainder=_remainder(found, evidence) if isinstance(verdict, MainPart) else None,
        kind=verdict.kind if isinstance(verdict, KindOnly) else "",
        ambiguous=isinstance(verdict, Unexplained) and len(group) > RATES.largest_group,
    )


def evidence_of(found: Compared, detected: Checked, group: Sequence[int], held_out: Fit | None) -> Evidence:
    """Evidence with all that the rules look at."""
    best, judge = found.best, found.judge
    if best is None or best.fit is None:
        return Evidence(detected.p_value)
    fits = [one.fit for n in group if (one := found.explained[n]).fit is not None]
    confirmed = None if held_out is None else _confirmed(held_out, len(judge.model.samples.presses))
    return Evidence(
        p_mismatch=detected.p_value,
        best=named(best.fit),
        nothing=float(found.probabilities[-2]),
        something_else=float(found.probabilities[-1]),
        share=judge.known_share(best),
        share_of_else=judge.share(found.something_else),
        error=judge.error(best),
        error_before=judge.error(found.nothing),
        group=len(group),
        kind=common_words([fit.settings for fit in fits if fit is not None]),
        confirmed=confirmed,
        ordinary=all(one.candidate.is_ordinary(one.values) for one in best.fit.settings),
        implausible=implausible(best.fit),
        several=len(best.candidates) > 1,
        untold_memory=judge.conditions.is_one and any(one.candidate.traits.memory for one in best.fit.settings),
    )


def _confirmed(held_out: Fit, presses: int) -> float | None:
    """Share that a refit takes away; all of it where what it leaves is less than an ordinary rig does.

    None where half of the presses are too few to fix a law, and it predicts the others better all the same.
    """
    if held_out.improves and presses < FEWEST_PRESSES_TO_HALVE:
        return None
    return 1.0 if held_out.improves and held_out.excess_after <= VISIBLE_ERROR**2 else held_out.share


def _per_fold(one: Hypothesis, other: Hypothesis) -> float:
    return float((one.scored.log_scores - other.scored.log_scores).mean())


def _remainder(found: Compared, evidence: Evidence) -> Remainder:
    """The rest beside a main part, by phase."""
    assert found.best is not None
    samples, left = found.judge.model.samples, found.best.left
    total = np.maximum(np.bincount(samples.phase, left, len(PHASES)), 0.0)
    whole = max(float(total.sum()), np.finfo(float).tiny)
    return Remainder(evidence.share, {name: float(part) / whole for name, part in zip(PHASES, total, strict=True)})


def _fitted_model(found: Compared, one: Hypothesis, probability: float, detailed: bool) -> FittedModel:
    """The model as findings keep it. detailed : whether intervals may be asked for."""
    assert one.fit is not None
    model, fit = found.judge.model, one.fit
    gains = one.scored.log_scores - found.nothing.scored.log_scores
    spread = float(gains.std(ddof=1)) / np.sqrt(len(gains)) if len(gains) > 1 else 0.0
    each = zip(model.nuisances, fit.closest_nuisances(model), strict=True)
    return FittedModel(
        settings=fit.settings,
        parameters=point_intervals(fit),
        gain=float(gains.mean()),
        gain_lower=float(gains.mean() - 1.645 * spread),
        probability=probability,
        error_left=found.judge.error(one),
        intervals=partial(profile_intervals, model, fit) if detailed else None,
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


def improved_signals(model: ObservedModel, fit: Fitted) -> Mapping[str, Signals]:
    """Label -> what the instruments of that run show with the mechanisms of a fit."""
    return labelled(model, fit.closest_nuisances(model), fit.settings)


def information(fits: Sequence[Fitted | None]) -> Floats:
    """(p, p) of the coordinates of models, nuisances integrated out, one block each."""
    known = [fit for fit in fits if fit is not None]
    count = sum(len(fit.values) for fit in known)
    total, first = np.zeros((count, count)), 0
    for fit in known:
        last = first + len(fit.values)
        columns = fit.system.weighted_rows(fit.slopes)
        total[first:last, first:last] = fit.system.quadratic.inner_products(columns, columns)
        first = last
    return total

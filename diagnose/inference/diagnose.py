"""The whole chain: from a recording and a forward model to findings."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from diagnose.figures import figure, percent
from diagnose.findings import Detection, Findings, Fit, FittedModel, Remainder
from diagnose.fit.baseline import fitted_baseline
from diagnose.fit.drive_error import drive_error
from diagnose.fit.intervals import intervals, points
from diagnose.fit.linearised_system import LinearisedSystem
from diagnose.fit.nuisances import Nuisance
from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.refit import Fitted
from diagnose.fit.samples import Samples
from diagnose.fit.signal_discrepancy import by_phase
from diagnose.forward import Engine, Setting, Signals
from diagnose.inference import hum
from diagnose.inference.black_box import trained_and_held, unimproved
from diagnose.inference.choice import Choice, Judged, choose, implausible
from diagnose.inference.localisation import explanations, places, shares
from diagnose.inference.main_part import FLAWS, NEARLY_ALL, MainPart, confirmed, main_part
from diagnose.inference.reasons import beside, closest, named, reasons_of, warnings_of
from diagnose.inference.residual_test import Checked, checked
from diagnose.inference.search import Screening, screen
from diagnose.inference.stepwise import Joined, joined
from diagnose.inference.tolerant_judge import distinguished, residual_beside
from diagnose.noise.estimate import noise_models
from diagnose.signals.phases import PHASES
from diagnose.signals.recording import Recording
from diagnose.statistics.abstain import Decision
from diagnose.statistics.error_rates import RATES
from diagnose.verdict.names import in_common
from geometry.arrays import Floats
from geometry.base import Report

SAME = 0.05  # relative: errors on held-out presses that are as large as each other


def diagnose(recording: Recording, engine: Engine, seed: int, report: Report) -> Findings:
    """All findings of a recording. The same seed gives the same findings. InputError for a channel without noise."""
    rng = np.random.default_rng(seed)
    noise = noise_models(recording)
    loud = hum.loud_lines(recording, noise)
    if any(candidate.traits.free_phase for candidate in engine.candidates):
        engine = hum.HumEngine(engine, recording, loud)
        noise = hum.without(noise, loud)
    model = ObservedModel(Samples(recording, noise), engine)
    engine.prepare([one.candidate for one in model.nuisances if one.candidate is not None], report)
    report("baseline", 0, 1)
    baseline = fitted_baseline(model)
    found = checked(model.samples, baseline, rng)
    if found.p_value > RATES.level:
        return _quiet(model, baseline, found)
    engine.prepare(engine.candidates, report)
    screening, choice, findings = _explained(model, baseline, found, rng, report)
    if findings.unexplained:
        trembling = _beside_a_drive_error(model, found, choice, rng, report)
        if trembling is not None:
            return _with_intervals(trembling)
        main = main_part(model, screening, report)
        findings = findings if main is None else _with_main_part(findings, main, choice, rng)
    return _with_intervals(_with_more(model, screening, findings, report))


def _with_intervals(findings: Findings) -> Findings:
    """Found last, as they take long and a name may still be replaced."""
    models = tuple(one.with_intervals() for one in findings.models)
    return replace(findings, models=models, best=models[0] if findings.best else None)


def _explained(
    model: ObservedModel, baseline: LinearisedSystem, found: Checked, rng: np.random.Generator, report: Report
) -> tuple[Screening, Choice, Findings]:
    """The choice between all candidates, by the noise alone, and what is told of it."""
    screening = screen(model, baseline, report)
    choice = distinguished(model, screening, choose(model, screening, found.p_value, rng, report))
    return screening, choice, _findings(model, screening, found, choice)


def _beside_a_drive_error(
    model: ObservedModel, found: Checked, choice: Choice, rng: np.random.Generator, report: Report
) -> Findings | None:
    """What is named where the drive may be in error by as much as the best explanation leaves; None where nothing is.

    found : of the detection, which knows of no such error. An error of the drive that makes the whole mismatch leaves
    nothing to be named.
    """
    if not choice.models:
        return None
    best = choice.models[0].fit
    error = drive_error(model, best.nuisances(model), best.settings, RATES.level)
    if error is None:
        return None
    model = model.seen_as(Samples(model.samples.recording, model.samples.noise, error.noise))
    baseline = fitted_baseline(model)
    if checked(model.samples, baseline, rng).p_value > RATES.level:
        return None
    _, _, findings = _explained(model, baseline, found, rng, report)
    if findings.unexplained or (findings.held_out is not None and not _flaws(findings.held_out)):
        return None
    said = (
        f"The channels together show that the drive was off its column by {figure(1000.0 * error.rms_mm)} µm (root "
        f"mean square, below {figure(error.band_Hz)} Hz). This was taken as noise that they share."
    )
    return replace(findings, warnings=(*findings.warnings, said))


def _flaws(held_out: Fit) -> bool:
    """Whether what is left of held-out presses above noise is no more than an ordinary rig and the details of a law."""
    return held_out.excess_after <= FLAWS**2


def _quiet(model: ObservedModel, baseline: LinearisedSystem, found: Checked) -> Findings:
    """No mismatch: a good result."""
    return Findings(
        engine=model.engine.name,
        engine_accuracy=model.engine.accuracy,
        detection=_detection(model, found),
        places=(),
        shares={},
        screened={},
        mismatch=False,
        unexplained=False,
        reasons=reasons_of(found.p_value, None),
        models=(),
        best=None,
        groups=(),
        train=None,
        held_out=None,
        nuisances=_nuisances(model, baseline.values),
        baseline=labelled(model, baseline.values, ()),
        improved=None,
        black_box_gain=0.0,
        warnings=warnings_of(model, baseline, None),
    )


def _findings(model: ObservedModel, screening: Screening, found: Checked, choice: Choice) -> Findings:
    fits = [one.fit for one in choice.models]
    explained = explanations(screening, fits)
    best = choice.models[0] if choice.models else None
    gains = best.forecast.log_scores - choice.base.log_scores if best and choice.base else np.zeros(0)
    train, held_out = trained_and_held(model, screening, best.fit if best else None, gains)
    choice = replace(choice, decision=agreeing(choice.decision, held_out))
    if choice.decision.named and held_out is not None:
        decision = worth_both(choice.decision, held_out, _alone(model, screening, choice.models))
        choice = replace(choice, decision=decision)
    named, ambiguous = choice.decision.named, choice.decision.ambiguous and (held_out is None or held_out.improves)
    kind = in_common([fits[number].settings for number in choice.groups[0]]) if ambiguous else ""
    models = tuple(
        _model(model, one, float(choice.probabilities[n]), detailed=named and n in choice.groups[0])
        for n, one in enumerate(choice.models)
    )
    chosen, closest = (best, None) if named else (None, best)
    unnamed = held_out if closest else None
    if not named:
        train, held_out = unimproved(train), unimproved(held_out) if held_out else None
    return Findings(
        engine=model.engine.name,
        engine_accuracy=model.engine.accuracy,
        detection=_detection(model, found),
        places=places(model.samples, found, screening, explained),
        shares=shares(screening, explained),
        screened={c.name: float(p) for c, p in zip(screening.candidates, screening.tests.p_values, strict=True)},
        mismatch=choice.decision.mismatch,
        unexplained=choice.decision.unexplained,
        reasons=reasons_of(found.p_value, choice),
        models=models,
        best=models[0] if named else None,
        groups=choice.groups,
        train=train,
        held_out=held_out,
        unnamed=unnamed,
        closest=_improved(model, closest) if closest else None,
        nuisances=_nuisances(model, chosen.fit.nuisances(model) if chosen else screening.baseline.values),
        baseline=labelled(model, screening.start.values, ()),
        improved=_improved(model, chosen) if chosen else None,
        black_box_gain=choice.box_gain,
        warnings=warnings_of(model, screening.baseline, choice),
        information=_information([fits[number] for number in choice.groups[0]]) if fits else None,
        kind=kind,
        ambiguous=ambiguous,
    )


def agreeing(decision: Decision, held_out: Fit | None) -> Decision:
    """Nothing is named where held-out presses are predicted with more error, whatever their log-score says."""
    if not decision.named or held_out is None or held_out.improves:
        return decision
    reason = (
        f"Fitted to the other presses, it predicts the held-out ones with an error of {percent(held_out.nrmse_after)} "
        f"instead of {percent(held_out.nrmse_before)}, although it gains in the score that weighs errors by the noise."
    )
    return replace(decision, named=False, unexplained=True, reasons=(*decision.reasons, reason))


def _alone(model: ObservedModel, screening: Screening, models: Sequence[Judged]) -> dict[str, Fit]:
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


def _with_main_part(findings: Findings, main: MainPart, choice: Choice, rng: np.random.Generator) -> Findings:
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
    models = tuple(_model(main.model, main.models[n], float(chances[n]), n in main.group) for n in order)
    return replace(
        findings,
        models=models,
        best=models[0],
        groups=(main.group,),
        train=train,
        held_out=held_out,
        unnamed=None,
        closest=None,
        improved=_improved(main.model, best),
        nuisances=_nuisances(main.model, best.fit.nuisances(main.model)),
        information=_information([main.models[n].fit for n in order[: len(main.group)]]),
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
    kind = in_common([main.models[n].fit.settings for n in main.group])
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
    models = tuple(_model(main.model, one, float(chances[n]), False) for n, one in enumerate(main.models))
    return replace(
        findings,
        models=models,
        groups=(main.group,),
        unnamed=held_out,
        closest=_improved(main.model, main.models[0]),
        ambiguous=False,
        information=_information(group),
        black_box_gain=0.0,  # of another metric
    )


def _with_more(model: ObservedModel, screening: Screening, findings: Findings, report: Report) -> Findings:
    """With what else shows beside the first explanation, where it has no rival and leaves more than flaws of a rig.

    It is fitted anew beside what it leaves, so that no detail that it cannot have outweighs the rest. One whose kind
    alone could be told, as it leaves too much, is named with what takes the rest away.
    """
    held_out = findings.held_out
    if not (findings.best or findings.kind) or held_out is None or _flaws(held_out) or len(findings.groups[0]) > 1:
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
    whole = _model(judge.model, one, first.probability, detailed=True)
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
        improved=_improved(judge.model, one),
        nuisances=_nuisances(judge.model, more.fit.nuisances(judge.model)),
        information=_information([more.fit]),
        remainder=rest,
        kind="",
        reasons=(*findings.reasons, beside(more.fit, len(first.settings), after)) if grown else findings.reasons,
        black_box_gain=0.0,
    )


def _remainder(more: Joined, held_out: Fit) -> Remainder:
    squares = more.judge.tolerance.squares(residual_beside(more.judge, more.fit.settings))
    return Remainder(held_out.share, by_phase(more.judge.model.samples, squares, PHASES))


def _model(model: ObservedModel, one: Judged, probability: float, detailed: bool) -> FittedModel:
    each = zip(model.nuisances, one.fit.nuisances(model), strict=True)
    return FittedModel(
        settings=one.fit.settings,
        parameters=points(one.fit),
        gain=one.gain.mean,
        gain_lower=one.gain.lower,
        probability=probability,
        p_left=one.p_left,
        intervals=partial(intervals, model, one.fit) if detailed else None,
        shared={nuisance.name: float(value) for nuisance, value in each if nuisance.run is None},
    )


def _detection(model: ObservedModel, found: Checked) -> Detection:
    noise = model.samples.noise_summaries()
    return Detection(float(found.scores.max()), found.p_value, RATES.level, noise, found.least_p_value)


def _nuisances(model: ObservedModel, values: Floats) -> dict[str, tuple[float, float]]:
    """Name, "name of run" or "name of run, channel" -> value and prior sigma."""
    each = zip(model.nuisances, values, model.sigma, strict=True)
    return {_label(one, model): (one.stated(float(value)), float(sigma)) for one, value, sigma in each}


def _label(nuisance: Nuisance, model: ObservedModel) -> str:
    if nuisance.run is None:
        return nuisance.name
    channel = "" if nuisance.channel is None else f", {nuisance.channel}"
    return f"{nuisance.name} of {model.runs[nuisance.run].label}{channel}"


def labelled(model: ObservedModel, values: Floats, settings: Sequence[Setting]) -> Mapping[str, Signals]:
    """Label -> what the instruments of that run show."""
    return {run.label: shown for run, shown in zip(model.runs, model.signals(values, settings), strict=True)}


def _improved(model: ObservedModel, chosen: Judged) -> Mapping[str, Signals]:
    return labelled(model, chosen.fit.nuisances(model), chosen.fit.settings)


def _information(fits: Sequence[Fitted]) -> Floats:
    """(p, p) of the coordinates of models, nuisances integrated out, one block each."""
    count = sum(len(fit.values) for fit in fits)
    total, first = np.zeros((count, count)), 0
    for fit in fits:
        last = first + len(fit.values)
        columns = fit.system.weighted(fit.slopes)
        total[first:last, first:last] = fit.system.quadratic.product(columns, columns)
        first = last
    return total

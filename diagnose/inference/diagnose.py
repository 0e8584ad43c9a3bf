"""The whole chain: from a recording and a forward model to findings."""

from dataclasses import replace

import numpy as np

from diagnose.figures import figure
from diagnose.findings import Findings
from diagnose.fit.baseline import fit_baseline
from diagnose.fit.drive_error import likeliest_drive_error
from diagnose.fit.linearised_system import LinearisedSystem
from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.samples import Samples
from diagnose.forward import Engine
from diagnose.inference import hum
from diagnose.inference.choice import Choice, choose
from diagnose.inference.equal_explanations import distinguished
from diagnose.inference.findings_of_fits import (
    detection,
    fitted_model,
    improved_signals,
    information,
    labelled,
    nuisance_values,
)
from diagnose.inference.further_mechanisms import with_more
from diagnose.inference.localisation import explanations, places, shares
from diagnose.inference.main_part import flaws_alone, main_part
from diagnose.inference.name_checks import agreeing, alone, worth_both
from diagnose.inference.reasons import reasons_of, warnings_of
from diagnose.inference.residual_test import Checked, checked
from diagnose.inference.screening import Screening, screen
from diagnose.inference.true_refit import trained_and_held, unimproved
from diagnose.inference.unexplained import with_main_part
from diagnose.noise.estimate import noise_models
from diagnose.signals.recording import Recording
from diagnose.statistics.error_rates import RATES
from diagnose.verdict.names import common_words
from foundation.progress import Report


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
    baseline = fit_baseline(model)
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
        findings = findings if main is None else with_main_part(findings, main, choice, rng)
    return _with_intervals(with_more(model, screening, findings, report))


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
    error = likeliest_drive_error(model, best.closest_nuisances(model), best.settings, RATES.level)
    if error is None:
        return None
    model = model.with_samples(Samples(model.samples.recording, model.samples.noise, error.noise))
    baseline = fit_baseline(model)
    if checked(model.samples, baseline, rng).p_value > RATES.level:
        return None
    _, _, findings = _explained(model, baseline, found, rng, report)
    if findings.unexplained or (findings.held_out is not None and not flaws_alone(findings.held_out)):
        return None
    said = (
        f"The channels together show that the drive was off its column by {figure(1000.0 * error.rms_mm)} µm (root "
        f"mean square, below {figure(error.band_Hz)} Hz). This was taken as noise that they share."
    )
    return replace(findings, warnings=(*findings.warnings, said))


def _quiet(model: ObservedModel, baseline: LinearisedSystem, found: Checked) -> Findings:
    """No mismatch: a good result."""
    return Findings(
        engine=model.engine.name,
        engine_accuracy=model.engine.accuracy,
        detection=detection(model, found),
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
        nuisances=nuisance_values(model, baseline.values),
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
        decision = worth_both(choice.decision, held_out, alone(model, screening, choice.models))
        choice = replace(choice, decision=decision)
    named, ambiguous = choice.decision.named, choice.decision.ambiguous and (held_out is None or held_out.improves)
    kind = common_words([fits[number].settings for number in choice.groups[0]]) if ambiguous else ""
    models = tuple(
        fitted_model(model, one, float(choice.probabilities[n]), detailed=named and n in choice.groups[0])
        for n, one in enumerate(choice.models)
    )
    chosen, closest = (best, None) if named else (None, best)
    unnamed = held_out if closest else None
    if not named:
        train, held_out = unimproved(train), unimproved(held_out) if held_out else None
    return Findings(
        engine=model.engine.name,
        engine_accuracy=model.engine.accuracy,
        detection=detection(model, found),
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
        closest=improved_signals(model, closest) if closest else None,
        nuisances=nuisance_values(model, chosen.fit.closest_nuisances(model) if chosen else screening.baseline.values),
        baseline=labelled(model, screening.start.values, ()),
        improved=improved_signals(model, chosen) if chosen else None,
        black_box_gain=choice.box_gain,
        warnings=warnings_of(model, screening.baseline, choice),
        information=information([fits[number] for number in choice.groups[0]]) if fits else None,
        kind=kind,
        ambiguous=ambiguous,
    )

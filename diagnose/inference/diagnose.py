"""The whole chain: from a recording and a forward model to findings."""

from collections.abc import Mapping, Sequence

import numpy as np

from diagnose.findings import Detection, Findings, Model
from diagnose.forward import Engine, Report, Setting, Signals
from diagnose.inference import hum
from diagnose.inference.baseline import fitted_baseline
from diagnose.inference.choice import Choice, Judged, choose
from diagnose.inference.intervals import intervals, points
from diagnose.inference.localisation import explanations, places, shares
from diagnose.inference.observed_model import ObservedModel
from diagnose.inference.rates import RATES
from diagnose.inference.reasons import reasons_of, warnings_of
from diagnose.inference.residual_test import Checked, checked
from diagnose.inference.samples import Samples
from diagnose.inference.search import Screening, screen
from diagnose.inference.system import System
from diagnose.inference.train_and_hold import trained_and_held, unimproved
from diagnose.noise.estimate import noise_models
from diagnose.recording import Recording
from mesh.types import Floats


def diagnose(recording: Recording, engine: Engine, seed: int, report: Report) -> Findings:
    """All findings of a recording. The same seed gives the same findings. InputError for a channel without noise."""
    rng = np.random.default_rng(seed)
    noise = noise_models(recording)
    loud = hum.loud_lines(recording, noise)
    if any(candidate.mechanism == "mains-hum" for candidate in engine.candidates):
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
    screening = screen(model, baseline, report)
    choice = choose(model, screening, found.p_value, rng, report)
    return _findings(model, screening, found, choice)


def _quiet(model: ObservedModel, baseline: System, found: Checked) -> Findings:
    """No mismatch: a good result."""
    return Findings(
        engine=model.engine.name,
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
    named = choice.decision.named
    models = tuple(
        _model(model, choice, number, detailed=named and number in choice.groups[0]) for number in range(len(fits))
    )
    best = choice.models[0] if choice.models else None
    chosen = best if named else None
    gains = best.forecast.log_scores - choice.base.log_scores if best and choice.base else np.zeros(0)
    train, held_out = trained_and_held(model, screening, best.fit if best else None, gains)
    unnamed = held_out if best and not named else None
    if not named:
        train, held_out = unimproved(train), unimproved(held_out) if held_out else None
    return Findings(
        engine=model.engine.name,
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
        nuisances=_nuisances(model, screening.baseline.values),
        baseline=labelled(model, screening.start.values, ()),
        improved=_improved(model, chosen) if chosen else None,
        black_box_gain=choice.box_gain,
        warnings=warnings_of(model, screening.baseline, choice),
        information=_information(choice) if choice.models else None,
    )


def _model(model: ObservedModel, choice: Choice, number: int, detailed: bool) -> Model:
    one = choice.models[number]
    return Model(
        settings=one.fit.settings,
        parameters=intervals(model, one.fit) if detailed else points(one.fit),
        gain=one.gain.mean,
        gain_lower=one.gain.lower,
        probability=float(choice.probabilities[number]),
        p_left=one.p_left,
    )


def _detection(model: ObservedModel, found: Checked) -> Detection:
    noise = model.samples.noise_summaries()
    return Detection(float(found.scores.max()), found.p_value, RATES.level, noise, found.least_p_value)


def _nuisances(model: ObservedModel, values: Floats) -> dict[str, tuple[float, float]]:
    """Name, or "name of run" -> value and prior sigma."""
    labels = [n.name if n.run is None else f"{n.name} of {model.runs[n.run].label}" for n in model.nuisances]
    return {label: (float(v), float(s)) for label, v, s in zip(labels, values, model.sigma, strict=True)}


def labelled(model: ObservedModel, values: Floats, settings: Sequence[Setting]) -> Mapping[str, Signals]:
    """Label -> what the instruments of that run show."""
    return {run.label: shown for run, shown in zip(model.runs, model.signals(values, settings), strict=True)}


def _improved(model: ObservedModel, chosen: Judged) -> Mapping[str, Signals]:
    return labelled(model, model.possible(chosen.fit.system.closest()), chosen.fit.settings)


def _information(choice: Choice) -> Floats:
    """(p, p) of the coordinates of the models in the first group, nuisances integrated out, one block each."""
    fits = [choice.models[number].fit for number in choice.groups[0]]
    count = sum(len(fit.values) for fit in fits)
    total, first = np.zeros((count, count)), 0
    for fit in fits:
        last = first + len(fit.values)
        columns = fit.system.weighted(fit.slopes)
        total[first:last, first:last] = fit.system.quadratic.product(columns, columns)
        first = last
    return total

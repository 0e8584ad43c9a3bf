"""Runs that only score: findings of all the others, with their error on these."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from diagnose.engines.some_runs import SomeRuns, other_runs, select_runs
from diagnose.findings import Findings, FittedModel
from diagnose.fit.baseline import fit_baseline, linearise_at_plausible
from diagnose.fit.linearised_system import linearise
from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.samples import Samples
from diagnose.forward import Engine, Setting
from diagnose.inference.diagnose import diagnose
from diagnose.inference.findings_of_fits import labelled
from diagnose.inference.true_refit import errors, relaxed, unimproved
from diagnose.noise.estimate import noise_models
from diagnose.signals.recording import Recording
from diagnose.statistics.linear_gaussian import Sums
from foundation.arrays import Bools, Floats
from foundation.progress import Report


def diagnose_and_score(
    recording: Recording, engine: Engine, held: Sequence[int], seed: int, report: Report,
    tell: Callable[[str], None] = lambda _: None,
) -> Findings:  # fmt: skip
    """Findings of all runs but some, with held-out errors of those: numbers of runs of the recording.

    Mechanisms and what all runs share are those of the training runs. What floats in a held-out run is fitted to it,
    without mechanisms and with them alike. tell : as of diagnose. InputError for a channel without noise.
    """
    trained = other_runs(recording, held)
    own = select_runs(recording, trained)
    findings = diagnose(own, SomeRuns(engine, trained), seed, report, tell)
    report("held-out runs", 0, 1)
    return _scored(findings, _model_of(own, engine, trained), _model_of(select_runs(recording, held), engine, held))


def _model_of(recording: Recording, engine: Engine, numbers: Sequence[int]) -> ObservedModel:
    return ObservedModel(Samples(recording, noise_models(recording)), SomeRuns(engine, numbers))


def _scored(findings: Findings, train: ObservedModel, held: ObservedModel) -> Findings:
    """Findings whose errors, signals and noise speak of the held-out runs too."""
    best: FittedModel | None = findings.models[0] if findings.models else None
    settings = tuple(one for one in best.settings if not one.candidate.traits.free_phase) if best else ()
    starts = [linearise_at_plausible(model, fit_baseline(model)).values for model in (train, held)]
    before, after = (_transferred((train, held), starts, chosen) for chosen in ((), settings))
    gains = _log_scores(held, after, settings) - _log_scores(held, before, ())
    fit = errors(held, range(len(held.samples.presses)), before, after, settings, gains)
    named = findings.best is not None
    predicted = labelled(held, after, settings)
    return replace(
        findings,
        detection=replace(findings.detection, noise={**findings.detection.noise, **held.samples.noise_summaries()}),
        held_out=fit if named else unimproved(fit),
        unnamed=fit if best and not named else None,
        baseline={**findings.baseline, **labelled(held, before, ())},
        improved=None if findings.improved is None else {**findings.improved, **predicted},
        closest=None if findings.closest is None else {**findings.closest, **predicted},
    )


def _transferred(
    models: tuple[ObservedModel, ObservedModel], starts: Sequence[Floats], settings: Sequence[Setting]
) -> Floats:
    """Nuisances (p,) of held-out runs: what is shared as in the training runs, the rest fitted from starts of both."""
    train, held = models
    known = _fitted(train, starts[0], settings, {})
    shared = {one.name: value for one, value in zip(train.nuisances, known, strict=True) if one.run is None}
    return _fitted(held, starts[1], settings, shared)


def _fitted(model: ObservedModel, start: Floats, settings: Sequence[Setting], shared: dict[str, float]) -> Floats:
    """Nuisances (p,) with these mechanisms on, within what is plausible; shared ones by name are not touched."""
    values = start.copy()
    frozen: Bools = np.array([one.run is None and one.name in shared for one in model.nuisances], dtype=bool)
    values[frozen] = [shared[one.name] for one in model.nuisances if one.run is None and one.name in shared]
    return relaxed(model, values, settings, np.ones(len(model.samples), dtype=bool), frozen)


def _log_scores(model: ObservedModel, values: Floats, settings: Sequence[Setting]) -> Floats:
    """Log-density (presses,) of each press alone, its own nuisances integrated out under their priors."""
    system, samples = linearise(model, values, settings), model.samples
    shared = np.flatnonzero([one.run is None for one in model.nuisances])
    kept = np.setdiff1d(np.arange(len(system.sigma)), shared)
    columns = system.weighted_rows(system.nuisance_design)
    white = system.weighted_rows(system.residual) - columns[:, shared] @ values[shared]
    scale = np.log(system.weight)
    rows = [samples.press == number for number in range(len(samples.presses))]
    return np.array([
        Sums.from_columns(columns[own][:, kept], white[own]).log_evidence(system.sigma[kept]) + float(scale[own].sum())
        for own in rows
    ])  # fmt: skip

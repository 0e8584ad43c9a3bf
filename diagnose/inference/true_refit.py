"""True refits: the named model fitted to some presses and shown on others that it has not seen."""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace

import numpy as np

from diagnose.findings import Fit
from diagnose.fit.baseline import CAP_SIGMAS, PLAUSIBLE_SIGMAS
from diagnose.fit.linearised_system import LinearisedSystem, linearise
from diagnose.fit.marginal_likelihood import Quadratic
from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.refit import fit_mechanisms
from diagnose.forward import NoAnswerError, Setting
from diagnose.inference.hypotheses import Hypothesis
from diagnose.inference.screening import Screening
from foundation.arrays import Bools, Floats

ROUNDS = 2


def split(presses: int) -> tuple[list[int], list[int]]:
    """Numbers of presses to train on and to hold out: every second one."""
    return list(range(0, presses, 2)), list(range(1, presses, 2))


def trained_and_held(found: Screening, one: Hypothesis, gains: Floats) -> tuple[Fit, Fit | None]:
    """Errors of a hypothesis on training presses and on held-out ones, every second one; None where there is one only.

    gains : (presses,) held-out log-score gains. Mechanisms and shared nuisances come from training presses alone, in
    the metric of the hypothesis. What floats in a run that has no training press is fitted to it with both models
    alike, under its prior. A phase that nobody knows is predicted in runs with a training press alone.
    """
    model, fit = one.metric, one.fit
    samples = model.samples
    training, held = split(len(samples.presses))
    informative = found.baseline.informative
    seen = informative & np.isin(samples.press, training)
    settings: tuple[Setting, ...] = ()
    after = before = relaxed(model, found.start.values, (), seen, np.zeros(len(model.nuisances), dtype=bool))
    with suppress(NoAnswerError):  # a law that turns over for half of the presses improves nothing
        if fit is not None:
            own = fit_mechanisms(model, fit.system.restricted_to(seen), fit.candidates, fit.values, one.form_excess)
            settings, after = own.settings, own.closest_nuisances(model)
    runs = {samples.presses[n][0] for n in training}
    if fit is not None and any(one.traits.free_phase for one in fit.candidates):
        held = [n for n in held if samples.presses[n][0] in runs]
    frozen = np.array([nuisance.run is None or nuisance.run in runs for nuisance in model.nuisances], dtype=bool)
    unseen = informative & np.isin(samples.press, held)
    if held and not frozen.all():
        before = relaxed(model, before, (), unseen, frozen)
        after = relaxed(model, after, settings, unseen, frozen) if fit is not None else before
    train = errors(model, training, before, after, settings, gains)
    return train, errors(model, held, before, after, settings, gains) if held else None


def unimproved(fit: Fit) -> Fit:
    """The fit where nothing is named: after is as before."""
    return replace(fit, nrmse_after=fit.nrmse_before, log_score_gain_per_press=0.0)


def relaxed(model: ObservedModel, values: Floats, settings: Sequence[Setting], rows: Bools, frozen: Bools) -> Floats:
    """Nuisances fitted to some rows under their priors, but for those that are frozen.

    Without mechanisms they stay within what is plausible: far out they stand in for what is missing.
    """
    most = CAP_SIGMAS if settings else PLAUSIBLE_SIGMAS
    for _ in range(ROUNDS if len(values) else 0):
        system = linearise(model, values, settings, informative=rows)
        values = model.answerable_nuisances(values, _bounded(system, values, frozen, most), settings)
    return values


def _bounded(system: LinearisedSystem, values: Floats, frozen: Bools, most: float) -> Floats:
    """Least squares (p,) within so many deviations: what would go farther is held there and the rest fitted again."""
    values, held = values.copy(), frozen.copy()
    columns, sigma = system.nuisance_design[:, : len(values)], system.sigma[: len(values)]
    while not held.all():
        free = np.flatnonzero(~held)
        residual = system.residual[system.informative] - columns[:, held] @ values[held]
        found = Quadratic(system.weighted_rows(columns[:, free]), sigma[free]).mean(system.weighted_rows(residual))
        values[free] = np.clip(found, -most * sigma[free], most * sigma[free])
        held[free] = values[free] != found
        if not held[free].any():
            break
    return values


def errors(
    model: ObservedModel,
    presses: Sequence[int],
    before: Floats,
    after: Floats,
    settings: Sequence[Setting],
    gains: Floats,
) -> Fit:
    """Errors on some presses (numbers); gains : (presses,) log-scores over the baseline."""
    samples = model.samples
    names = tuple(f"{model.runs[run].label}, press {press + 1}" for run, press in (samples.presses[n] for n in presses))
    own = [n for n in presses if n < len(gains)]
    gain = float(np.mean(gains[own])) if settings and own else 0.0
    old, new = (_squares(model, presses, shown) for shown in (model.signals(before), model.signals(after, settings)))
    by_channel = tuple((missed, left, noise) for (missed, noise), (left, _) in zip(old, new, strict=True))
    missed, left, noise = np.sqrt(np.mean(by_channel, axis=0)) if by_channel else np.full(3, np.nan)
    return Fit(names, float(missed), float(left), float(noise), gain, by_channel)


def _squares(
    model: ObservedModel, presses: Sequence[int], signals: Sequence[dict[str, Floats]]
) -> list[tuple[float, float]]:
    """Square of the error over that of the recording, and of noise alone, of each channel that was recorded."""
    samples, found = model.samples, []
    for channel in samples.channels:
        missed = seen = noise = 0.0
        for block in samples.blocks:
            if block.channel != channel:
                continue
            run, phases = model.runs[block.run], samples.recording.phases[block.run]
            own = [press for n in presses for number, press in [samples.presses[n]] if number == block.run]
            rows = block.observed_mask & np.isin(phases.press, own)
            recorded = run.channels[channel][rows]
            missed += float(((recorded - signals[block.run][channel][rows]) ** 2).sum())
            seen += float((recorded**2).sum())
            noise += len(recorded) * block.whitening.noise.rms**2
        if seen > 0.0:
            found.append((missed / seen, noise / seen))
    return found

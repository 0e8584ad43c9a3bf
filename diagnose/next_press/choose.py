"""The press by which the surviving rivals part most, in sigma, after all that may float has floated.

How far apart rivals are in a proposed press, once all that may float has floated as far as is still open.

What may float is what an inference excuses too: nuisances, errors of the model, and of each mechanism's law.

A recording that nobody has made yet, of one proposed press, and the engine that answers it.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from typing import Any, cast

import numpy as np

from diagnose.findings import Findings, FittedModel
from diagnose.fit.discrepancy import FORM_ERROR
from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.samples import Samples
from diagnose.fit.system import LinearisedSystem, Quadratic, linearised
from diagnose.forward import Candidate, Engine, Setting, Signals
from diagnose.next_press.proposals import Proposal, base_setup, repeats, variations
from diagnose.noise.estimate import noise_models
from diagnose.signals.recording import Recording, Run
from diagnose.statistics.separation import best_press, least_separation, remaining_spread
from geometry.arrays import Floats


def without_phase(settings: Sequence[Setting]) -> tuple[Setting, ...]:
    """Settings without hum: its phase is that of one run, and means nothing to another model or another press."""
    return tuple(setting for setting in settings if not setting.candidate.traits.free_phase)


class ImaginedEngine:
    """The part of an engine that fits ask for, with the proposed press as its only run."""

    def __init__(self, engine: Engine, proposal: Proposal) -> None:
        self._engine, self._proposal = engine, proposal
        self.name, self.accuracy, self.candidates = engine.name, engine.accuracy, engine.candidates
        self.free_nuisances = engine.free_nuisances

    def nuisance(self, name: str) -> Candidate | None:
        """As the engine."""
        return self._engine.nuisance(name)

    def predict(self, run: int, settings: Sequence[Setting]) -> Signals:
        """All channels of the press. ValueError where the engine cannot tell."""
        kept = [setting for setting in settings if setting.candidate.mechanism != self._proposal.removes]
        if self._proposal.number is not None:
            return self._engine.predict(self._proposal.number, kept)
        if not hasattr(self._engine, "imagine"):
            raise ValueError(f"the model '{self.name}' can predict only the presses of the recording")
        return self._engine.imagine(self._proposal.run, kept)


STEP = 1e-3  # of a coordinate, for its slope


@dataclass(frozen=True)
class ImaginedAnswer:
    """What one rival says of a press. prediction : (n,) whitened. slopes : (n, q) by its coordinates."""

    system: LinearisedSystem
    prediction: Floats
    slopes: Floats


class PressJudge:
    """Rivals, and spreads (q, q): for each a root of the covariance that the recording leaves to its coordinates."""

    def __init__(
        self, recording: Recording, engine: Engine, rivals: Sequence[FittedModel], fitted: Mapping[str, float]
    ) -> None:
        """fitted : nuisance that all runs share -> value. ValueError as the engine's."""
        self.engine, self.fitted = engine, fitted
        self.rivals = [without_phase(rival.settings) for rival in rivals]
        self.specimen, self.noise = recording.specimen, noise_models(recording)
        model = ObservedModel(Samples(recording, self.noise), engine)
        self.spreads = [self._spread(self._answer(model, rival), rival) for rival in self.rivals]

    def separations(self, proposal: Proposal) -> Floats:
        """(pairs,) sigma between each two rivals. ValueError where the engine cannot tell."""
        answers = self.answers(proposal)
        pairs = combinations(range(len(answers)), 2)
        return np.array([self._separation(answers[i], answers[j], self.spreads[i], self.spreads[j]) for i, j in pairs])

    def answers(self, proposal: Proposal) -> list[ImaginedAnswer]:
        """What each rival says of a press. ValueError where the engine cannot tell."""
        run = proposal.run
        noise = {(run.label, name): self.noise[run.label, name] for name in run.answers}
        samples = Samples(Recording((run,), self.specimen), noise)
        model = ObservedModel(samples, cast(Engine, ImaginedEngine(self.engine, proposal)))
        return [self._answer(model, rival) for rival in self.rivals]

    def _answer(self, model: ObservedModel, settings: tuple[Setting, ...]) -> ImaginedAnswer:
        values = np.array([0.0 if n.run is not None else self.fitted.get(n.name, 0.0) for n in model.nuisances])
        prediction = model.vector(values, settings)
        slopes = [(model.vector(values, moved) - prediction) / step for moved, step in _moved(settings)]
        return ImaginedAnswer(
            linearised(model, values, settings, FORM_ERROR),
            prediction,
            np.column_stack([np.zeros((len(prediction), 0)), *slopes]),
        )

    def _spread(self, answer: ImaginedAnswer, settings: Sequence[Setting]) -> Floats:
        """From what the recording tells of the coordinates, and what is plausible without it."""
        widths = [c.high - c.low for setting in settings for c in setting.candidate.coordinates]
        slopes = answer.system.weighted(answer.slopes)
        told = answer.system.quadratic.product(slopes, slopes)
        return remaining_spread(told + np.diag(np.square(1.0 / np.array(widths))))

    def _separation(self, one: ImaginedAnswer, other: ImaginedAnswer, *spreads: Floats) -> float:
        """The expected separation of statistics/design.py, by inner products: presses may have many samples."""
        weight = 1.0 / np.sqrt(np.maximum(one.system.variance, other.system.variance))[:, None]
        open_still = np.column_stack([one.slopes @ spreads[0], other.slopes @ spreads[1]])
        columns = np.column_stack([open_still, one.system.nuisance_design, other.system.nuisance_design])
        sigma = np.concatenate([np.ones(open_still.shape[1]), one.system.sigma, other.system.sigma])
        difference = weight[:, 0] * (one.prediction - other.prediction)
        return float(np.sqrt(max(Quadratic(weight * columns, sigma).square(difference), 0.0)))


def _moved(settings: Sequence[Setting]) -> Iterator[tuple[list[Setting], float]]:
    """The settings with one coordinate after the other a little nearer to the middle of its range, and by how much."""
    for number, setting in enumerate(settings):
        for which, coordinate in enumerate(setting.candidate.coordinates):
            value = setting.values[which]
            towards = 1.0 if value < 0.5 * (coordinate.low + coordinate.high) else -1.0
            step = towards * STEP * (abs(value) + STEP * (coordinate.high - coordinate.low))
            values = tuple(v + step if n == which else v for n, v in enumerate(setting.values))
            yield [replace(s, values=values) if n == number else s for n, s in enumerate(settings)], step


MOST_RIVALS = 3
PLAUSIBLE = 0.01  # a model below this probability is no rival
LEAST = 1.0  # sigma: a press that parts rivals by less tells no more than its noise
CONFUSED = 0.05  # chance of choosing the wrong one that is taken for settled


@dataclass(frozen=True)
class NextPress:
    """text : what to do. changes : key -> value. rivals : the models it parts, their names by settings.

    separation : sigma between the least separated two of them.
    """

    text: str
    changes: Mapping[str, Any]
    rivals: tuple[FittedModel, ...]
    separation: float
    run: Run


def next_press(recording: Recording, engine: Engine, findings: Findings) -> NextPress | None:
    """The best press to make next; None where fewer than two models are left, or no press parts them by LEAST."""
    rivals = surviving(findings)
    found = _found(recording, engine, findings, rivals) if len(rivals) > 1 else None
    return found if found is not None and found.separation >= LEAST else None


def _found(
    recording: Recording, engine: Engine, findings: Findings, rivals: tuple[FittedModel, ...]
) -> NextPress | None:
    """The best press, with one change or, where that does not settle it, with two."""
    judge = PressJudge(recording, engine, rivals, {name: value for name, (value, _) in findings.nuisances.items()})
    setup = base_setup(recording)
    if setup is None:
        return _best(judge, rivals, repeats(recording))
    first = _best(judge, rivals, [*repeats(recording), *(each.proposal() for each in (setup, *variations(setup)))])
    if first is None or first.separation >= least_separation(CONFUSED):
        return first
    again = [second for one in variations(setup) if one.changes == first.changes for second in variations(one)]
    second = _best(judge, rivals, [each.proposal() for each in again])
    return second if second is not None and second.separation > first.separation else first


def surviving(findings: Findings) -> tuple[FittedModel, ...]:
    """What is left to tell apart: the group of the best model, else the best model and its rivals."""
    if not findings.mismatch:
        return ()
    group = findings.groups[0] if findings.groups else ()
    chosen = [findings.models[number] for number in group]
    if len(chosen) < 2:
        chosen = [model for model in findings.models if model.probability >= PLAUSIBLE]
    return tuple(chosen[:MOST_RIVALS])


def _best(judge: PressJudge, rivals: tuple[FittedModel, ...], presses: Sequence[Proposal]) -> NextPress | None:
    """The press whose least separated rivals are farthest apart; None where the engine can tell of none."""
    told = []
    for press in presses:
        try:
            told.append((press, judge.separations(press)))
        except ValueError:  # beyond what the model was prepared for
            continue
    if not told:
        return None
    best, separation = told[best_press(np.array([each for _, each in told]))]
    return NextPress(best.text, best.changes, rivals, float(separation.min()), best.run)

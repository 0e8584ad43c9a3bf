"""Distances between rivals in a proposed press, in sigma, once all that may float has floated as far as is still open.

What may float is what an inference excuses too: nuisances, errors of the model, and of each mechanism's law. The press
is a recording of one run that nobody has made yet.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from itertools import combinations
from typing import cast

import numpy as np

from diagnose.findings import FittedModel
from diagnose.fit.discrepancy import FORM_ERROR
from diagnose.fit.linearised_system import LinearisedSystem, linearise
from diagnose.fit.marginal_likelihood import Quadratic
from diagnose.fit.nuisances import slope_by_step
from diagnose.fit.observed_model import ObservedModel
from diagnose.fit.samples import Samples
from diagnose.fit.trials import rejected
from diagnose.forward import Candidate, Engine, NoAnswerError, Setting, Signals
from diagnose.next_press.proposals import Proposal
from diagnose.noise.estimate import noise_models
from diagnose.noise.model import NoiseModel, white_noise
from diagnose.signals.recording import Recording
from diagnose.statistics.best_press import covariance_root
from foundation.arrays import Floats


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
        """Candidate of a nuisance, from the engine."""
        return self._engine.nuisance(name)

    def predict(self, run: int, settings: Sequence[Setting]) -> Signals:
        """Signals of all channels in the press. ValueError where the engine cannot tell."""
        kept = [setting for setting in settings if setting.candidate.mechanism != self._proposal.removes]
        if hasattr(self._engine, "imagine"):  # also a repeat, which finds the specimen as all runs have left it
            return self._engine.imagine(self._proposal.run, kept)
        if self._proposal.number is None:
            raise ValueError(f"the model '{self.name}' can predict only the presses of the recording")
        return self._engine.predict(self._proposal.number, kept)


SLOPE_STEP_SHARE = 1e-3  # of a coordinate, for its slope
ADDED_NOISE_SHARE = 0.005  # of the largest signal: one sigma of an instrument that is not there yet


@dataclass(frozen=True)
class ImaginedAnswer:
    """Prediction of one rival for a press. prediction : (n,) whitened. slopes : (n, q) by its coordinates."""

    system: LinearisedSystem
    prediction: Floats
    slopes: Floats


class PressJudge:
    """Rivals, and what the recording tells of their coordinates.

    known : the rivals as they were found. spreads : (q, q) for each, a root of the covariance that the recording leaves
    to its coordinates.
    """

    def __init__(self, recording: Recording, engine: Engine, rivals: Sequence[FittedModel]) -> None:
        """Learn from the recording what it leaves open. A rival to which the engine has no answer is none."""
        self.engine, self.specimen, self.noise = engine, recording.specimen, noise_models(recording)
        model = ObservedModel(Samples(recording, self.noise), engine)
        self.known, self.rivals, self.spreads = [], [], []
        for known in rivals:
            rival = replace(known, settings=without_phase(known.settings))
            with suppress(NoAnswerError):
                self.spreads.append(self._coordinate_root(self._rival_answer(model, rival), rival.settings))
                self.known.append(known)
                self.rivals.append(rival)

    def separations(self, proposal: Proposal) -> Floats:
        """Separations (pairs,) in sigma between each two rivals. NoAnswerError."""
        answers = self.rival_answers(proposal)
        pairs = combinations(range(len(answers)), 2)
        return np.array([self._separation(answers[i], answers[j], self.spreads[i], self.spreads[j]) for i, j in pairs])

    def rival_answers(self, proposal: Proposal) -> list[ImaginedAnswer]:
        """Predictions of a press by each rival. NoAnswerError."""
        run, engine = proposal.run, cast(Engine, ImaginedEngine(self.engine, proposal))
        with rejected():
            noise = {(run.label, name): self._channel_noise(proposal, engine, name) for name in run.answers}
        model = ObservedModel(Samples(Recording((run,), self.specimen), noise), engine)
        return [self._rival_answer(model, rival) for rival in self.rivals]

    def _channel_noise(self, proposal: Proposal, engine: Engine, channel: str) -> NoiseModel:
        """Noise of a channel of the press: that of the recording, else of an instrument that the press adds.

        Such an instrument has white noise, a share of its largest signal.
        """
        known = self.noise.get((proposal.run.label, channel))
        if known is not None:
            return known
        largest = float(np.abs(engine.predict(0, self.rivals[0].settings)[channel]).max())
        return white_noise(ADDED_NOISE_SHARE * largest, proposal.run.step_s, "assumed")

    def _rival_answer(self, model: ObservedModel, rival: FittedModel) -> ImaginedAnswer:
        settings = rival.settings
        values = np.array([0.0 if n.run is not None else rival.shared.get(n.name, 0.0) for n in model.nuisances])
        prediction = model.vector(values, settings)
        slopes = [
            slope_by_step(partial(_change, model, values, prediction, moved), step, len(prediction))
            for moved, step in _coordinate_steps(settings)
        ]
        return ImaginedAnswer(
            linearise(model, values, settings, FORM_ERROR),
            prediction,
            np.column_stack([np.zeros((len(prediction), 0)), *slopes]),
        )

    def _coordinate_root(self, answer: ImaginedAnswer, settings: Sequence[Setting]) -> Floats:
        """Root (q, q) of the covariance of coordinates, from the recording and from what is plausible without it."""
        widths = [c.high - c.low for setting in settings for c in setting.candidate.coordinates]
        slopes = answer.system.weighted_rows(answer.slopes)
        told = answer.system.quadratic.inner_products(slopes, slopes)
        return covariance_root(told + np.diag(np.square(1.0 / np.array(widths))))

    def _separation(self, one: ImaginedAnswer, other: ImaginedAnswer, *spreads: Floats) -> float:
        """Expected separation of statistics/separation.py, by inner products: presses may have many samples."""
        weight = 1.0 / np.sqrt(np.maximum(one.system.variance, other.system.variance))[:, None]
        open_still = np.column_stack([one.slopes @ spreads[0], other.slopes @ spreads[1]])
        columns = np.column_stack([open_still, one.system.nuisance_design, other.system.nuisance_design])
        sigma = np.concatenate([np.ones(open_still.shape[1]), one.system.sigma, other.system.sigma])
        difference = weight[:, 0] * (one.prediction - other.prediction)
        return float(np.sqrt(max(Quadratic(weight * columns, sigma).square(difference), 0.0)))


Moved = Callable[[float], list[Setting]]
"""Settings of which one coordinate is moved by so much."""


def _coordinate_steps(settings: Sequence[Setting]) -> Iterator[tuple[Moved, float]]:
    """One coordinate after the other, with a small step towards the middle of its range."""
    for number, setting in enumerate(settings):
        for which, coordinate in enumerate(setting.candidate.coordinates):
            value = setting.values[which]
            towards = 1.0 if value < 0.5 * (coordinate.low + coordinate.high) else -1.0
            step = towards * SLOPE_STEP_SHARE * (abs(value) + SLOPE_STEP_SHARE * (coordinate.high - coordinate.low))
            yield partial(_moved, settings, number, which), step


def _moved(settings: Sequence[Setting], number: int, which: int, by: float) -> list[Setting]:
    values = tuple(v + by if n == which else v for n, v in enumerate(settings[number].values))
    return [replace(s, values=values) if n == number else s for n, s in enumerate(settings)]


def _change(model: ObservedModel, values: Floats, prediction: Floats, moved: Moved, by: float) -> Floats:
    """Change (n,) of a prediction by a step of one coordinate. NoAnswerError."""
    return np.asarray(model.vector(values, moved(by)) - prediction)

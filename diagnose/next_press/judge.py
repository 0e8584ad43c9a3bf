"""How far apart rivals are in a proposed press, once all that may float has floated as far as is still open.

What may float is what an inference excuses too: nuisances, errors of the model, and of each mechanism's law.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from typing import cast

import numpy as np

from diagnose.findings import Model
from diagnose.forward import Engine, Setting
from diagnose.inference.discrepancy import FORM
from diagnose.inference.observed_model import ObservedModel
from diagnose.inference.quadratic import Quadratic
from diagnose.inference.samples import Samples
from diagnose.inference.system import System, linearised
from diagnose.next_press.imagined import ImaginedEngine, without_phase
from diagnose.next_press.proposals import Proposal
from diagnose.noise.estimate import noise_models
from diagnose.recording import Recording
from diagnose.statistics.design import remaining_spread
from mesh.types import Floats

STEP = 1e-3  # of a coordinate, for its slope


@dataclass(frozen=True)
class Answer:
    """What one rival says of a press. prediction : (n,) whitened. slopes : (n, q) by its coordinates."""

    system: System
    prediction: Floats
    slopes: Floats


class Judge:
    """Rivals, and spreads (q, q): for each a root of the covariance that the recording leaves to its coordinates."""

    def __init__(
        self, recording: Recording, engine: Engine, rivals: Sequence[Model], fitted: Mapping[str, float]
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

    def answers(self, proposal: Proposal) -> list[Answer]:
        """What each rival says of a press. ValueError where the engine cannot tell."""
        run = proposal.run
        noise = {(run.label, name): self.noise[run.label, name] for name in run.answers}
        samples = Samples(Recording((run,), self.specimen), noise)
        model = ObservedModel(samples, cast(Engine, ImaginedEngine(self.engine, proposal)))
        return [self._answer(model, rival) for rival in self.rivals]

    def _answer(self, model: ObservedModel, settings: tuple[Setting, ...]) -> Answer:
        values = np.array([0.0 if n.run is not None else self.fitted.get(n.name, 0.0) for n in model.nuisances])
        prediction = model.vector(values, settings)
        slopes = [(model.vector(values, moved) - prediction) / step for moved, step in _moved(settings)]
        return Answer(
            linearised(model, values, settings, FORM),
            prediction,
            np.column_stack([np.zeros((len(prediction), 0)), *slopes]),
        )

    def _spread(self, answer: Answer, settings: Sequence[Setting]) -> Floats:
        """From what the recording tells of the coordinates, and what is plausible without it."""
        widths = [c.high - c.low for setting in settings for c in setting.candidate.coordinates]
        slopes = answer.system.weighted(answer.slopes)
        told = answer.system.quadratic.product(slopes, slopes)
        return remaining_spread(told + np.diag(np.square(1.0 / np.array(widths))))

    def _separation(self, one: Answer, other: Answer, *spreads: Floats) -> float:
        """The expected separation of statistics/design.py, by inner products: presses may have many samples."""
        weight = 1.0 / np.sqrt(np.maximum(one.system.variance, other.system.variance))[:, None]
        open_still = np.column_stack([one.slopes @ spreads[0], other.slopes @ spreads[1]])
        columns = np.column_stack([open_still, one.system.excused, other.system.excused])
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

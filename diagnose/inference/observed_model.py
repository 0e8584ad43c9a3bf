"""The engine seen through the instruments: vectors of whitened coefficients for any mechanisms and nuisances."""

from collections import OrderedDict
from collections.abc import Sequence

import numpy as np

from diagnose.forward import Candidate, Engine, Setting, Signals
from diagnose.inference.nuisances import Nuisance, by_name, nuisances, observed, tangent
from diagnose.inference.samples import Samples
from mesh.types import Floats

REMEMBERED = 400  # predictions of one run
STEP = 0.02  # of the first start of a coordinate, for slopes


class ObservedModel:
    """nuisances : in order. sigma : (p,) of their priors."""

    def __init__(self, samples: Samples, engine: Engine) -> None:
        self.samples, self.engine = samples, engine
        self.runs = samples.recording.runs
        self.nuisances: tuple[Nuisance, ...] = nuisances(samples.recording, engine)
        self.sigma: Floats = np.array([nuisance.sigma for nuisance in self.nuisances])
        self._known: OrderedDict[tuple[object, ...], Signals] = OrderedDict()

    def predicted(self, run: int, settings: Sequence[Setting]) -> Signals:
        """The engine's answer, remembered."""
        on = [s for s in settings if any(s.values)]
        key = (run, *((s.candidate.name, s.values) for s in on))
        if key not in self._known:
            self._known[key] = self.engine.predict(run, on)
            if len(self._known) > REMEMBERED:
                self._known.popitem(last=False)
        self._known.move_to_end(key)
        return self._known[key]

    def signals(self, values: Floats, settings: Sequence[Setting] = ()) -> list[dict[str, Floats]]:
        """What the instruments of every run show, for nuisances (p,) and mechanisms."""
        return [self._shown(run, values, settings) for run in range(len(self.runs))]

    def possible(self, values: Floats) -> Floats:
        """Nuisances (p,) held within what the engine has an answer to."""
        held = values.copy()
        for number, nuisance in enumerate(self.nuisances):
            if nuisance.candidate is not None:
                coordinate = nuisance.candidate.coordinates[nuisance.coordinate]
                held[number] = np.clip(values[number], coordinate.low, coordinate.high)
        return held

    def vector(self, values: Floats, settings: Sequence[Setting] = ()) -> Floats:
        """The same whitened, (n,)."""
        return self.samples.coefficients(self.signals(values, settings))

    def tangents(self, values: Floats, settings: Sequence[Setting] = ()) -> Floats:
        """Its change (n, p) per unit of each nuisance."""
        columns = np.zeros((len(self.samples), len(self.nuisances)))
        shown = self.signals(values, settings)
        for number, nuisance in enumerate(self.nuisances):
            if nuisance.candidate is None:
                columns[:, number] = self._behind(nuisance, values, shown)
            else:
                columns[:, number] = self._through(number, nuisance, values, settings, shown)
        return columns

    def _shown(self, run: int, values: Floats, settings: Sequence[Setting]) -> dict[str, Floats]:
        raw = self.predicted(run, [*self._settings(run, values), *settings])
        own = by_name(self.nuisances, values, run)
        return {name: observed(self.runs[run], name, raw[name], own) for name in self.runs[run].answers}

    def _settings(self, run: int, values: Floats) -> list[Setting]:
        """Nuisances that the engine answers to."""
        at: dict[tuple[str, str], tuple[Candidate, list[float]]] = {}
        for nuisance, value in zip(self.nuisances, values, strict=True):
            if nuisance.candidate is not None and nuisance.run in (None, run):
                empty = (nuisance.candidate, [0.0] * len(nuisance.candidate.coordinates))
                at.setdefault(nuisance.candidate.name, empty)[1][nuisance.coordinate] += float(value)
        return [Setting(candidate, tuple(own)) for candidate, own in at.values()]

    def _behind(self, nuisance: Nuisance, values: Floats, shown: Sequence[Signals]) -> Floats:
        """Column (n,) of a nuisance behind the model."""
        assert nuisance.run is not None
        run, own = self.runs[nuisance.run], by_name(self.nuisances, values, nuisance.run)
        column = {name: tangent(run, name, shown[nuisance.run][name], nuisance.name, own) for name in run.answers}
        return self.of_run(nuisance.run, {name: values for name, values in column.items() if values is not None})

    def _through(
        self, number: int, nuisance: Nuisance, values: Floats, settings: Sequence[Setting], shown: Sequence[Signals]
    ) -> Floats:
        """Column (n,) of a nuisance that the engine answers to, by a difference."""
        assert nuisance.candidate is not None
        coordinate = nuisance.candidate.coordinates[nuisance.coordinate]
        step = STEP * min(map(abs, coordinate.starts))
        step = min(step, nuisance.sigma)
        if values[number] + step > coordinate.high:
            step = -step
        moved = values.copy()
        moved[number] += step
        total = np.zeros(len(self.samples))
        for run in range(len(self.runs)) if nuisance.run is None else [nuisance.run]:
            after = self._shown(run, moved, settings)
            total += self.of_run(run, {name: (after[name] - shown[run][name]) / step for name in after})
        return total

    def of_run(self, run: int, signals: Signals) -> Floats:
        """Vector (n,) of some channels of one run, zero elsewhere."""
        parts = [
            self.samples.of_block(block, block.whitening(signals[block.channel]))
            for block in self.samples.blocks
            if block.run == run and block.channel in signals
        ]
        return np.sum(parts, axis=0) if parts else np.zeros(len(self.samples))

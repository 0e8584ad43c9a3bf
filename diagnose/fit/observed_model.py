"""An engine seen through the instruments: vectors of whitened coefficients for any mechanisms and nuisances."""

from collections.abc import Sequence
from copy import copy

import numpy as np

from diagnose.fit.nuisances import (
    Nuisance,
    declared_nuisances,
    instrument_signal,
    instrument_tangent,
    slope_by_step,
    values_by_name,
)
from diagnose.fit.samples import Samples
from diagnose.fit.trials import Trials
from diagnose.forward import Candidate, Engine, Setting, Signals
from foundation.arrays import Floats

SLOPE_STEP_SHARE = 0.02  # of the first start of a coordinate, for slopes
STEP_SHARES = (0.5, 0.25, 0.125)  # of a step of the nuisances


class ObservedModel:
    """An engine with the instruments of a recording. nuisances : in order. sigma : (p,) deviations of their priors.

    engine : by which trials are evaluated; ValueError as the engine is NoAnswerError throughout. tolerance : (n,)
    variance of the discrepancy that it may leave, see rig_discrepancy.py.
    """

    def __init__(self, samples: Samples, engine: Engine) -> None:
        self.samples, self.runs = samples, samples.recording.runs
        self.engine = Trials(engine, self.runs)
        self.tolerance = np.zeros(len(samples))
        self.nuisances: tuple[Nuisance, ...] = declared_nuisances(samples.recording, engine)
        self.sigma: Floats = np.array([nuisance.sigma for nuisance in self.nuisances])

    def with_tolerance(self, variance: Floats) -> "ObservedModel":
        """This model where it may leave a discrepancy of variance (n,)."""
        other = copy(self)
        other.tolerance = variance
        return other

    def has_answer(self, values: Floats, settings: Sequence[Setting]) -> bool:
        """Whether the engine has an answer to every run at nuisances (p,) and mechanisms."""
        try:
            self.signals(values, settings)
        except ValueError:
            return False
        return True

    def signals(self, values: Floats, settings: Sequence[Setting] = ()) -> list[dict[str, Floats]]:
        """Signals that the instruments of every run show, for nuisances (p,) and mechanisms.

        ValueError as the engine.
        """
        return [self._run_signals(run, values, settings) for run in range(len(self.runs))]

    def imagined_signals(
        self, run: int, drive: Floats, values: Floats, settings: Sequence[Setting]
    ) -> dict[str, Floats]:
        """Signals that the instruments of a run would show under another drive (t,). ValueError as the engine."""
        of = self.runs[run]
        raw = self.engine.imagine(of.with_drive(drive), [*self._nuisance_settings(run, values), *settings])
        told = (self.nuisances, values, run)
        return {name: instrument_signal(of, name, raw[name], values_by_name(*told, name)) for name in of.answers}

    def answerable_nuisances(self, start: Floats, end: Floats, settings: Sequence[Setting]) -> Floats:
        """Possible nuisances (p,) as far on a step from start to end as the engine has an answer.

        A coupon's law may turn over.
        """
        end = self.clip_to_bounds(end)
        for values in (end, *(start + share * (end - start) for share in STEP_SHARES)):
            if self.has_answer(values, settings):
                return values
        return start

    def clip_to_bounds(self, values: Floats) -> Floats:
        """Nuisances (p,) held within what the engine has an answer to."""
        held = values.copy()
        for number, nuisance in enumerate(self.nuisances):
            if nuisance.candidate is not None:
                coordinate = nuisance.candidate.coordinates[nuisance.coordinate]
                held[number] = np.clip(values[number], coordinate.low, coordinate.high)
        return held

    def vector(self, values: Floats, settings: Sequence[Setting] = ()) -> Floats:
        """Whitened coefficients (n,) of what the instruments show. ValueError as the engine."""
        return self.samples.coefficients(self.signals(values, settings))

    def tangents(self, values: Floats, settings: Sequence[Setting] = ()) -> Floats:
        """Change (n, p) of the whitened coefficients per unit of each nuisance."""
        columns = np.zeros((len(self.samples), len(self.nuisances)))
        shown = self.signals(values, settings)
        for number, nuisance in enumerate(self.nuisances):
            if nuisance.candidate is None:
                columns[:, number] = self._column_behind_model(nuisance, values, shown)
            else:
                columns[:, number] = self._column_through_engine(number, nuisance, values, settings, shown)
        return columns

    def _run_signals(self, run: int, values: Floats, settings: Sequence[Setting]) -> dict[str, Floats]:
        raw = self.engine.predict(run, [*self._nuisance_settings(run, values), *settings])
        of, told = self.runs[run], (self.nuisances, values, run)
        return {name: instrument_signal(of, name, raw[name], values_by_name(*told, name)) for name in of.answers}

    def _nuisance_settings(self, run: int, values: Floats) -> list[Setting]:
        """Settings of the nuisances that the engine answers to, in one run."""
        at: dict[tuple[str, str], tuple[Candidate, list[float]]] = {}
        for nuisance, value in zip(self.nuisances, values, strict=True):
            if nuisance.candidate is not None and nuisance.run in (None, run):
                empty = (nuisance.candidate, [0.0] * len(nuisance.candidate.coordinates))
                at.setdefault(nuisance.candidate.name, empty)[1][nuisance.coordinate] += float(value)
        return [Setting(candidate, tuple(own)) for candidate, own in at.values()]

    def _column_behind_model(self, nuisance: Nuisance, values: Floats, shown: Sequence[Signals]) -> Floats:
        """Tangent (n,) of a nuisance behind the model."""
        assert nuisance.run is not None
        run, told = self.runs[nuisance.run], (self.nuisances, values, nuisance.run)
        column = {
            name: instrument_tangent(run, name, shown[nuisance.run][name], nuisance.name, values_by_name(*told, name))
            for name in run.answers
            if nuisance.acts_on(name)
        }
        return self.run_vector(nuisance.run, {name: values for name, values in column.items() if values is not None})

    def _column_through_engine(
        self, number: int, nuisance: Nuisance, values: Floats, settings: Sequence[Setting], shown: Sequence[Signals]
    ) -> Floats:
        """Tangent (n,) of a nuisance that the engine answers to, by a difference; 0 where it answers on no side."""
        assert nuisance.candidate is not None
        coordinate = nuisance.candidate.coordinates[nuisance.coordinate]
        step = min(SLOPE_STEP_SHARE * min(map(abs, coordinate.starts)), nuisance.sigma)
        step = -step if values[number] + step > coordinate.high else step

        def change(by: float) -> Floats:
            moved = values.copy()
            moved[number] += by
            return self._difference(nuisance.run, moved, settings, shown)

        return slope_by_step(change, step, len(self.samples))

    def _difference(
        self, only: int | None, values: Floats, settings: Sequence[Setting], shown: Sequence[Signals]
    ) -> Floats:
        """Change (n,) from what is shown, in one run or in all. ValueError where the engine has no answer."""
        total = np.zeros(len(self.samples))
        for run in range(len(self.runs)) if only is None else [only]:
            after = self._run_signals(run, values, settings)
            total += self.run_vector(run, {name: after[name] - shown[run][name] for name in after})
        return total

    def run_vector(self, run: int, signals: Signals) -> Floats:
        """Whitened coefficients (n,) of some channels of one run, zero elsewhere."""
        parts = [
            self.samples.block_vector(block, block.whitening(signals[block.channel]))
            for block in self.samples.blocks
            if block.run == run and block.channel in signals
        ]
        return np.sum(parts, axis=0) if parts else np.zeros(len(self.samples))

"""Mains hum as a mechanism: a sinusoid of free amplitude and phase in every run, where it outweighs all other noise.

The noise model knows mains lines from samples at rest and excuses them. A line that carries more power than the rest
of the noise is taken out of the noise and has to be explained; a weaker one stays noise.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from diagnose.engines.passing_on import DelegatingEngine
from diagnose.forward import Candidate, Coordinate, Engine, Setting, Signals
from diagnose.noise.mains_lines import Line, line_basis
from diagnose.noise.model import NoiseModel
from diagnose.signals.recording import Recording, Run
from foundation.arrays import Floats
from foundation.progress import Report

LOUD = 1.0  # power over that of all other noise, per whitened sample
WIDEST = 10.0  # times the amplitude at rest: what a fit may reach

NoiseModels = Mapping[tuple[str, str], NoiseModel]


def loud_lines(recording: Recording, noise: NoiseModels) -> dict[tuple[str, str], Line]:
    """(label, voltage channel) -> its strongest line, where that outweighs the rest."""
    found = {}
    for run in recording.runs:
        for channel in run.voltages:
            model = noise.get((run.label, channel))
            if model is not None and model.lines:
                line = max(model.lines, key=lambda one: one.amplitude)
                if _power(model, line, run.time_s) >= LOUD:
                    found[run.label, channel] = line
    return found


def _power(model: NoiseModel, line: Line, time_s: Floats) -> float:
    """Power of a line in whitened samples, whose other noise has power 1."""
    white = model.without_lines().whitening(np.ones(len(time_s), dtype=bool), time_s)(line_basis([line], time_s))
    return float((white**2).sum(axis=1).mean())


def without(noise: NoiseModels, loud: Mapping[tuple[str, str], Line]) -> NoiseModels:
    """The noise without its loud lines; runs that share a model go on sharing it."""
    changed: dict[tuple[int, Line], NoiseModel] = {}
    result = dict(noise)
    for key, line in loud.items():
        model = noise[key]
        own = changed.setdefault((id(model), line), replace(model, lines=tuple(x for x in model.lines if x != line)))
        result[key] = own
    return result


class HumEngine(DelegatingEngine):
    """An engine whose mains-hum has a free sine and cosine in each channel with a loud line, at the output."""

    def __init__(self, engine: Engine, recording: Recording, loud: Mapping[tuple[str, str], Line]) -> None:
        super().__init__(engine)
        self._recording = recording
        self._places = [(n, c) for n, run in enumerate(recording.runs) for c in run.voltages if (run.label, c) in loud]
        self._lines = [loud[recording.runs[n].label, c] for n, c in self._places]
        given = next((c for c in engine.candidates if c.traits.free_phase), None)
        self._hum = self._candidate(given) if given is not None and loud else None
        others = tuple(c for c in engine.candidates if not c.traits.free_phase)
        self.candidates = others if self._hum is None else (*others, self._hum)

    def prepare(self, candidates: Sequence[Candidate], report: Report) -> None:
        """Prepare the engine for all but the hum."""
        super().prepare([c for c in candidates if c is not self._hum], report)

    def prepare_roughly(self, candidates: Sequence[Candidate], report: Report) -> None:
        """Prepare the engine roughly for all but the hum."""
        super().prepare_roughly([c for c in candidates if c is not self._hum], report)

    def predict(self, run: int, settings: Sequence[Setting]) -> Signals:
        """Predict as the engine does, with the hum added at the output."""
        signals = dict(super().predict(run, [s for s in settings if s.candidate is not self._hum]))
        for setting in settings:
            if setting.candidate is self._hum:
                for place, (number, channel) in enumerate(self._places):
                    if number == run:
                        pair = setting.values[2 * place : 2 * place + 2]
                        signals[channel] = signals[channel] + self._wave(place, run, pair)
        return signals

    def imagine(self, run: Run, settings: Sequence[Setting]) -> Signals:
        """Imagine as the engine does, without hum."""
        return super().imagine(run, [s for s in settings if s.candidate is not self._hum])

    def _wave(self, place: int, run: int, pair: Sequence[float]) -> Floats:
        turn = 2.0 * np.pi * self._lines[place].frequency_Hz * self._recording.runs[run].time_s
        return np.asarray(pair[0] * np.sin(turn) + pair[1] * np.cos(turn))

    def _candidate(self, given: Candidate) -> Candidate:
        """Two coordinates per channel and run; the amplitude that is told is the mean one, before the amplifier."""
        ratio, lines = self._passed(given), self._lines

        def parameters(values: Sequence[float]) -> dict[str, Any]:
            shown = np.sqrt(2.0 * np.mean(np.square(values)))
            frequency = float(np.mean([line.frequency_Hz for line in lines]))
            return {"frequency_Hz": frequency, "amplitude_V": float(shown) / ratio}

        coordinates = tuple(
            Coordinate(f"{name} {n}", -WIDEST * line.amplitude, WIDEST * line.amplitude, (line.amplitude,))
            for n, line in enumerate(lines)
            for name in ("sine", "cosine")
        )
        units = {"frequency_Hz": "Hz", "amplitude_V": "V"}
        return Candidate(given.mechanism, given.component, coordinates, parameters, units=units)

    def _passed(self, given: Candidate) -> float:
        """Amplitude at the output over that at the input."""
        run, channel = self._places[0]
        values = tuple(coordinate.starts[0] for coordinate in given.coordinates)
        super().prepare([given], lambda *_: None)
        change = super().predict(run, [Setting(given, values)])[channel] - super().predict(run, [])[channel]
        amplitude = float(given.parameters(values).get("amplitude_V", 0.0))
        shown = float(np.sqrt(2.0 * np.mean(change**2)))
        return shown / amplitude if amplitude > 0.0 and shown > 0.0 else 1.0

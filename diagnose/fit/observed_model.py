"""The engine seen through the instruments: vectors of whitened coefficients for any mechanisms and nuisances.

What may float without counting as physics, run by run as declared, and how the model answers to it.
"""

from collections import OrderedDict
from collections.abc import Callable, Sequence
from contextlib import suppress
from copy import copy
from dataclasses import dataclass

import numpy as np

from diagnose.fit.samples import Samples
from diagnose.forward import Candidate, Engine, Setting, Signals
from diagnose.signals.recording import Recording, Run
from geometry.arrays import Floats

GAINS = {"gain": "V", "force_gain": "N"}
OFFSETS = {"offset_V": "V", "offset_N": "N", "offset_mm": "mm"}
CLOCKS = ("lag_s", "clock_ratio")


@dataclass(frozen=True)
class Nuisance:
    """One number that floats. run : whose it is, None where all runs share it.

    channel : whose it is, where each of several voltages has its own; else None.
    sigma : of its prior, inf for none. candidate : through which the engine answers, None for what happens behind it.
    coordinate : its number there.
    """

    name: str
    run: int | None
    sigma: float
    candidate: Candidate | None = None
    coordinate: int = 0
    channel: str | None = None

    def acts_on(self, channel: str) -> bool:
        """Whether a channel has it, as far as that is told apart."""
        return self.channel in (None, channel)

    def stated(self, value: float) -> float:
        """The value as rig.toml states it: of a factor its relative error, whatever the coordinate."""
        if self.candidate is None:
            return value
        at = np.zeros(len(self.candidate.coordinates))
        at[self.coordinate] = value
        factors = [one for name, one in self.candidate.parameters(at.tolist()).items() if name.endswith("_factor")]
        return float(factors[0]) - 1.0 if factors else value


def nuisances(recording: Recording, engine: Engine) -> tuple[Nuisance, ...]:
    """All that rig.toml declares and the engine knows, and what the engine itself leaves free."""
    found: list[Nuisance] = []
    shared: dict[str, float] = {}
    for number, run in enumerate(recording.runs):
        for name, sigma in run.nuisance.items():
            if behind(run, name):
                found += [Nuisance(name, number, sigma, channel=channel) for channel in owners(run, name)]
            elif name in GAINS or name in OFFSETS or name in CLOCKS:
                candidate = engine.nuisance(name)
                found += [Nuisance(name, number, sigma, candidate)] if candidate is not None else []
            else:
                shared[name] = max(sigma, shared.get(name, 0.0))
    for name, sigma in shared.items():
        candidate = engine.nuisance(name)
        found += [Nuisance(name, None, sigma, candidate)] if candidate is not None else []
    for candidate in engine.free_nuisances:
        for number, coordinate in enumerate(candidate.coordinates):
            found.append(Nuisance(coordinate.name, None, np.inf, candidate, number))
    return tuple(found)


def behind(run: Run, name: str) -> bool:
    """Whether a nuisance acts behind the model, on a channel that this run explains."""
    unit = GAINS.get(name) or OFFSETS.get(name)
    if unit is not None:
        return any(channel.endswith(f"_{unit}") for channel in run.answers)
    return name in CLOCKS


def owners(run: Run, name: str) -> Sequence[str | None]:
    """Channels of a run that have a nuisance behind the model each for itself: several amplifiers differ."""
    unit = GAINS.get(name) or OFFSETS.get(name)
    own = len(run.voltages) > 1 and (unit == "V" or name == "lag_s")
    return run.voltages if own else [None]


def late(run: Run, channel: str) -> bool:
    """Whether a channel is on the clock that lags: voltages, or all answers where there are none."""
    return channel.startswith("voltage") or not run.voltages


def observed(run: Run, channel: str, values: Floats, own: dict[str, float]) -> Floats:
    """A predicted channel (t,) as the instruments show it, with nuisances by name."""
    unit = channel.rpartition("_")[2]
    lag, ratio = own.get("lag_s", 0.0), own.get("clock_ratio", 0.0)
    if late(run, channel) and (lag or ratio):
        time = run.time_s
        values = np.interp(time - lag - ratio * (time - time[0]), time, values)
    gain = sum(own.get(name, 0.0) for name, of in GAINS.items() if of == unit)
    offset = sum(own.get(name, 0.0) for name, of in OFFSETS.items() if of == unit)
    return np.asarray((1.0 + gain) * values + offset)


def tangent(run: Run, channel: str, shown: Floats, name: str, own: dict[str, float]) -> Floats | None:
    """Change (t,) of a channel as shown per unit of a nuisance behind the model; None where there is none."""
    unit = channel.rpartition("_")[2]
    if name in GAINS and GAINS[name] == unit:
        offset = sum(own.get(other, 0.0) for other, of in OFFSETS.items() if of == unit)
        return np.asarray((shown - offset) / (1.0 + own.get(name, 0.0)))
    if name in OFFSETS and OFFSETS[name] == unit:
        return np.ones(len(shown))
    if name in CLOCKS and late(run, channel):
        slope = -_slope(run, shown)
        return slope if name == "lag_s" else np.asarray(slope * (run.time_s - run.time_s[0]))
    return None


def _slope(run: Run, values: Floats) -> Floats:
    """Time derivative (t,), piece by piece."""
    slope = np.zeros(len(values))
    for piece in run.pieces:
        if piece.stop - piece.start > 1:
            slope[piece] = np.gradient(values[piece], run.time_s[piece])
    return slope


def by_name(all_of_them: Sequence[Nuisance], values: Floats, run: int, channel: str) -> dict[str, float]:
    """Values of the nuisances behind the model in one channel of one run."""
    return {
        nuisance.name: float(value)
        for nuisance, value in zip(all_of_them, values, strict=True)
        if nuisance.run == run and nuisance.candidate is None and nuisance.acts_on(channel)
    }


def slope_by_step(change: Callable[[float], Floats], step: float, length: int) -> Floats:
    """Change (length,) per unit of a value, by one step towards the side on which the model has an answer; else 0.

    change : of a step; ValueError where the model has no answer.
    """
    for signed in (step, -step):
        with suppress(ValueError):
            return np.asarray(change(signed) / signed)
    return np.zeros(length)


REMEMBERED = 400  # predictions of one run
STEP = 0.02  # of the first start of a coordinate, for slopes
SHARES = (0.5, 0.25, 0.125)  # of a step of the nuisances


class ObservedModel:
    """nuisances : in order. sigma : (p,) of their priors. tolerance : (n,) variance of what it may leave, see there."""

    def __init__(self, samples: Samples, engine: Engine) -> None:
        self.samples, self.engine = samples, engine
        self.tolerance = np.zeros(len(samples))
        self.runs = samples.recording.runs
        self.nuisances: tuple[Nuisance, ...] = nuisances(samples.recording, engine)
        self.sigma: Floats = np.array([nuisance.sigma for nuisance in self.nuisances])
        self._known: OrderedDict[tuple[object, ...], Signals] = OrderedDict()

    def tolerating(self, variance: Floats) -> "ObservedModel":
        """The same model that may leave a discrepancy of variance (n,)."""
        other = copy(self)
        other.tolerance = variance
        return other

    def seen_as(self, samples: Samples) -> "ObservedModel":
        """The same model of the same recording, whose samples are weighed by another noise."""
        other = copy(self)
        other.samples, other.tolerance = samples, np.zeros(len(samples))
        return other

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

    def imagined(self, run: int, drive: Floats, values: Floats, settings: Sequence[Setting]) -> dict[str, Floats]:
        """What its instruments would show if the drive (t,) of a run had been another one. ValueError as the engine."""
        of = self.runs[run]
        raw = self.engine.imagine(of.along(drive), [*self._settings(run, values), *settings])
        told = (self.nuisances, values, run)
        return {name: observed(of, name, raw[name], by_name(*told, name)) for name in of.answers}

    def answered(self, start: Floats, end: Floats, settings: Sequence[Setting]) -> Floats:
        """Possible nuisances (p,) as far on a step from a start as there is an answer: a coupon's law may turn over."""
        end = self.possible(end)
        for values in (end, *(start + share * (end - start) for share in SHARES)):
            try:
                self.signals(values, settings)
            except ValueError:
                continue
            return values
        return start

    def possible(self, values: Floats) -> Floats:
        """Nuisances (p,) held within what the engine has an answer to."""
        held = values.copy()
        for number, nuisance in enumerate(self.nuisances):
            if nuisance.candidate is not None:
                coordinate = nuisance.candidate.coordinates[nuisance.coordinate]
                held[number] = np.clip(values[number], coordinate.low, coordinate.high)
        return held

    def vector(self, values: Floats, settings: Sequence[Setting] = ()) -> Floats:
        """What the instruments would show, whitened, (n,)."""
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
        of, told = self.runs[run], (self.nuisances, values, run)
        return {name: observed(of, name, raw[name], by_name(*told, name)) for name in of.answers}

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
        run, told = self.runs[nuisance.run], (self.nuisances, values, nuisance.run)
        column = {
            name: tangent(run, name, shown[nuisance.run][name], nuisance.name, by_name(*told, name))
            for name in run.answers
            if nuisance.acts_on(name)
        }
        return self.of_run(nuisance.run, {name: values for name, values in column.items() if values is not None})

    def _through(
        self, number: int, nuisance: Nuisance, values: Floats, settings: Sequence[Setting], shown: Sequence[Signals]
    ) -> Floats:
        """Column (n,) of a nuisance that the engine answers to, by a difference; 0 where it answers on neither side."""
        assert nuisance.candidate is not None
        coordinate = nuisance.candidate.coordinates[nuisance.coordinate]
        step = min(STEP * min(map(abs, coordinate.starts)), nuisance.sigma)
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
            after = self._shown(run, values, settings)
            total += self.of_run(run, {name: after[name] - shown[run][name] for name in after})
        return total

    def of_run(self, run: int, signals: Signals) -> Floats:
        """Vector (n,) of some channels of one run, zero elsewhere."""
        parts = [
            self.samples.of_block(block, block.whitening(signals[block.channel]))
            for block in self.samples.blocks
            if block.run == run and block.channel in signals
        ]
        return np.sum(parts, axis=0) if parts else np.zeros(len(self.samples))

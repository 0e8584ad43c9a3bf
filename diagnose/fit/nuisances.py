"""Nuisance parameters, which float without counting as physics: as declared, and how a model answers to them."""

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from diagnose.forward import Candidate, Engine
from diagnose.signals.recording import Recording, Run
from foundation.arrays import Floats

GAINS = {"gain": "V", "force_gain": "N"}
OFFSETS = {"offset_V": "V", "offset_N": "N", "offset_mm": "mm"}
CLOCKS = ("lag_s", "clock_ratio")


@dataclass(frozen=True)
class Nuisance:
    """One number that floats. run : whose it is, None where all runs share it.

    channel : whose it is, where each of several voltages has its own; else None. sigma : deviation of its prior, inf
    for none. candidate : through which the engine answers, None for what happens behind it. coordinate : its number
    there.
    """

    name: str
    run: int | None
    sigma: float
    candidate: Candidate | None = None
    coordinate: int = 0
    channel: str | None = None

    def acts_on(self, channel: str) -> bool:
        """Whether the nuisance acts on a channel, as far as channels are told apart."""
        return self.channel in (None, channel)

    def stated_value(self, value: float) -> float:
        """Value as rig.toml states it: of a factor its relative error, whatever the coordinate."""
        if self.candidate is None:
            return value
        at = np.zeros(len(self.candidate.coordinates))
        at[self.coordinate] = value
        factors = [one for name, one in self.candidate.parameters(at.tolist()).items() if name.endswith("_factor")]
        return float(factors[0]) - 1.0 if factors else value


def declared_nuisances(recording: Recording, engine: Engine) -> tuple[Nuisance, ...]:
    """Nuisances that rig.toml declares and the engine knows, and those that the engine itself leaves free.

    A modulus is another one in each run where runs were made at several temperatures.
    """
    found: list[Nuisance] = []
    several = len({run.temperature_C for run in recording.runs if run.temperature_C is not None}) > 1
    shared: dict[str, float] = {}
    for number, run in enumerate(recording.runs):
        for name, sigma in run.nuisance.items():
            if acts_behind_model(run, name):
                found += [Nuisance(name, number, sigma, channel=channel) for channel in owning_channels(run, name)]
            elif name in GAINS or name in OFFSETS or name in CLOCKS or (several and name.startswith("modulus.")):
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


def acts_behind_model(run: Run, name: str) -> bool:
    """Whether a nuisance acts behind the model, on a channel that this run explains."""
    unit = GAINS.get(name) or OFFSETS.get(name)
    if unit is not None:
        return any(channel.endswith(f"_{unit}") for channel in run.answers)
    return name in CLOCKS


def owning_channels(run: Run, name: str) -> Sequence[str | None]:
    """Channels of a run that have a nuisance behind the model each for itself, as several amplifiers differ.

    [None] where all share it.
    """
    unit = GAINS.get(name) or OFFSETS.get(name)
    own = len(run.voltages) > 1 and (unit == "V" or name == "lag_s")
    return run.voltages if own else [None]


def is_on_lagging_clock(run: Run, channel: str) -> bool:
    """Whether a channel is on the clock that lags: voltages, or all answers where there are none."""
    return channel.startswith("voltage") or not run.voltages


def instrument_signal(run: Run, channel: str, values: Floats, own: dict[str, float]) -> Floats:
    """Channel (t,) as the instruments show a predicted one, with nuisances by name."""
    unit = channel.rpartition("_")[2]
    lag, ratio = own.get("lag_s", 0.0), own.get("clock_ratio", 0.0)
    if is_on_lagging_clock(run, channel) and (lag or ratio):
        time = run.time_s
        values = np.interp(time - lag - ratio * (time - time[0]), time, values)
    gain = sum(own.get(name, 0.0) for name, of in GAINS.items() if of == unit)
    offset = sum(own.get(name, 0.0) for name, of in OFFSETS.items() if of == unit)
    return np.asarray((1.0 + gain) * values + offset)


def instrument_tangent(run: Run, channel: str, shown: Floats, name: str, own: dict[str, float]) -> Floats | None:
    """Change (t,) of a channel as shown per unit of a nuisance behind the model; None where it does not act on it."""
    unit = channel.rpartition("_")[2]
    if name in GAINS and GAINS[name] == unit:
        offset = sum(own.get(other, 0.0) for other, of in OFFSETS.items() if of == unit)
        return np.asarray((shown - offset) / (1.0 + own.get(name, 0.0)))
    if name in OFFSETS and OFFSETS[name] == unit:
        return np.ones(len(shown))
    if name in CLOCKS and is_on_lagging_clock(run, channel):
        slope = -_time_derivative(run, shown)
        return slope if name == "lag_s" else np.asarray(slope * (run.time_s - run.time_s[0]))
    return None


def _time_derivative(run: Run, values: Floats) -> Floats:
    """Time derivative (t,) of values (t,), piece by piece of even sampling."""
    slope = np.zeros(len(values))
    for piece in run.pieces:
        if piece.stop - piece.start > 1:
            slope[piece] = np.gradient(values[piece], run.time_s[piece])
    return slope


def values_by_name(all_of_them: Sequence[Nuisance], values: Floats, run: int, channel: str) -> dict[str, float]:
    """Values of the nuisances behind the model in one channel of one run, by name."""
    return {
        nuisance.name: float(value)
        for nuisance, value in zip(all_of_them, values, strict=True)
        if nuisance.run == run and nuisance.candidate is None and nuisance.acts_on(channel)
    }


def slope_by_step(change: Callable[[float], Floats], step: float, length: int) -> Floats:
    """Change (length,) per unit of a value, by one step towards the side on which the model has an answer.

    0 where it has none on either side. change : of a step; ValueError where the model has no answer.
    """
    for signed in (step, -step):
        with suppress(ValueError):
            return np.asarray(change(signed) / signed)
    return np.zeros(length)

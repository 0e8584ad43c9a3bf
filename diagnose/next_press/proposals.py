"""Presses that a laboratory can make: those of the recording once more, or one of them with changes.

A press as a rig is told it: rest, in, hold, out, as often as wanted. Taken from a recorded one, then varied.

What a bench can change about a press: speed, hold, depth, cycles, load resistor, capacitance, position, warmth, and
whether a load cell is there.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any

import numpy as np

from diagnose.signals.phases import PressPhases, rest_of
from diagnose.signals.recording import Recording, Run
from diagnose.vocabulary.base import vocabulary
from geometry.arrays import Floats
from solve.model import Readout

REST_S = 1.0  # noise and drift show at rest


@dataclass(frozen=True)
class Shape:
    """Trapezoids between two levels of the drive, in its unit (mm or N).

    level : at rest, at most 0 for a displacement. deep : during the hold. rise_s, hold_s, fall_s : from the touch in,
    at depth, and out to the touch; the way from rest to the touch is travelled at the same speed.
    """

    level: float
    deep: float
    rise_s: float
    hold_s: float
    fall_s: float
    cycles: int = 1

    def corners(self) -> tuple[Floats, Floats]:
        """Times (c,) and drive (c,) between which the rig moves evenly; a rest of REST_S before and behind."""
        reach = -self.level / self.deep
        one = (self.rise_s * (1.0 + reach), self.hold_s, self.fall_s * (1.0 + reach))
        steps = [REST_S, *(step for _ in range(self.cycles) for step in (*one, REST_S))]
        drive = [self.level, self.level, *(d for _ in range(self.cycles) for d in self._cycle())]
        return np.cumsum([0.0, *steps]), np.array(drive)

    def _cycle(self) -> tuple[float, float, float, float]:
        return (self.deep, self.deep, self.level, self.level)

    @property
    def duration_s(self) -> float:
        """From the first sample to the last."""
        return float(self.corners()[0][-1])

    def sampled(self, step_s: float) -> tuple[Floats, Floats]:
        """Times and drive (t,) at even steps."""
        times, drive = self.corners()
        at = np.arange(0.0, times[-1] + 0.5 * step_s, step_s)
        kept = np.flatnonzero([True, *(b > a for a, b in pairwise(times))])  # without a hold two corners coincide
        return at, np.interp(at, times[kept], drive[kept])


def recorded_shape(recording: Recording, number: int) -> Shape | None:
    """The deepest press of a run as a shape; None where it has no press with a rise and a release."""
    run = recording.runs[number]
    pressed = [_shape(run, press) for press in recording.phases[number].presses if _complete(press, run)]
    return max(pressed, key=lambda shape: shape.deep, default=None)


def _complete(press: PressPhases, run: Run) -> bool:
    return press.touch < press.held and press.released < press.clear < len(run.time_s)


def _shape(run: Run, press: PressPhases) -> Shape:
    time, drive = run.time_s, run.drive_values
    at_depth = drive[press.held : press.released] if press.released > press.held else drive[press.held - 1 : press.held]
    level = min(rest_of(drive)[0], 0.0) if run.drive == "displacement_mm" else 0.0
    return Shape(
        level=float(level),
        deep=float(np.median(at_depth)),
        rise_s=float(time[press.held] - time[press.touch]),
        hold_s=float(time[press.released] - time[press.held]),
        fall_s=float(time[press.clear] - time[press.released]),
    )


LONGEST_S, MOST_SAMPLES = 120.0, 60_000
FEWEST_IN_RISE = 10  # samples: a rise that is faster is not seen


@dataclass(frozen=True)
class Proposal:
    """run : with its drive as samples and no answers. text : what to do, one sentence.

    changes : key -> new value, against the run that it varies. number : the run of the recording that it repeats, None
    for a new one. removes : the mechanism that it keeps away, so that no model has it; "" for none.
    """

    text: str
    changes: Mapping[str, Any]
    run: Run
    number: int | None = None
    removes: str = ""


@dataclass(frozen=True)
class PressSetup:
    """A shape of press at a run of the recording. words, changes : against the press as it was."""

    run: Run
    shape: Shape
    words: tuple[str, ...] = ()
    changes: Mapping[str, Any] = field(default_factory=dict)
    removes: str = ""

    def changed(self, words: str, changes: Mapping[str, Any], **parts: Any) -> "PressSetup":
        """This press with another run, shape or removal, said and noted."""
        return replace(self, words=(*self.words, words), changes={**self.changes, **changes}, **parts)

    @property
    def feasible(self) -> bool:
        """Whether it is over in time and its rise is sampled."""
        duration, step = self.shape.duration_s, self.run.step_s
        fastest = min(self.shape.rise_s, self.shape.fall_s)
        return duration <= min(LONGEST_S, MOST_SAMPLES * step) and fastest >= FEWEST_IN_RISE * step

    def proposal(self) -> Proposal:
        """With its drive as samples at the rate of the run."""
        text = f"Press as in “{self.run.label}”" + (
            f", but {' and '.join(self.words)}." if self.words else " once more."
        )
        return Proposal(text, self.changes, self._imagined(), removes=self.removes)

    def _imagined(self) -> Run:
        run = self.run
        time, drive = self.shape.sampled(run.step_s)
        unknown, everywhere = np.full(len(time), np.nan), np.ones(len(time), dtype=bool)
        return replace(
            run,
            file="next-press.csv",
            time_s=time,
            channels={name: drive if name == run.drive else unknown for name in run.channels},
            valid=dict.fromkeys(run.channels, everywhere),
            saturated=dict.fromkeys(run.channels, ~everywhere),
            covariates={},
        )


def base_setup(recording: Recording) -> PressSetup | None:
    """The deepest whole press of the recording, if it can one driven by a displacement; None where there is none."""
    found = [(run, recorded_shape(recording, number)) for number, run in enumerate(recording.runs)]
    setups = [PressSetup(run, shape) for run, shape in found if shape is not None]
    return max(setups, key=lambda setup: (setup.run.drive == "displacement_mm", setup.shape.deep), default=None)


def repeats(recording: Recording) -> list[Proposal]:
    """Every run of the recording once more."""
    return [Proposal(f"Repeat “{run.label}”.", {}, run, number) for number, run in enumerate(recording.runs)]


SPEEDS = (0.1, 1.0 / 3.0, 3.0, 10.0)
HOLDS = (0.0, 3.0, 10.0)  # times the hold that there was, or the rise where there was none
DEPTHS = (0.5, 0.75, 1.25)
OFFSETS_MM = (0.25, 0.5)
RESISTORS_MOHM = (0.1, 1.0, 10.0, 100.0, 1000.0)
CAPACITORS_PF = (100.0, 1000.0)
CYCLES = 3
FORCE, LOAD_CELL = "force_N", 0.03
"""A channel that may be added, and the standard deviation of a load cell's gain."""
ALIKE = 1.5  # a resistor within this factor is no change


def variations(setup: PressSetup) -> Iterator[PressSetup]:
    """Every single change of a press that a bench can make and sample."""
    for changed in (*_shaped(setup), *_wired(setup), *_placed(setup), *_measured(setup)):
        if changed.feasible and not changed.changes.keys() <= setup.changes.keys():
            yield changed


def _shaped(setup: PressSetup) -> Iterator[PressSetup]:
    shape = setup.shape
    for factor in SPEEDS:
        other = replace(shape, rise_s=shape.rise_s / factor, fall_s=shape.fall_s / factor)
        speed = f"{factor:g} times faster" if factor > 1.0 else f"{1.0 / factor:.2g} times slower"
        words = f"{speed} ({other.rise_s:.2g} s to full depth)"
        yield setup.changed(words, {"speed_factor": factor}, shape=other)
    for factor in HOLDS:
        hold = factor * (shape.hold_s or shape.rise_s)
        if hold != shape.hold_s:
            words = f"with a hold of {hold:.2g} s" if hold else "without a hold"
            yield setup.changed(words, {"hold_s": hold}, shape=replace(shape, hold_s=hold))
    for factor in DEPTHS:
        quantity, _, unit = setup.run.drive.rpartition("_")
        deep = factor * shape.deep
        changed = replace(shape, deep=deep)
        yield setup.changed(f"to {deep:.3g} {unit}", {f"{quantity}_{unit}": deep}, shape=changed)
    yield setup.changed(f"{CYCLES} times in a row", {"cycles": CYCLES}, shape=replace(shape, cycles=CYCLES))


def _wired(setup: PressSetup) -> Iterator[PressSetup]:
    """Another load resistor, or a capacitor across the input, where there is a voltage amplifier to load."""
    readout = setup.run.readout or Readout()
    if not setup.run.voltages or readout.mode != "voltage":
        return
    there = readout.input_resistance_MOhm or np.inf
    for resistance in RESISTORS_MOHM:
        if max(there / resistance, resistance / there) > ALIKE:
            yield _rewired(setup, f"with {resistance:g} MΩ at the input", input_resistance_MOhm=resistance)
    for extra in CAPACITORS_PF:
        capacitance = readout.input_capacitance_pF + extra
        yield _rewired(setup, f"with {extra:g} pF more across the input", input_capacitance_pF=capacitance)


def _rewired(setup: PressSetup, words: str, **keys: float) -> PressSetup:
    readout = (setup.run.readout or Readout()).model_copy(update=keys)
    return setup.changed(words, keys, run=replace(setup.run, readout=readout))


def _placed(setup: PressSetup) -> Iterator[PressSetup]:
    """The dot elsewhere, or what keeps a mechanism away."""
    x, y = setup.run.dot_offset_mm
    for offset in OFFSETS_MM:
        run = replace(setup.run, dot_offset_mm=(x + offset, y))
        yield setup.changed(f"with the dot {offset:g} mm further along x", {"dot_offset_mm": [x + offset, y]}, run=run)
    for name, entry in vocabulary().items():
        if entry.undone_by is not None:
            words, keys = entry.undone_by
            yield setup.changed(words, dict(keys), removes=name)


def _measured(setup: PressSetup) -> Iterator[PressSetup]:
    """With a load cell, where only voltages answer to a displacement."""
    run = setup.run
    if run.drive != "displacement_mm" or FORCE in run.channels:
        return
    beside = {FORCE: np.full(len(run.time_s), np.nan)}
    run = replace(run, channels={**run.channels, **beside}, nuisance={**run.nuisance, "force_gain": LOAD_CELL})
    yield setup.changed("with a load cell", {"records": FORCE}, run=run)

"""What a bench can change about a press.

Its speed, hold, depth, cycles, load resistor, capacitance, position and warmth can be changed, and whether a load cell
is there.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from diagnose.next_press.proposals import PressSetup
from diagnose.vocabulary.base import vocabulary
from solve.model import Readout

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

"""What a bench can change about a press: speed, hold, depth, cycles, load resistor, capacitance, position, warmth."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from diagnose.next_press.proposals import Setup
from solve.parameters import Readout

SPEEDS = (0.1, 1.0 / 3.0, 3.0, 10.0)
HOLDS = (0.0, 3.0, 10.0)  # times the hold that there was, or the rise where there was none
DEPTHS = (0.5, 0.75, 1.25)
OFFSETS_MM = (0.25, 0.5)
RESISTORS_MOHM = (0.1, 1.0, 10.0, 100.0, 1000.0)
CAPACITORS_PF = (100.0, 1000.0)
CYCLES = 3
ALIKE = 1.5  # a resistor within this factor is no change


def variations(setup: Setup) -> Iterator[Setup]:
    """Every single change of a press that a bench can make and sample."""
    for changed in (*_shaped(setup), *_wired(setup), *_placed(setup)):
        if changed.feasible and not changed.changes.keys() <= setup.changes.keys():
            yield changed


def _shaped(setup: Setup) -> Iterator[Setup]:
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


def _wired(setup: Setup) -> Iterator[Setup]:
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


def _rewired(setup: Setup, words: str, **keys: float) -> Setup:
    readout = (setup.run.readout or Readout()).model_copy(update=keys)
    return setup.changed(words, keys, run=replace(setup.run, readout=readout))


def _placed(setup: Setup) -> Iterator[Setup]:
    """The dot elsewhere, or as warm as the film."""
    x, y = setup.run.dot_offset_mm
    for offset in OFFSETS_MM:
        run = replace(setup.run, dot_offset_mm=(x + offset, y))
        yield setup.changed(f"with the dot {offset:g} mm further along x", {"dot_offset_mm": [x + offset, y]}, run=run)
    yield setup.changed(
        "with the dot as warm as the film", {"dot_temperature": "of the film"}, removes="pyroelectric-drift"
    )

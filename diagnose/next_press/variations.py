"""Variations of a press that a bench can make.

Its speed, hold, depth, cycles, load resistor, capacitance, position and warmth can be changed, and whether a load cell
is there.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from diagnose.next_press.proposals import PressSetup
from diagnose.vocabulary.base import vocabulary
from solve.model import Readout

SPEED_FACTORS = (0.1, 1.0 / 3.0, 3.0, 10.0)
HOLD_FACTORS = (0.0, 3.0, 10.0)  # times the hold, or the rise where there is no hold
DEPTH_FACTORS = (0.5, 0.75, 1.25)
OFFSETS_MM = (0.25, 0.5)
RESISTORS_MOHM = (0.1, 1.0, 10.0, 100.0, 1000.0)
CAPACITORS_PF = (100.0, 1000.0)
CYCLE_COUNT = 3
LOAD_CELL_CHANNEL, LOAD_CELL_GAIN_SIGMA = "force_N", 0.03
"""Channel of a load cell, which may be added, and the relative error of its gain, one sigma."""
SAME_RESISTANCE_RATIO = 1.5  # a resistor within this factor is no change


def variations(setup: PressSetup) -> Iterator[PressSetup]:
    """Presses with each single change that a bench can make and sample."""
    for changed in (
        *_shape_variations(setup),
        *_circuit_variations(setup),
        *_place_variations(setup),
        *_load_cell_variation(setup),
    ):
        if changed.feasible and not changed.changes.keys() <= setup.changes.keys():
            yield changed


def _shape_variations(setup: PressSetup) -> Iterator[PressSetup]:
    shape = setup.shape
    for factor in SPEED_FACTORS:
        other = replace(shape, rise_s=shape.rise_s / factor, fall_s=shape.fall_s / factor)
        speed = f"{factor:g} times faster" if factor > 1.0 else f"{1.0 / factor:.2g} times slower"
        words = f"{speed} ({other.rise_s:.2g} s to full depth)"
        yield setup.with_change(words, {"speed_factor": factor}, shape=other)
    for factor in HOLD_FACTORS:
        hold = factor * (shape.hold_s or shape.rise_s)
        if hold != shape.hold_s:
            words = f"with a hold of {hold:.2g} s" if hold else "without a hold"
            yield setup.with_change(words, {"hold_s": hold}, shape=replace(shape, hold_s=hold))
    for factor in DEPTH_FACTORS:
        quantity, _, unit = setup.run.drive.rpartition("_")
        deep = factor * shape.deep
        changed = replace(shape, deep=deep)
        yield setup.with_change(f"to {deep:.3g} {unit}", {f"{quantity}_{unit}": deep}, shape=changed)
    yield setup.with_change(
        f"{CYCLE_COUNT} times in a row", {"cycles": CYCLE_COUNT}, shape=replace(shape, cycles=CYCLE_COUNT)
    )


def _circuit_variations(setup: PressSetup) -> Iterator[PressSetup]:
    """Presses with another load resistor, or a capacitor across the input; none without a voltage amplifier."""
    readout = setup.run.readout or Readout()
    if not setup.run.voltages or readout.mode != "voltage":
        return
    there = readout.input_resistance_MOhm or np.inf
    for resistance in RESISTORS_MOHM:
        if max(there / resistance, resistance / there) > SAME_RESISTANCE_RATIO:
            yield _with_readout(setup, f"with {resistance:g} MΩ at the input", input_resistance_MOhm=resistance)
    for extra in CAPACITORS_PF:
        capacitance = readout.input_capacitance_pF + extra
        yield _with_readout(setup, f"with {extra:g} pF more across the input", input_capacitance_pF=capacitance)


def _with_readout(setup: PressSetup, words: str, **keys: float) -> PressSetup:
    readout = (setup.run.readout or Readout()).model_copy(update=keys)
    return setup.with_change(words, keys, run=replace(setup.run, readout=readout))


def _place_variations(setup: PressSetup) -> Iterator[PressSetup]:
    """Presses with the dot elsewhere, or with something that keeps a mechanism away."""
    x, y = setup.run.dot_offset_mm
    for offset in OFFSETS_MM:
        run = replace(setup.run, dot_offset_mm=(x + offset, y))
        yield setup.with_change(
            f"with the dot {offset:g} mm further along x", {"dot_offset_mm": [x + offset, y]}, run=run
        )
    for name, entry in vocabulary().items():
        if entry.undone_by is not None:
            words, keys = entry.undone_by
            yield setup.with_change(words, dict(keys), removes=name)


def _load_cell_variation(setup: PressSetup) -> Iterator[PressSetup]:
    """The press with a load cell, where only voltages answer to a displacement."""
    run = setup.run
    if run.drive != "displacement_mm" or LOAD_CELL_CHANNEL in run.channels:
        return
    beside = {LOAD_CELL_CHANNEL: np.full(len(run.time_s), np.nan)}
    run = replace(
        run, channels={**run.channels, **beside}, nuisance={**run.nuisance, "force_gain": LOAD_CELL_GAIN_SIGMA}
    )
    yield setup.with_change("with a load cell", {"records": LOAD_CELL_CHANNEL}, run=run)

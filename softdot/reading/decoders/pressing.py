"""Presses cell by cell: the charges of each press, compared with those that each of the 64 cells would give.

The machine that sets the array down gives the times. Unknown are the gain, which a wrong depth changes too, and the
distance of the array from the middle of the cells.
"""

from dataclasses import dataclass

import numpy as np

from foundation.arrays import Floats, Ints
from foundation.errors import InputError
from softdot.reading.cells import KINDS_OF_CELL
from softdot.reading.conditions import DEFAULT_SHARE_OF_DEPTH
from softdot.reading.line import cell_pitch_mm, dot_places_mm, dots_of_cells
from softdot.reading.voltages import Reader, Voltages, restored_charge_pC

OFFSET_STEPS_MM = (0.8, 0.4, 0.2, 0.1)
"""Steps of the offset around the best one, coarse to fine."""
NEIGHBOUR_PASSES = 2
"""Number of times that cells are found beside the neighbours of the last pass."""
CHUNK_CELLS = 100
"""Cells whose patterns are held together, which bounds the memory."""


@dataclass(frozen=True)
class PressedCells:
    """Charges of presses: charge_pC (c, n) between begin and hold of each, and passed_s (c,), the end of each hold."""

    charge_pC: Floats
    passed_s: Floats


def pressed_cells(reader: Reader, heard: Voltages) -> PressedCells:
    """The charges of an array that is set down cell by cell, from its voltages. InputError for less than one press."""
    assert reader.presses is not None
    period, down, hold = reader.presses.period_s, reader.presses.down_s, reader.presses.hold_s
    count = int((heard.time_s[-1] - down - hold) / period) + 1
    if heard.time_s[-1] < down + hold:
        raise InputError(f"voltages: end after {heard.time_s[-1]:.3g} s, within the first press")
    charge = restored_charge_pC(reader, heard)
    begins: Floats = period * np.arange(count, dtype=np.float64)
    held = begins + down + np.linspace(0.1, 0.9, 9)[:, None] * hold
    before, during = _charges_at(heard, charge, begins[None, :]), _charges_at(heard, charge, held)
    return PressedCells(during.mean(axis=0) - before[0], begins + down + hold)


def _charges_at(heard: Voltages, charge: Floats, time_s: Floats) -> Floats:
    """Charges (..., n) at times of any shape."""
    return np.stack([np.interp(time_s, heard.time_s, one) for one in charge.T], axis=-1)


def most_likely_cells(reader: Reader, seen: PressedCells) -> Ints:
    """Cells (c,) that make the charges most likely under white noise, with their neighbours taken into account."""
    alone = np.zeros(len(seen.charge_pC), dtype=np.int64)
    offset = np.zeros(2)
    best, _, left = _fit_cells(reader, seen.charge_pC, alone, offset, neighbours=False)
    for by in OFFSET_STEPS_MM:
        for step in by * np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]]):
            found = _fit_cells(reader, seen.charge_pC, alone, offset + step, neighbours=False)
            if found[2] < left:
                offset, (best, _, left) = offset + step, found
    for _ in range(NEIGHBOUR_PASSES):
        best = _fit_cells(reader, seen.charge_pC, best, offset, neighbours=True)[0]
    return best


def _fit_cells(
    reader: Reader, charge_pC: Floats, cells: Ints, offset_mm: Floats, neighbours: bool
) -> tuple[Ints, float, float]:
    """The best cells (c,), their gain and the squares that are left, with neighbours as in the given cells."""
    if neighbours:
        parts = range(0, len(cells), CHUNK_CELLS)
        known = np.concatenate(
            [_patterns(reader, cells, np.arange(len(cells))[p : p + CHUNK_CELLS], offset_mm) for p in parts]
        )
    else:
        known = np.broadcast_to(
            _patterns(reader, np.zeros(1, np.int64), np.zeros(1, np.int64), offset_mm),
            (len(cells), KINDS_OF_CELL, charge_pC.shape[1]),
        )
    along, square = np.einsum("cn,ckn->ck", charge_pC, known), np.einsum("ckn,ckn->ck", known, known)
    total = float((charge_pC**2).sum())
    gain = float(
        np.sqrt(np.mean(np.max(charge_pC**2, axis=1)) / max(np.mean(np.max(known[:, -1] ** 2, axis=1)), 1e-300))
    )
    best = cells
    every = np.arange(len(cells))
    for _ in range(5):
        best = np.argmin(gain**2 * square - 2.0 * gain * along, axis=1)
        gain = float(max(along[every, best].sum(), 1e-12) / max(square[every, best].sum(), 1e-12))
    left = total - gain * float(along[every, best].sum())
    return best, gain, left


def _patterns(reader: Reader, cells: Ints, numbers: Ints, offset_mm: Floats) -> Floats:
    """Charges (c, 64, n) of every possible cell at the places of some numbers, beside the given neighbours."""
    places, pitch = dot_places_mm(reader.standard), cell_pitch_mm(reader.standard)
    padded = np.concatenate([[0], cells, [0]])
    there = np.zeros((len(numbers), KINDS_OF_CELL, 3, 6), dtype=bool)
    there[:, :, 0], there[:, :, 2] = (
        dots_of_cells(padded[numbers])[:, None],
        dots_of_cells(padded[numbers + 2])[:, None],
    )
    there[:, :, 1] = dots_of_cells(np.arange(KINDS_OF_CELL))
    x = places[:, 0] + pitch * np.array([-1.0, 0.0, 1.0])[:, None] - offset_mm[0]
    y = np.broadcast_to(places[:, 1] - offset_mm[1], x.shape)
    depth = DEFAULT_SHARE_OF_DEPTH * reader.kernel.depth_mm[-1]
    rows = there.reshape(-1, 18)
    x, y = (np.where(rows, one.ravel(), np.nan) for one in (x, y))
    charge, _ = reader.kernel.of_many(x, y, np.where(rows, depth, np.nan))
    return charge.reshape(len(numbers), KINDS_OF_CELL, -1)

"""Decoder "learned": a small neural network on the voltages around each cell, trained on lines made by the kernel.

It is trained at one speed and depth alone, the usual ones, on random cells: it has seen no other speed, no wear and no
yaw. Its world is the kernel's; a real array is another one. Speed and place are those of the track.
"""

from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np
from sklearn.neural_network import MLPClassifier

from foundation.arrays import Floats
from softdot.reading.cells import KINDS_OF_CELL
from softdot.reading.conditions import ReadingConditions
from softdot.reading.decoders.fitted import Track
from softdot.reading.decoders.model import DecodedCells, trimmed
from softdot.reading.decoders.pressing import PressedCells, pressed
from softdot.reading.line import cell_pitch_mm, cells_from, made_line, raised
from softdot.reading.motion import moved, press_times
from softdot.reading.voltages import Reader, Voltages, recorded

CELLS, SEED = 600, 1
AROUND_MM, STEP_MM = 6.0, 0.5
PLACE_ERRORS_MM = (-0.15, 0.0, 0.15)
"""Each cell is shown at these places too: a track is not exact."""
GAP, GAPS = 4, 0.15
"""Blank cells in a row, and their share: what comes before a line and behind it."""
HIDDEN, ROUNDS, PENALTY = (64,), 300, 1e-2


def decode(reader: Reader, seen: Track | PressedCells) -> DecodedCells:
    """Cells that the network names; it is trained at the first call for a reader."""
    network = _trained(_Hashed(reader), isinstance(seen, PressedCells))
    if isinstance(seen, PressedCells):
        features = _of_presses(seen)
    else:
        middles = cell_pitch_mm(reader.standard) * np.arange(len(seen.passed_s), dtype=np.float64)
        features = _around(seen.heard, seen.place_mm(seen.heard.time_s), middles)
    dots = np.asarray(network.predict(features), dtype=bool)
    return trimmed(cells_from(dots), seen.passed_s)


class _Hashed:
    """A reader as a key of a cache: by what it is, not by what it holds."""

    def __init__(self, reader: Reader) -> None:
        self.reader = reader

    def __hash__(self) -> int:
        return id(self.reader.kernel)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, _Hashed):
            return False
        own, its = self.reader, other.reader
        return own.kernel is its.kernel and (own.readout, own.standard) == (its.readout, its.standard)


@lru_cache(maxsize=4)
def _trained(of: _Hashed, presses: bool) -> Any:
    """The network, trained on random cells at the usual speed and depth."""
    reader, random = of.reader, np.random.default_rng(SEED)
    conditions = ReadingConditions(mode="press" if presses else "slide", standard=reader.standard.name)
    conditions = conditions.resolved(reader.kernel)
    cells = random.integers(0, KINDS_OF_CELL, CELLS)
    cells.reshape(-1, GAP)[random.random(CELLS // GAP) < GAPS] = 0
    line = made_line(cells, reader.standard, conditions, random)
    path = moved(reader.kernel, line, CELLS, reader.standard, conditions, random)
    times = press_times(conditions, cell_pitch_mm(reader.standard)) if presses else None
    heard = recorded(replace(reader, presses=times), line, path, conditions, random)
    if presses:
        features, shown = _of_presses(pressed(replace(reader, presses=times), heard))[:CELLS], raised(cells)
    else:
        place = np.interp(heard.time_s, path.time_s, path.x_mm)
        middles = cell_pitch_mm(reader.standard) * np.arange(CELLS, dtype=np.float64)
        features = np.concatenate([_around(heard, place, middles + error) for error in PLACE_ERRORS_MM])
        shown = np.tile(raised(cells), (len(PLACE_ERRORS_MM), 1))
    network = MLPClassifier(HIDDEN, alpha=PENALTY, max_iter=ROUNDS, early_stopping=True, random_state=SEED)
    return network.fit(features, shown.astype(int))


def _around(heard: Voltages, place_mm: Floats, middles_mm: Floats) -> Floats:
    """Voltages (c, m) at even places around each middle, over their root mean square in the whole line."""
    at = middles_mm[:, None] + np.arange(-AROUND_MM, AROUND_MM + 1e-9, STEP_MM)
    there = np.stack([np.interp(at, place_mm, one) for one in heard.voltage_V.T], axis=-1)
    return np.asarray(there.reshape(len(middles_mm), -1) / max(float(np.sqrt(np.mean(there**2))), 1e-300))


def _of_presses(seen: PressedCells) -> Floats:
    """Charges (c, n) over their root mean square."""
    return np.asarray(seen.charge_pC / max(float(np.sqrt(np.mean(seen.charge_pC**2))), 1e-300))

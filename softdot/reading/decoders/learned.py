"""Decoder "learned": a small neural network on the voltages around each cell, trained on lines made by the kernel.

It is trained at one speed and depth, the default ones, on random cells, without wear and yaw. It knows the kernel's
world alone; a real array is another one. Speed and place are those of the track.
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
from softdot.reading.decoders.model import DecodedCells, trim_blanks
from softdot.reading.decoders.pressing import PressedCells, pressed_cells
from softdot.reading.line import cell_pitch_mm, cells_from, dots_of_cells, manufactured_line
from softdot.reading.motion import array_path, press_times
from softdot.reading.voltages import Reader, Voltages, record_voltages

TRAINING_CELLS, SEED = 600, 1
"""Number of cells on which the network is trained, and the seed of their choice."""
HALF_WINDOW_MM, WINDOW_STEP_MM = 6.0, 0.5
"""Way before and behind the middle of a cell that the network sees, and its step."""
PLACE_ERRORS_MM = (-0.15, 0.0, 0.15)
"""Errors of the place at which each cell is shown in training, as a track is not exact."""
GAP_CELLS, GAP_SHARE = 4, 0.15
"""Blank cells in a row, and their share of all: they stand for what comes before a line and behind it."""
HIDDEN_LAYERS, MOST_EPOCHS, WEIGHT_PENALTY = (64,), 300, 1e-2
"""Nodes of the hidden layers, largest number of epochs, and the penalty on the squares of the weights."""


def decode(reader: Reader, seen: Track | PressedCells) -> DecodedCells:
    """The cells that the network names; it is trained at the first call for a reader."""
    network = _train_network(_ReaderKey(reader), isinstance(seen, PressedCells))
    if isinstance(seen, PressedCells):
        features = _press_features(seen)
    else:
        middles = cell_pitch_mm(reader.standard) * np.arange(len(seen.passed_s), dtype=np.float64)
        features = _slide_features(seen.heard, seen.place_mm(seen.heard.time_s), middles)
    dots = np.asarray(network.predict(features), dtype=bool)
    return trim_blanks(cells_from(dots), seen.passed_s)


class _ReaderKey:
    """A reader as a key of a cache: equal for equal kernel, read-out and standard."""

    def __init__(self, reader: Reader) -> None:
        self.reader = reader

    def __hash__(self) -> int:
        return id(self.reader.kernel)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, _ReaderKey):
            return False
        own, its = self.reader, other.reader
        return own.kernel is its.kernel and (own.readout, own.standard) == (its.readout, its.standard)


@lru_cache(maxsize=4)
def _train_network(of: _ReaderKey, presses: bool) -> Any:
    """The network after its training on random cells at the default speed and depth."""
    reader, random = of.reader, np.random.default_rng(SEED)
    conditions = ReadingConditions(mode="press" if presses else "slide", standard=reader.standard.name)
    conditions = conditions.with_implied_values(reader.kernel)
    cells = random.integers(0, KINDS_OF_CELL, TRAINING_CELLS)
    cells.reshape(-1, GAP_CELLS)[random.random(TRAINING_CELLS // GAP_CELLS) < GAP_SHARE] = 0
    line = manufactured_line(cells, reader.standard, conditions, random)
    path = array_path(reader.kernel, line, TRAINING_CELLS, reader.standard, conditions, random)
    times = press_times(conditions, cell_pitch_mm(reader.standard)) if presses else None
    heard = record_voltages(replace(reader, presses=times), line, path, conditions, random)
    if presses:
        features, shown = (
            _press_features(pressed_cells(replace(reader, presses=times), heard))[:TRAINING_CELLS],
            dots_of_cells(cells),
        )
    else:
        place = np.interp(heard.time_s, path.time_s, path.x_mm)
        middles = cell_pitch_mm(reader.standard) * np.arange(TRAINING_CELLS, dtype=np.float64)
        features = np.concatenate([_slide_features(heard, place, middles + error) for error in PLACE_ERRORS_MM])
        shown = np.tile(dots_of_cells(cells), (len(PLACE_ERRORS_MM), 1))
    network = MLPClassifier(
        HIDDEN_LAYERS, alpha=WEIGHT_PENALTY, max_iter=MOST_EPOCHS, early_stopping=True, random_state=SEED
    )
    return network.fit(features, shown.astype(int))


def _slide_features(heard: Voltages, place_mm: Floats, middles_mm: Floats) -> Floats:
    """Voltages (c, m) at even places around each middle, over their root mean square in the whole line."""
    at = middles_mm[:, None] + np.arange(-HALF_WINDOW_MM, HALF_WINDOW_MM + 1e-9, WINDOW_STEP_MM)
    there = np.stack([np.interp(at, place_mm, one) for one in heard.voltage_V.T], axis=-1)
    return np.asarray(there.reshape(len(middles_mm), -1) / max(float(np.sqrt(np.mean(there**2))), 1e-300))


def _press_features(seen: PressedCells) -> Floats:
    """Charges (c, n) of presses over their root mean square."""
    return np.asarray(seen.charge_pC / max(float(np.sqrt(np.mean(seen.charge_pC**2))), 1e-300))

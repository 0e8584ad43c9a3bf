"""Lines that are simulated and read in one call."""

import numpy as np

from softdot.reading.conditions import ReadingConditions, standard_of
from softdot.reading.decoders import DECODERS, decoder_input
from softdot.reading.line import manufactured_line
from softdot.reading.motion import array_path, press_times
from softdot.reading.voltages import Reader, record_voltages
from solve.model import Readout

READOUT = Readout(input_resistance_MOhm=10.0)
NOMINAL = {"height_scatter_mm": 0.0, "position_scatter_mm": 0.0, "tremor_um": 0.0, "noise_mV": 0.0}


def simulated(kernel, cells, readout=READOUT, change=None, **conditions):
    """The reader and what it hears of cells; change : of the line before it is passed."""
    known = ReadingConditions(**conditions).with_implied_values(kernel)
    chosen = standard_of(kernel, known.standard)
    random = np.random.default_rng(known.seed)
    line = manufactured_line(cells, chosen, known, random)
    line = line if change is None else change(line)
    path = array_path(kernel, line, len(cells), chosen, known, random)
    reader = Reader(kernel, chosen, readout, press_times(known, 6.0) if known.mode == "press" else None)
    return reader, record_voltages(reader, line, path, known, random)


def read(reader, heard, name="model"):
    """Cells that a decoder names; it is given the reader and the voltages, and nothing else."""
    return DECODERS[name](reader, decoder_input(reader, heard)).cells


def share(cells, found):
    """Of the cells that were read, 0 where their number is wrong."""
    return float(np.mean(found == cells)) if len(found) == len(cells) else 0.0

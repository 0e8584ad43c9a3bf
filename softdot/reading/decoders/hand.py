"""Decoder "hand": the track of a slide by hand, and its cells, as softdot.reading.line_filter finds them."""

from dataclasses import dataclass

import numpy as np

from foundation.arrays import Floats, Ints
from softdot.reading.decoders.model import DecodedCells
from softdot.reading.decoders.onset import NoDotError
from softdot.reading.lead_order import likelier_order, silent_rows
from softdot.reading.line import cell_pitch_mm
from softdot.reading.line_filter.line_reader import CERTAIN, LineReader, LineReport
from softdot.reading.voltages import Reader, Voltages

PART_SAMPLES = 4096
"""Voltages that are pushed at once, which bounds the memory."""
LEAST_CERTAIN_SHARE, CELLS_A_LOSS = 0.5, 8
"""Share of certain cells, and number of cells for each loss of the track, below which what was heard is no line of
Braille under this array.
"""


@dataclass(frozen=True)
class HandTrack:
    """The track of a slide over a line, and the cells that were read on the way.

    cells, probability, passed_s (c,) : the most likely cells from left to right, -1 where
    one passed without contact, their probabilities, and when the array's middle passed each. shares (c, 64) :
    probability of each kind of cell. course_s, course_mm (t,) :
    place of the array's middle from the first cell that was met, in the direction of its motion.
    """

    report: LineReport
    heard: Voltages
    pitch_mm: float
    cells: Ints
    probability: Floats
    passed_s: Floats
    shares: Floats
    course_s: Floats
    course_mm: Floats

    @property
    def speed_mm_per_s(self) -> float:
        """Mean speed along the line, pauses and ways back included."""
        seconds = float(np.ptp(self.passed_s)) if len(self.passed_s) > 1 else 0.0
        if seconds > 0.0:
            return self.pitch_mm * (len(self.passed_s) - 1) / seconds
        return float(np.ptp(self.course_mm) / max(np.ptp(self.course_s), 1e-12))

    @property
    def is_braille(self) -> bool:
        """Whether what was heard fits a line of Braille under the array of the kernel."""
        certain = float(np.mean(self.probability >= CERTAIN))
        return certain >= LEAST_CERTAIN_SHARE and self.report.lost * CELLS_A_LOSS <= len(self.cells)

    @property
    def is_whole(self) -> bool:
        """Whether it is a line of Braille as text has it, and no cell is uncertain because the track was lost."""
        return self.is_text and (self.report.lost == 0 or bool((self.probability >= CERTAIN).all()))

    @property
    def is_text(self) -> bool:
        """Whether it is a line of Braille whose cells are no less usual than those of text."""
        return self.is_braille and self.exchanged is None and not self.silent_rows

    @property
    def silent_rows(self) -> list[int]:
        """Rows of dots, from 1, of which the line has none."""
        return silent_rows(self.cells[self.probability >= CERTAIN])

    @property
    def exchanged(self) -> str | None:
        """How the rows or columns of the leads seem to be exchanged as a whole, in words; None where they do not."""
        return likelier_order(self.cells[self.probability >= CERTAIN])

    def place_mm(self, time_s: Floats) -> Floats:
        """Place (t,) of the array's middle from the leftmost cell; before and behind the line it stays."""
        place = np.interp(time_s, self.course_s, self.course_mm)
        return self.pitch_mm * (len(self.cells) - 1) - place if self.report.leftward else place


def track_hand(reader: Reader, heard: Voltages) -> HandTrack:
    """The track of a sliding array from its voltages. NoDotError where nothing stands out of their noise."""
    line = LineReader(reader.kernel, reader.standard, reader.readout, 1.0 / heard.step_s, float(heard.time_s[0]))
    line.course = []
    found = []
    for begin in range(0, len(heard.time_s), PART_SAMPLES):
        found += line.push(heard.voltage_V[begin : begin + PART_SAMPLES])
    found += line.finish()
    report = line.report
    if report is None or not found:
        raise NoDotError("voltages: nothing stands out of their noise; there is no dot to read")
    course = np.array(line.course)
    pitch = cell_pitch_mm(reader.standard)
    first = found[0].number
    order = found[::-1] if report.leftward else found
    return HandTrack(
        report, heard, pitch, np.array([one.cell for one in order], dtype=np.int64),
        np.array([one.probability for one in order]), np.array([one.time_s for one in order]),
        np.array([one.shares for one in order]), course[:, 0], course[:, 1] - pitch * first,
    )  # fmt: skip


def decode(track: HandTrack) -> DecodedCells:
    """The cells that are certain, -1 for the others; none is where what was heard is no text."""
    certain = np.where((track.probability >= CERTAIN) & track.is_text, track.cells, -1)
    return DecodedCells(certain, track.passed_s, track.cells, track.probability, track.shares)

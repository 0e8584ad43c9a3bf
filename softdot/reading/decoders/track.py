"""The track of a slide over a line, as softdot.reading.line_filter finds it from the voltages alone."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from foundation.arrays import Floats, Ints
from foundation.errors import InputError
from softdot.reading.line import cell_pitch_mm
from softdot.reading.line_filter.line_reader import CERTAIN, LineReader, LineReport
from softdot.reading.line_filter.mains import BANDWIDTH_HZ, hum_frequency_Hz, hum_state, without_hum
from softdot.reading.voltages import Reader, Voltages

PART_SAMPLES = 4096
"""Voltages that are pushed at once, which bounds the memory."""
LEAST_CERTAIN_SHARE, CELLS_A_LOSS = 0.5, 8
"""Share of certain cells, and number of cells for each loss of the track, below which what was heard is no line of
Braille under this array.
"""
HUM_S = 10.0
"""Time from which the hum of a whole recording is first taken."""


class NoDotError(InputError):
    """Raised where nothing stands out of the noise."""


@dataclass(frozen=True)
class Track:
    """The track of a slide over a line, and the cells that were read on the way.

    cells, probability, passed_s (c,) : the most likely cells from left to right, -1 where
    one passed without contact, their probabilities, and when the array's middle passed each. course_s, course_mm (t,) :
    place of the array's middle from the first cell that was met, in the direction of its motion.
    """

    report: LineReport
    heard: Voltages
    pitch_mm: float
    cells: Ints
    probability: Floats
    passed_s: Floats
    course_s: Floats
    course_mm: Floats

    @cached_property
    def quiet(self) -> Voltages:
        """The voltages less the hum of the whole recording."""
        rate = 1.0 / self.heard.step_s
        begin = self.heard.voltage_V[: round(HUM_S * rate)]
        hum = hum_state(begin, rate, hum_frequency_Hz(begin, rate))
        rest = without_hum(self.heard.voltage_V, *hum, 2.0 * np.pi * BANDWIDTH_HZ / rate)
        return Voltages(self.heard.time_s, rest)

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
        """Whether it is a line of Braille, and no cell is uncertain because the track was lost."""
        return self.is_braille and (self.report.lost == 0 or bool((self.probability >= CERTAIN).all()))

    def place_mm(self, time_s: Floats) -> Floats:
        """Place (t,) of the array's middle from the leftmost cell; before and behind the line it stays."""
        place = np.interp(time_s, self.course_s, self.course_mm)
        return self.pitch_mm * (len(self.cells) - 1) - place if self.report.leftward else place

    def first_passing(self) -> tuple[Floats, Ints]:
        """Rising places (k,) from the leftmost cell, and the samples (k,) that first were there."""
        along = np.interp(self.heard.time_s, self.course_s, self.course_mm)
        farthest = np.maximum.accumulate(along)
        new = np.flatnonzero(np.diff(farthest, prepend=-np.inf) > 0.0)
        if self.report.leftward:
            new = new[::-1]
        return self.place_mm(self.heard.time_s[new]), new


def track_slide(reader: Reader, heard: Voltages) -> Track:
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
    return Track(
        report, heard, pitch, np.array([one.cell for one in order], dtype=np.int64),
        np.array([one.probability for one in order]), np.array([one.time_s for one in order]),
        course[:, 0], course[:, 1] - pitch * first,
    )  # fmt: skip

"""A reader that is given voltages bit by bit, and gives out cells with their time and probability."""

from dataclasses import dataclass, field

import numpy as np

from foundation.arrays import Floats
from foundation.errors import InputError
from geometry.braille_standards import BrailleStandard
from softdot.arrays.kernel import ArrayKernel
from softdot.reading.cells import KINDS_OF_CELL
from softdot.reading.line_filter.channels import Channels, first_signal, measured_channels
from softdot.reading.line_filter.charge import ChargeBlocks
from softdot.reading.line_filter.givens import Sensor
from softdot.reading.line_filter.hypotheses import at_the_first_column, inside
from softdot.reading.line_filter.line_filter import FLOOR_SHARE, LOST_FIT, LineFilter, PassedCell
from softdot.reading.line_filter.mains import BANDWIDTH_HZ, FREQUENCY, hum_frequency_Hz, hum_state, without_hum
from softdot.reading.line_filter.table import LineTable, line_table
from solve.model import Readout
from solve.readout.amplifier import input_of

CHECK_S, KEPT_QUIET_S = 0.25, 1.5
"""Time between looks for a line that begins, and how much of the silence before it is kept."""
LEAST_S, LEAST_WAY_MM, MOST_S = 1.0, 25.0, 10.0
"""What is heard of a line before its channels are measured: a time and a way at least, or a longer time."""
BLOCK_MM, LONGEST_BLOCK_S = 0.4, 0.05
"""Way and time that charges are averaged over, at most."""
CORRELATED_MM, LEAST_TEMPER = 1.2, 0.03
"""Way over which errors of the kernel are alike, so that it counts as one measurement; least share of one in a step."""
DIRECTION_EVIDENCE, DIRECTION_COLUMNS = 25.0, 6
"""Logarithm of the evidence that decides the direction, or columns after which the better one is taken."""
DRIFT_SHARE = 7e-4
"""Least standard deviation of the drift in a step, over the largest charge of one dot."""
SLOPE_V_PER_S, SLOPES, DRIFT_S = 4e-5, 2.0, 10.0
"""By how much a resting voltage is taken to change in a second, at least and over what the first seconds say, and the
time in which that changes, assumed.
"""
LOST_PROBABILITY, UNFELT_PROBABILITY = 0.5, 0.85
"""Of a cell at most where the fit was bad, and where no segment felt one of its rows of dots."""
CERTAIN = 0.9
"""Least probability of a cell that is given out as read."""
MIRRORED = np.arange(KINDS_OF_CELL) >> 3 | (np.arange(KINDS_OF_CELL) & 7) << 3
"""The cells (64,) with left and right column exchanged."""


@dataclass(frozen=True)
class ReadCell:
    """A cell that was read.

    number : of the cell in the order of reading, from 0; they are given out in this order, from right to left where
    the array moved so. cell : from 0 to 63, the most likely one; -1 where it passed without contact. probability : that
    this is right; below CERTAIN it is not to be trusted. time_s : when the array's middle passed it. shares (64,) :
    probability of each cell.
    """

    number: int
    cell: int
    probability: float
    time_s: float
    shares: Floats = field(compare=False, repr=False)


@dataclass(frozen=True)
class LineReport:
    """What a reader knows of the line besides its cells; None before a line began.

    leftward : the array moves from right to left. hum_Hz : None without hum. gain (n,) : of each channel beside the
    kernel's, with its polarity; width : of the sensor's response over the kernel's. dead : numbers of channels from 1.
    offset_mm, yaw_deg : of now. lost : how often the track was lost. beside : number of cells at which the array was
    more than reach_mm beside the line, where no segment feels one of its rows of dots.
    """

    leftward: bool
    begin_s: float
    hum_Hz: float | None
    gain: Floats
    width: float
    dead: tuple[int, ...]
    resting_V: Floats
    noise_V: Floats
    offset_mm: float
    yaw_deg: float
    lost: int
    reach_mm: float
    beside: int


class LineReader:
    """Reads the cells of a line from voltages that are pushed as they come.

    It knows the kernel, the standard and the read-out, and finds out all else. The first seconds of a line are kept
    until they tell gains and speed; from then on a cell is given out two cells behind. Parts of any length give the
    same cells to the last bit.
    """

    def __init__(
        self, kernel: ArrayKernel, chosen: BrailleStandard, readout: Readout, sampling_Hz: float, begin_s: float = 0.0
    ) -> None:
        self._kernel, self._readout, self._rate = kernel, readout, sampling_Hz
        self._tables = [line_table(kernel, chosen, mirrored) for mirrored in (False, True)]
        self._used = self._tables[0].channels
        self._circuit = _circuit(kernel, readout, self._used)
        self._waiting = np.empty((0, len(self._used)))
        self._begin_s, self._checked = begin_s, 0
        self._filters: list[LineFilter] = []
        self._channels: Channels | None = None
        self._blanks: list[PassedCell] = []
        self._beside = 0
        self.course: list[tuple[float, float]] | None = None

    def push(self, voltage_V: Floats) -> list[ReadCell]:
        """Take the next voltages (t, n) of all segments, and return the cells that are certain enough to be given out.

        InputError for another number of channels, and for voltages that are not finite.
        """
        if voltage_V.ndim != 2 or voltage_V.shape[1] != len(self._kernel.centres_mm):
            raise InputError(
                f"voltages: have the size {voltage_V.shape}, the kernel has {len(self._kernel.centres_mm)} segments"
            )
        if not np.isfinite(voltage_V).all():
            raise InputError("voltages: hold a number that is not finite")
        self._waiting = np.concatenate([self._waiting, voltage_V[:, self._used]])
        if self._channels is None and not self._begins(at_end=False):
            return []
        return self._read_on(at_end=False)

    def finish(self) -> list[ReadCell]:
        """The cells that are left at the end of the voltages."""
        if self._channels is None and not self._begins(at_end=True):
            return []
        return self._read_on(at_end=True)

    @property
    def report(self) -> LineReport | None:
        """What is known of the line so far."""
        if self._channels is None:
            return None
        best, channels = self._better, self._channels
        hum = float(self._hum[0][FREQUENCY]) * self._rate / (2.0 * np.pi)
        dead = tuple(int(self._used[k]) + 1 for k in np.flatnonzero(~channels.alive))
        return LineReport(
            best.table.is_mirrored, self._line_begin_s, hum or None, channels.gain * best.gain, best.width, dead,
            channels.resting_V, channels.noise_V, best.offset_mm, best.yaw_deg, best.losses,
            best.table.reach_mm, self._beside,
        )  # fmt: skip

    @property
    def _better(self) -> LineFilter:
        return max(self._filters, key=lambda one: one.evidence)

    def _begins(self, at_end: bool) -> bool:
        """Whether enough of a line was heard; then everything is ready to read it. Looks at fixed times."""
        every = max(1, round(CHECK_S * self._rate))
        while len(self._waiting) - self._checked >= every:
            self._checked += every
            if self._try_to_begin(self._checked, at_end=False):
                return True
        return at_end and len(self._waiting) > 4 and self._try_to_begin(len(self._waiting), at_end=True)

    def _try_to_begin(self, count: int, at_end: bool) -> bool:
        """Whether the first count samples that wait hold enough of a line; older silence is let go."""
        voltage, step = self._waiting[:count], 1.0 / self._rate
        hum = hum_state(voltage, self._rate, hum_frequency_Hz(voltage, self._rate))
        quiet = without_hum(voltage, hum[0].copy(), hum[1].copy(), self._bandwidth)
        onset = first_signal(quiet, step)
        if onset is None:
            gone = count - round(KEPT_QUIET_S * self._rate)
            if gone > 0 and not at_end:
                self._waiting, self._checked = self._waiting[gone:], self._checked - gone
                self._begin_s += gone * step
            return False
        places = self._kernel.centres_mm[self._used]
        channels = measured_channels(quiet, onset, step, self._circuit, self._tables[0], places)
        heard_s = (count - onset) * step
        enough = heard_s >= LEAST_S and heard_s * channels.speed_mm_per_s >= LEAST_WAY_MM
        if not (enough or heard_s >= MOST_S or at_end):
            return False
        self._begin(channels, hum, quiet)
        return True

    @property
    def _bandwidth(self) -> float:
        return 2.0 * np.pi * BANDWIDTH_HZ / self._rate

    def _begin(self, channels: Channels, hum: tuple[Floats, Floats], quiet: Floats) -> None:
        """Make the filters of both directions for a line whose channels are known."""
        self._channels, self._hum = channels, hum
        samples = int(max(1, min(BLOCK_MM / channels.speed_mm_per_s, LONGEST_BLOCK_S) * self._rate))
        capacitance, resistance = self._circuit
        self._blocks = ChargeBlocks(
            capacitance / channels.gain, resistance * channels.gain, channels.resting_V, samples, 1.0 / self._rate
        )
        self._skip = 0 if channels.is_inside else max(0, channels.onset - round(0.004 * self._rate)) // samples
        before = self._copy_of_blocks().add(quiet[: len(quiet) // samples * samples])
        if channels.is_inside:
            self._zero = np.quantile(before, 0.1, axis=0)
        else:
            self._zero = before[max(0, self._skip - 5) : self._skip + 1].mean(axis=0)
        self._line_begin_s = self._begin_s + self._skip * samples / self._rate
        self._done = 0
        self._last = self._zero * 0.0
        self._filters = [self._filter(table, channels, samples / self._rate) for table in self._tables]

    def _copy_of_blocks(self) -> ChargeBlocks:
        own = self._blocks
        return ChargeBlocks(own.capacitance_F, own.resistance_Ohm, own.resting_V, own.samples, own.step_s)

    def _filter(self, table: LineTable, channels: Channels, step_s: float) -> LineFilter:
        """A filter that begins with the first column, or anywhere on a line."""
        gain = np.abs(channels.gain)
        walk = 1e12 * channels.noise_V * np.sqrt(step_s / self._rate) / np.abs(self._circuit[1]) / gain
        drift = np.hypot(walk, DRIFT_SHARE * table.largest_pC)
        slope = max(SLOPES * channels.slope_V_per_s, SLOPE_V_PER_S)
        bend = 1e12 * slope * step_s**2 * np.sqrt(2.0 * step_s / DRIFT_S) / np.abs(self._circuit[1]) / gain
        noise = 1e12 * np.abs(self._circuit[0]) * channels.noise_V / gain
        floor = (FLOOR_SHARE * table.largest_pC) ** 2 + noise**2
        sensor = Sensor(
            table.lone, table.beside, table.within, table.dot_pitch_mm, table.cell_pitch_mm, channels.alive,
            floor, drift, bend, table.felt_mm(FLOOR_SHARE),
        )  # fmt: skip
        begin = inside if channels.is_inside else at_the_first_column
        return LineFilter(table, sensor, step_s, begin(table, channels.speed_mm_per_s, len(self._used)))

    def _read_on(self, at_end: bool) -> list[ReadCell]:
        """Read all whole blocks that wait."""
        samples = self._blocks.samples
        whole = len(self._waiting) // samples * samples
        voltage, self._waiting = self._waiting[:whole], self._waiting[whole:]
        charges = self._blocks.add(without_hum(voltage, *self._hum, self._bandwidth))
        found: list[ReadCell] = []
        for charge in charges:
            if self._done >= self._skip:
                self._take(charge - self._zero)
                found += self._given_out(self._filters[0].ready_cells()) if len(self._filters) == 1 else []
            self._done += 1
        if at_end and self._done > self._skip:
            self._filters = [self._better]
            found += self._given_out(self._filters[0].ready_cells(at_end=True))
        return found

    def _take(self, charge_pC: Floats) -> None:
        """One step of all filters with the charges (n,) of a block."""
        step_s = self._blocks.samples / self._rate
        time_s = self._begin_s + (self._done + 0.5) * step_s
        better = self._better
        change = np.abs(charge_pC - self._last)[better.sensor.alive].max() / better.table.largest_pC * 1.5
        self._last = charge_pC
        way = max(abs(better.speed_mm_per_s) * step_s, change)
        temper = float(np.clip(way / CORRELATED_MM, LEAST_TEMPER, 1.0))
        for one in self._filters:
            one.step(charge_pC, temper, time_s)
        better = self._better
        if self.course is not None:
            self.course.append((time_s, better.place_mm - 0.5 * better.table.dot_pitch_mm))
        if len(self._filters) > 1:
            self._choose_direction()

    def _choose_direction(self) -> None:
        """Keep the better direction alone as soon as it is clear."""
        first, second = self._filters
        is_late = self._better.columns_seen >= DIRECTION_COLUMNS
        if is_late or abs(first.evidence - second.evidence) > DIRECTION_EVIDENCE:
            self._filters = [self._better]

    def _given_out(self, passed: list[PassedCell]) -> list[ReadCell]:
        """The cells up to the last one with a dot; those without wait for the next one with one."""
        found: list[ReadCell] = []
        for one in passed:
            self._blanks.append(one)
            if one.cell > 0:
                found += [self._read_cell(each) for each in self._blanks]
                self._blanks = []
        return found

    def _read_cell(self, passed: PassedCell) -> ReadCell:
        """The cell as it is given out, in the order of reading."""
        reach = self._filters[0].table.reach_mm
        self._beside += passed.aside_mm > reach
        cell, shares, stated = passed.cell, passed.shares, stated_probability(passed, reach)
        if passed.probability > 1.0 / KINDS_OF_CELL:  # what the stated one is less is any other cell
            left = (stated - 1.0 / KINDS_OF_CELL) / (passed.probability - 1.0 / KINDS_OF_CELL)
            shares = max(left, 0.0) * shares + (1.0 - max(left, 0.0)) / KINDS_OF_CELL
        if self._filters[0].table.is_mirrored:
            cell = MIRRORED[cell] if cell > 0 else cell
            shares = shares[MIRRORED]
        return ReadCell(passed.number, int(cell), stated, passed.time_s, shares)


def stated_probability(passed: PassedCell, reach_mm: float) -> float:
    """The probability that a cell is right: that of the hypotheses, less where the fit was bad or the array was farther
    beside the line than it reaches.
    """
    if passed.worst_fit > LOST_FIT:
        return min(passed.probability, LOST_PROBABILITY)
    return min(passed.probability, UNFELT_PROBABILITY) if passed.aside_mm > reach_mm else passed.probability


def _circuit(kernel: ArrayKernel, readout: Readout, used: np.ndarray) -> tuple[Floats, Floats]:
    """Capacitances in F and resistances in Ohm of the segments in use, seen behind the gain of the amplifier."""
    pairs = [input_of(readout, 1e-12 * float(kernel.capacitance_pF[k])) for k in used]
    capacitance, resistance = np.array(pairs).T
    return capacitance / readout.gain, resistance * readout.gain

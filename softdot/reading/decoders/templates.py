"""What a decoder expects: voltages of single dots that pass, and how they overlap."""

from dataclasses import dataclass
from math import cos, radians, sin

import numpy as np
from scipy.ndimage import map_coordinates, spline_filter1d
from scipy.signal import correlate

from geometry.arrays import Floats, Ints
from softdot.reading.conditions import USUAL_SHARE_OF_DEPTH
from softdot.reading.line import dot_places_mm
from softdot.reading.motion import reach_mm
from softdot.reading.voltages import Reader, Voltages, behind_readout
from solve.readout.amplifier import input_of

ROWS = 3
SAMPLE_MM = 0.1
"""Path to which samples are averaged before they are compared with templates; finer ones say nothing more."""
FINE_MM = 0.02
TAIL_TIMES, LONGEST_TAIL_MM = 5.0, 12.0
"""A template goes on for so many time constants of the input, but no further than two cells."""


@dataclass(frozen=True)
class Posture:
    """How the array passes, but for its place: speed, offset across the line and yaw."""

    speed_mm_per_s: float
    offset_mm: float = 0.0
    yaw_deg: float = 0.0


@dataclass(frozen=True)
class DotTemplates:
    """Voltage (m, 3, n) of a dot in each row at times first_s + i step_s after the array's middle has passed it."""

    posture: Posture
    first_s: float
    step_s: float
    voltage_V: Floats

    def overlap(self) -> "Lagged":
        """Inner products (l, 3, 3) of a dot of the first row with one of the second, lag s later."""
        count = len(self.voltage_V)
        table = np.zeros((2 * count - 1, ROWS, ROWS))
        for r in range(ROWS):
            for s in range(ROWS):
                table[:, r, s] = sum(
                    correlate(self.voltage_V[:, r, e], self.voltage_V[:, s, e], method="fft")
                    for e in range(self.voltage_V.shape[2])
                )
        return lagged(table, -(count - 1) * self.step_s, self.step_s)

    def matched(self, heard: Voltages) -> "Lagged":
        """Inner products (l, 3) of the voltages with a dot of each row that is passed at a time."""
        table = np.stack(
            [
                sum(
                    correlate(heard.voltage_V[:, e], self.voltage_V[:, r, e], method="fft")
                    for e in range(self.voltage_V.shape[2])
                )
                for r in range(ROWS)
            ],
            axis=1,
        )
        begin = heard.time_s[0] - (len(self.voltage_V) - 1) * self.step_s - self.first_s
        return lagged(table, begin, self.step_s)


@dataclass(frozen=True)
class Lagged:
    """A smooth function of time, known at first_s + i step_s, and zero beyond; coefficients of its cubic spline."""

    first_s: float
    step_s: float
    coefficients: Floats

    def at(self, time_s: Floats, *column: Ints) -> Floats:
        """Values at times of any shape, of columns (of the table's trailing axes) that fit to it."""
        where = (np.asarray(time_s, dtype=np.float64) - self.first_s) / self.step_s
        places = np.broadcast_arrays(where, *column)
        result = np.zeros(places[0].shape)
        for index in np.ndindex(self.coefficients.shape[1:]):
            mask = np.logical_and.reduce([given == one for given, one in zip(places[1:], index, strict=True)])
            spline = self.coefficients[(slice(None), *index)]
            result[mask] = map_coordinates(spline, [places[0][mask]], order=3, mode="constant", prefilter=False)
        return result


def lagged(table: Floats, first_s: float, step_s: float) -> Lagged:
    """The spline through a table (l, ...)."""
    return Lagged(first_s, step_s, spline_filter1d(table, order=3, axis=0, mode="constant"))


def averaged(heard: Voltages, speed_mm_per_s: float) -> tuple[Voltages, int]:
    """Means of so many samples that one spans at most SAMPLE_MM at this speed; and how many."""
    many = max(1, int(SAMPLE_MM / (speed_mm_per_s * heard.step_s)))
    count = len(heard.time_s) // many
    if many == 1 or count < 4:
        return heard, 1
    shape = (count, many)
    voltage = heard.voltage_V[: count * many].reshape(*shape, -1).mean(axis=1)
    return Voltages(heard.time_s[: count * many].reshape(shape).mean(axis=1), voltage), many


def templates(reader: Reader, posture: Posture, step_s: float, many: int = 1) -> DotTemplates:
    """Templates at samples that are each the mean of so many, step_s apart before that.

    The charge of a dot alone, USUAL_SHARE_OF_DEPTH of the kernel's depth deep, goes through the read-out at the speed.
    """
    speed, kernel = posture.speed_mm_per_s, reader.kernel
    fine_s = step_s / max(1, int(np.ceil(step_s * speed / FINE_MM)))
    reach = reach_mm(kernel, posture.yaw_deg) + 0.5
    longest = LONGEST_TAIL_MM / speed
    capacitance, resistance = input_of(reader.readout, 1e-12 * float(kernel.capacitance_pF.max()))
    tail = min(TAIL_TIMES * capacitance * resistance, longest)
    before, behind = int(np.ceil(reach / speed / step_s)), int(np.ceil((reach / speed + tail) / step_s))
    at: Floats = step_s * np.arange(-before, behind + 1 + many, dtype=np.float64)
    parts = round(step_s / fine_s)
    time = at[0] + fine_s * np.arange(parts * (len(at) - 1) + 1)
    charge = np.stack([_charge(reader, posture, y, time) for y in _row_places_mm(reader)])
    voltage = np.stack([behind_readout(reader, time, one, at, fine_s) for one in charge], axis=1)
    if many > 1:
        groups = len(at) // many
        voltage = voltage[: groups * many].reshape(groups, many, *voltage.shape[1:]).mean(axis=1)
        at = at[: groups * many].reshape(groups, many).mean(axis=1)
    return DotTemplates(posture, float(at[0]), many * step_s, voltage)


def _row_places_mm(reader: Reader) -> Floats:
    """Places across the line of the three rows."""
    return dot_places_mm(reader.standard)[:ROWS, 1]


def _charge(reader: Reader, posture: Posture, row_mm: float, time_s: Floats) -> Floats:
    """Charge (t, n) of one dot of a row while the array passes it."""
    along, across = -posture.speed_mm_per_s * time_s, row_mm - posture.offset_mm
    angle = radians(posture.yaw_deg)
    x = cos(angle) * along + sin(angle) * across
    y = cos(angle) * across - sin(angle) * along
    depth = np.full(len(time_s), USUAL_SHARE_OF_DEPTH * reader.kernel.depth_mm[-1])
    return reader.kernel.of_one(x, y, depth)[0]

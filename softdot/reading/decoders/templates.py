"""The voltages that a decoder expects from single dots that are passed, and how they overlap."""

from dataclasses import dataclass
from math import cos, radians, sin

import numpy as np
from scipy.fft import irfft, next_fast_len, rfft
from scipy.ndimage import map_coordinates, spline_filter1d

from foundation.arrays import Floats, Ints
from softdot.reading.conditions import DEFAULT_SHARE_OF_DEPTH
from softdot.reading.line import dot_places_mm
from softdot.reading.motion import reach_mm
from softdot.reading.voltages import Reader, Voltages, readout_voltages
from solve.readout.amplifier import input_of

DOT_ROWS = 3
"""Rows of dots in a cell."""
SAMPLE_MM = 0.1
"""Way over which samples are averaged before they are compared with templates; finer ones contain nothing more."""
PASSING_STEP_MM, PASSING_MARGIN_MM = 0.02, 0.5
"""Step of the places at which a dot is passed, and their margin beyond the reach of the array."""
TAIL_TIME_CONSTANTS, LONGEST_TAIL_MM = 5.0, 12.0
"""Time constants of the input for which a template goes on, but no further than two cells."""


@dataclass(frozen=True)
class Posture:
    """How the array passes a line, but for its place: speed, offset across the line and yaw."""

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

    def overlap(self) -> "LagSpline":
        """Inner products (l, 3, 3) of a dot of the first row with one of the second, lag s later."""
        count = len(self.voltage_V)
        size = next_fast_len(2 * count - 1, real=True)
        spectrum = rfft(self.voltage_V, size, axis=0)
        product = np.einsum("fre,fse->frs", spectrum, spectrum.conj())
        table = np.roll(irfft(product, size, axis=0), count - 1, axis=0)[: 2 * count - 1]
        return lag_spline(table, -(count - 1) * self.step_s, self.step_s)

    def match(self, heard: Voltages) -> "LagSpline":
        """Inner products (l, 3) of the voltages with a dot of each row that is passed at a time."""
        samples, count = len(heard.time_s), len(self.voltage_V)
        size = next_fast_len(samples + count - 1, real=True)
        spectrum, own = rfft(heard.voltage_V, size, axis=0), rfft(self.voltage_V, size, axis=0)
        product = np.einsum("fe,fre->fr", spectrum, own.conj())
        table = np.roll(irfft(product, size, axis=0), count - 1, axis=0)[: samples + count - 1]
        begin = heard.time_s[0] - (count - 1) * self.step_s - self.first_s
        return lag_spline(table, begin, self.step_s)


@dataclass(frozen=True)
class LagSpline:
    """A smooth function of time, known at first_s + i step_s by coefficients of its cubic spline, and zero beyond."""

    first_s: float
    step_s: float
    coefficients: Floats

    def at(self, time_s: Floats, *column: Ints) -> Floats:
        """Values at times of any shape, of columns (of the table's trailing axes) that broadcast with them."""
        where = (np.asarray(time_s, dtype=np.float64) - self.first_s) / self.step_s
        places = np.broadcast_arrays(where, *column)
        result = np.zeros(places[0].shape)
        for index in np.ndindex(self.coefficients.shape[1:]):
            mask = np.logical_and.reduce([given == one for given, one in zip(places[1:], index, strict=True)])
            spline = self.coefficients[(slice(None), *index)]
            result[mask] = map_coordinates(spline, [places[0][mask]], order=3, mode="constant", prefilter=False)
        return result


def lag_spline(table: Floats, first_s: float, step_s: float) -> LagSpline:
    """The spline through a table (l, ...) at even times."""
    return LagSpline(first_s, step_s, spline_filter1d(table, order=3, axis=0, mode="constant"))


def average_samples(heard: Voltages, speed_mm_per_s: float) -> tuple[Voltages, int]:
    """Means of the voltages over samples that span at most SAMPLE_MM at this speed, and their number in a mean."""
    many = max(1, int(SAMPLE_MM / (speed_mm_per_s * heard.step_s)))
    count = len(heard.time_s) // many
    if many == 1 or count < 4:
        return heard, 1
    shape = (count, many)
    voltage = heard.voltage_V[: count * many].reshape(*shape, -1).mean(axis=1)
    return Voltages(heard.time_s[: count * many].reshape(shape).mean(axis=1), voltage), many


def templates(reader: Reader, posture: Posture, step_s: float, many: int = 1) -> DotTemplates:
    """Templates at samples that are each the mean of `many` samples, step_s apart before averaging.

    The charge of a dot alone, DEFAULT_SHARE_OF_DEPTH of the kernel's depth deep, goes through the read-out at the
    speed.
    """
    speed, kernel = posture.speed_mm_per_s, reader.kernel
    place, charge = _passing(reader, posture)
    reach = float(place[-1])
    longest = LONGEST_TAIL_MM / speed
    capacitance, resistance = input_of(reader.readout, 1e-12 * float(kernel.capacitance_pF.max()))
    tail = min(TAIL_TIME_CONSTANTS * capacitance * resistance, longest)
    before, behind = int(np.ceil(reach / speed / step_s)), int(np.ceil((reach / speed + tail) / step_s))
    at: Floats = step_s * np.arange(-before, behind + 1 + many, dtype=np.float64)
    voltage = np.stack(
        [readout_voltages(reader, place / speed, one, at, PASSING_STEP_MM / speed) for one in charge], axis=1
    )
    if many > 1:
        groups = len(at) // many
        voltage = voltage[: groups * many].reshape(groups, many, *voltage.shape[1:]).mean(axis=1)
        at = at[: groups * many].reshape(groups, many).mean(axis=1)
    return DotTemplates(posture, float(at[0]), many * step_s, voltage)


def _passing(reader: Reader, posture: Posture) -> tuple[Floats, Floats]:
    """Places (m,) of the array's middle behind a dot, mm, and charges (3, m, n) of a dot of each row there."""
    key = posture.offset_mm, posture.yaw_deg
    if key not in reader.passing:
        reach = reach_mm(reader.kernel, posture.yaw_deg) + PASSING_MARGIN_MM
        place: Floats = PASSING_STEP_MM * np.arange(
            -np.ceil(reach / PASSING_STEP_MM), np.ceil(reach / PASSING_STEP_MM) + 1.0
        )
        angle = radians(posture.yaw_deg)
        across = dot_places_mm(reader.standard)[:DOT_ROWS, 1, None] - posture.offset_mm
        x = cos(angle) * -place + sin(angle) * across
        y = cos(angle) * across + sin(angle) * place
        depth = np.full(x.shape, DEFAULT_SHARE_OF_DEPTH * reader.kernel.depth_mm[-1])
        reader.passing[key] = place, reader.kernel.of_one(x, y, depth)[0]
    return reader.passing[key]

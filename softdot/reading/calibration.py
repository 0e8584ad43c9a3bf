"""What a known line tells of a real sensor: order, polarity and gain of its leads, dead ones, and width of the kernel.

The course of the array is found by dynamic programming over its place (Viterbi), first from the sum of all charges,
which knows no order, then from all channels; then charges are compared with those of the kernel along the course.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import linear_sum_assignment

from foundation.arrays import Floats, Ints
from foundation.errors import InputError
from softdot.arrays.kernel import ArrayKernel
from softdot.reading.calibration_file import Calibration, MeasuredValue, widened
from softdot.reading.conditions import DEFAULT_SHARE_OF_DEPTH
from softdot.reading.line import cell_pitch_mm, nominal_line
from softdot.reading.line_filter.charge import noise_V
from softdot.reading.line_filter.mains import BANDWIDTH_HZ, hum_frequency_Hz, hum_state, without_hum
from softdot.reading.motion import ArrayPath, reach_mm
from softdot.reading.voltages import Reader, Voltages, charges_pC, restored_charge_pC

LEAST_CELLS = 8
"""Of a known line."""
STEP_MM, GRID_MM, MOST_SPEED = 0.3, 0.1, 3.0
"""Mean way of a step of the course, distance of places, and largest speed over the mean one."""
SPEED_SPREAD, STOP_COST, BACK_COST, NOISE_SHARE, FAR = 0.5, 2.0, 4.0, 0.15, 16.0
"""Of the course: standard deviation of the logarithm of the speed, costs of a stop and of a step back, standard
deviation of a charge over a large one, and the largest squared residual that counts.
"""
OFFSETS_MM, WIDTHS = np.linspace(-0.8, 0.8, 9), np.linspace(0.8, 1.2, 9)
"""Places across the line, and widths of the kernel, that are tried."""
ROUNDS, PARTS = 3, 8
"""Rounds of course and channels, and parts of the line that intervals come from."""
DEAD_SHARE = 0.15
"""Gain over the median one below which a lead is dead."""
NOISE_SAMPLES = 100
"""In a part of the time in which noise is measured."""
LEAST_FIT = 0.7
"""Share of the squared charges that a known line must explain."""
STUDENT = 2.36
"""0.975 quantile of Student's t with PARTS - 1 degrees of freedom."""


@dataclass(frozen=True)
class _Heard:
    """Charges (t, n) in pC at steps, and how the drift of a charge may go (t, 3)."""

    charge_pC: Floats
    drift: Floats


def calibrate(reader: Reader, heard: Voltages, cells: Ints) -> Calibration:
    """Calibration by the voltages of known cells (c,). InputError where they do not fit together."""
    if len(cells) < LEAST_CELLS:
        raise InputError(f"--text: has {len(cells)} cells, at least {LEAST_CELLS} are needed to calibrate")
    if np.count_nonzero(cells) < LEAST_CELLS // 2:
        raise InputError(f"--text: {np.count_nonzero(cells)} of its cells have dots, at least {LEAST_CELLS // 2} must")
    quiet = _without_hum(heard)
    charges = _charges(reader, quiet, len(cells))
    found = max((_fitted(reader, charges, cells, leftward) for leftward in (False, True)), key=lambda one: one.fit)
    if found.fit < LEAST_FIT:
        raise InputError(
            f"--calibrate: the text explains {100.0 * found.fit:.0f} % of the charges, at least "
            f"{100.0 * LEAST_FIT:.0f} % are needed; text, array and recording do not belong together"
        )
    return _told(quiet, charges, found, len(cells), reader.kernel.about["config_hash"])


@dataclass(frozen=True)
class _LineFit:
    """Course (t,) along the line, leads of the segments (n,), offset, width, and share of the charges explained."""

    course_mm: Floats
    order: Ints
    offset_mm: float
    width: float
    fit: float
    leftward: bool
    predicted: Floats


def _without_hum(heard: Voltages) -> Voltages:
    rate = 1.0 / heard.step_s
    state, amplitude = hum_state(heard.voltage_V, rate, hum_frequency_Hz(heard.voltage_V, rate))
    return Voltages(heard.time_s, without_hum(heard.voltage_V, state, amplitude, 2.0 * np.pi * BANDWIDTH_HZ / rate))


def _charges(reader: Reader, heard: Voltages, cells: int) -> _Heard:
    """Means of the charges over steps of about STEP_MM; a charge is as small at the end as at the begin."""
    flat = Voltages(heard.time_s, heard.voltage_V - heard.voltage_V.mean(axis=0))
    charge = restored_charge_pC(reader, flat)
    steps = max(50, int(cells * cell_pitch_mm(reader.standard) / STEP_MM))
    many = max(1, len(charge) // steps)
    count = len(charge) // many
    mean = charge[: count * many].reshape(count, many, -1).mean(axis=1)
    time = np.linspace(-1.0, 1.0, count)
    return _Heard(mean, np.stack([np.ones(count), time, time**2], axis=1))


def _fitted(reader: Reader, heard: _Heard, cells: Ints, leftward: bool) -> _LineFit:
    """The best course in one direction, with order, offset and width."""
    grid = _grid(reader, len(cells))
    table = _charges_along(reader.kernel, reader, cells, grid, 0.0)
    order: Ints = np.arange(table.shape[1])
    course = _course(_alike(heard.charge_pC.sum(axis=1)[:, None]), _alike(table.sum(axis=1)[:, None]), leftward)
    offset, width = 0.0, 1.0
    for _ in range(ROUNDS):
        order = _order(heard, table[course])
        offset, width, table = _posture(reader, heard, cells, grid, course, order, (offset, width))
        gain, drift = _gains(heard, table[course], order)
        apart = (heard.charge_pC[:, order] - drift) * np.sign(gain)
        course = _course(apart / np.abs(gain).max(), table * np.abs(gain) / np.abs(gain).max(), leftward)
    gain, drift = _gains(heard, table[course], order)
    rest = heard.charge_pC[:, order] - drift - gain * table[course]
    fit = 1.0 - float((rest**2).sum() / ((heard.charge_pC[:, order] - drift) ** 2).sum())
    return _LineFit(grid[course], order, offset, width, fit, leftward, table[course])


def _grid(reader: Reader, count: int) -> Floats:
    pitch = cell_pitch_mm(reader.standard)
    far = reach_mm(reader.kernel, 0.0) + 0.5 * pitch
    return np.arange(-far, pitch * (count - 1) + far, GRID_MM)


def _charges_along(kernel: ArrayKernel, reader: Reader, cells: Ints, place: Floats, offset_mm: float) -> Floats:
    """Charges (p, n) at places (p,) along the line of nominal dots."""
    depth = np.full(len(place), DEFAULT_SHARE_OF_DEPTH * float(kernel.depth_mm[-1]))
    path = ArrayPath(
        np.arange(float(len(place))), place, np.full(len(place), offset_mm), depth, 0.0, np.zeros(len(cells))
    )
    return charges_pC(kernel, nominal_line(cells, reader.standard), path)


def _alike(charge: Floats) -> Floats:
    """Charges (t, n) over what one of twenty exceeds, with the sign that most of them have."""
    return np.asarray(charge / (np.quantile(np.abs(charge), 0.95, axis=0) * np.sign(charge.mean(axis=0))))


def _course(heard: Floats, table: Floats, leftward: bool) -> Ints:
    """Numbers (t,) of the places of a table (p, n) that fit charges (t, n) with the least cost, by Viterbi."""
    if leftward:
        return len(table) - 1 - _course(heard, table[::-1], leftward=False)
    mean = len(table) / len(heard)
    fastest = int(np.ceil(MOST_SPEED * mean))
    moves = np.arange(-fastest, fastest + 1)
    price = np.where(moves > 0, 0.5 * (np.log(np.maximum(moves, 0.5) / mean) / SPEED_SPREAD) ** 2, STOP_COST)
    price[moves < 0] = BACK_COST
    large = NOISE_SHARE * np.quantile(np.abs(table), 0.98)
    cost = np.full(len(table), np.inf)
    cost[: int(10.0 / GRID_MM)] = 0.0
    came = np.empty((len(heard), len(table)), dtype=np.int16)
    for step, one in enumerate(heard):
        padded = np.pad(cost, fastest, constant_values=np.inf)
        ways = np.stack([padded[fastest - m : fastest - m + len(cost)] + p for m, p in zip(moves, price, strict=True)])
        best = ways.argmin(axis=0)
        came[step] = moves[best]
        cost = ways[best, np.arange(len(cost))] + np.minimum(((one - table) / large) ** 2, FAR).mean(axis=1)
    place = len(table) - int(10.0 / GRID_MM) + int(np.argmin(cost[-int(10.0 / GRID_MM) :]))
    found = np.empty(len(heard), dtype=np.int64)
    for step in range(len(heard) - 1, -1, -1):
        found[step] = place
        place -= int(came[step, place])
    return found


def _order(heard: _Heard, predicted: Floats) -> Ints:
    """The lead (n,) of each segment, by the correlations of all pairs."""
    own, other = (_less_drift(one, heard.drift) for one in (heard.charge_pC, predicted))
    size = np.outer(np.linalg.norm(other, axis=0), np.linalg.norm(own, axis=0))
    alike = np.abs(other.T @ own) / np.maximum(size, 1e-300)
    return np.asarray(linear_sum_assignment(-alike)[1])


def _less_drift(charge: Floats, drift: Floats) -> Floats:
    return charge - drift @ np.linalg.lstsq(drift, charge, rcond=None)[0]


def _gains(heard: _Heard, predicted: Floats, order: Ints, rows: Any = slice(None)) -> tuple[Floats, Floats]:
    """Signed gains (n,) of the segments, and drift (t, n) of their charges, by least squares over some rows."""
    gain, drift = np.empty(len(order)), np.empty((len(heard.drift[rows]), len(order)))
    for segment, lead in enumerate(order):
        waves = np.column_stack([predicted[rows, segment], heard.drift[rows]])
        found = np.linalg.lstsq(waves, heard.charge_pC[rows, lead], rcond=None)[0]
        gain[segment], drift[:, segment] = found[0], waves[:, 1:] @ found[1:]
    return gain, drift


def _posture(
    reader: Reader, heard: _Heard, cells: Ints, grid: Floats, course: Ints, order: Ints, known: tuple[float, float]
) -> tuple[float, float, Floats]:
    """Offset across the line and width of the kernel with the least squares, one after the other, and the charges."""
    offset, width = known

    def rest(offset_mm: float, wide: float) -> float:
        predicted = _charges_along(widened(reader.kernel, wide), reader, cells, grid[course], offset_mm)
        gain, drift = _gains(heard, predicted, order)
        return float(((heard.charge_pC[:, order] - drift - gain * predicted) ** 2).sum())

    offset = _least(OFFSETS_MM, np.array([rest(one, width) for one in OFFSETS_MM]))
    width = _least(WIDTHS, np.array([rest(offset, one) for one in WIDTHS]))
    return offset, width, _charges_along(widened(reader.kernel, width), reader, cells, grid, offset)


def _least(values: Floats, squares: Floats) -> float:
    """Where a parabola through the least of the squares and its neighbours is least."""
    middle = int(np.clip(np.argmin(squares), 1, len(values) - 2))
    left, here, right = squares[middle - 1 : middle + 2]
    bend = left - 2.0 * here + right
    shift = 0.5 * (left - right) / bend if bend > 0.0 else 0.0
    return float(values[middle] + np.clip(shift, -1.0, 1.0) * (values[1] - values[0]))


def _told(heard: Voltages, charges: _Heard, found: _LineFit, cells: int, config_hash: str) -> Calibration:
    """The calibration of a fit; intervals are of means over parts of the line."""
    gain, _ = _gains(charges, found.predicted, found.order)
    parts = [np.arange(len(charges.charge_pC))[k * len(charges.charge_pC) // PARTS :][: len(charges.charge_pC) // PARTS]
             for k in range(PARTS)]  # fmt: skip
    apart = np.array([_gains(charges, found.predicted, found.order, rows)[0] for rows in parts])
    common = float(np.median(np.abs(gain)))
    dead = np.abs(gain) < DEAD_SHARE * common
    polarity = np.where(gain < 0.0, -1, 1)
    alive = np.abs(apart[:, ~dead]).mean(axis=1)
    return Calibration(
        config_hash=config_hash, cells=cells, direction="leftward" if found.leftward else "rightward",
        order=[int(lead) + 1 for lead in found.order], dead=[int(k) + 1 for k in np.flatnonzero(dead)],
        polarity=[int(one) for one in polarity],
        gain=[_interval(one, column) for one, column in zip(np.abs(gain), np.abs(apart).T, strict=True)],
        scale=_interval(float(np.abs(gain[~dead]).mean()), alive), width=found.width,
        noise_mV=[1e3 * float(one) for one in _quiet_noise_V(heard.voltage_V)[found.order]],
        offset_mm=found.offset_mm, explained_share=found.fit,
    )  # fmt: skip


def _quiet_noise_V(voltage_V: Floats) -> Floats:
    """White noise (n,) where least else goes on: of ten parts of the time only one has less."""
    parts = np.array_split(voltage_V, max(1, len(voltage_V) // NOISE_SAMPLES))
    return np.asarray(np.quantile([noise_V(part) for part in parts], 0.1, axis=0))


def _interval(value: float, parts: Floats) -> MeasuredValue:
    """A value with the 95 % interval that values of parts of the line give."""
    half = STUDENT * float(parts.std(ddof=1)) / np.sqrt(len(parts))
    return MeasuredValue(value=float(value), low=float(value - half), high=float(value + half))

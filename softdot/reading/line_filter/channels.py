"""What the first seconds say of the channels: resting voltage, noise, polarity, gain, which are dead, and the speed."""

from dataclasses import dataclass

import numpy as np

from foundation.arrays import Bools, Floats
from softdot.reading.line_filter.charge import noise_V
from softdot.reading.line_filter.table import HIGH, LineTable

ONSET_SIGMA, ONSET_S = 8.0, 0.008
"""Standard deviations of the noise above which a mean over this time is a signal."""
FIRST_MEANS = 6
"""Number of such means at the beginning from which a signal stands out."""
QUIET_S = 0.02
"""Least time before the first signal that gives the resting voltages."""
RESTING_PRIOR_V = 2e-3
"""Assumed standard deviation of a resting voltage."""
DEAD_SHARE, SILENT_SHARE = 0.15, 0.4
"""Shares of the gain of others below which a channel counts as dead, or a
whole row as one without dots.
"""
CLEAR_POLARITY = 3.0
"""Ratio of the extreme charges of both signs from which a channel shows a polarity of its own."""
DEAD_LOUDNESS = 2.0
"""Root mean square of voltages over that of their noise below which a channel has no signal."""
DRIFTING, ROUNDS = 0.7, 30
"""Share of the charges that a drift must leave to be believed, and rounds in which it is found."""
SMOOTHED_S = 0.006
"""Time over which charges are averaged before their change is taken."""


@dataclass(frozen=True)
class Channels:
    """The channels (n,) of the first seconds.

    resting_V, noise_V; slope_V_per_s : root mean square of that of resting voltages which drift; gain : charge over
    that of the kernel, of all channels together, with the sign of the polarity of each; alive. onset : number of the
    first sample with a signal, which is_inside : a signal was there from the first sample on. speed_mm_per_s : roughly.
    """

    resting_V: Floats
    noise_V: Floats
    slope_V_per_s: float
    gain: Floats
    alive: Bools
    onset: int
    is_inside: bool
    speed_mm_per_s: float


def first_signal(voltage_V: Floats, step_s: float) -> int | None:
    """Number of the sample at which something stands out of the noise of voltages (t, n); None where nothing does."""
    many = max(1, round(ONSET_S / step_s))
    count = len(voltage_V) // many
    if count < 4:
        return None
    mean = voltage_V[: count * many].reshape(count, many, -1).mean(axis=1)
    floor = 1e-6 * float(np.abs(voltage_V).max()) + 1e-12
    level = np.abs(mean - np.median(mean[:FIRST_MEANS], axis=0)) / np.maximum(noise_V(voltage_V) / np.sqrt(many), floor)
    loud = np.flatnonzero((level > ONSET_SIGMA).any(axis=1))
    return None if len(loud) == 0 else int(loud[0]) * many


def measured_channels(
    voltage_V: Floats, onset: int, step_s: float, circuit: tuple[Floats, Floats], table: LineTable, places: Floats
) -> Channels:
    """What voltages (t, n) without hum say of their channels. circuit : capacitances in F and resistances in Ohm.

    places (n, 2) : middles of the segments, whose rows see the same dots.
    """
    quiet = onset - round(0.01 / step_s)
    is_inside = quiet * step_s < QUIET_S
    noise = noise_V(voltage_V)
    if is_inside:
        resting = voltage_V.mean(axis=0)
    else:
        resting = voltage_V[:quiet].mean(axis=0)
        resting *= 1.0 / (1.0 + (noise / RESTING_PRIOR_V) ** 2 / quiet)
    capacitance, resistance = circuit
    flat = voltage_V - resting
    leaked = np.cumsum(flat, axis=0) * step_s / resistance
    charge = 1e12 * (capacitance * flat + leaked)[max(onset, 0) :]
    bend = np.zeros(charge.shape[1]) if is_inside else _bend_pC_per_s2(charge, step_s)
    charge -= 0.5 * bend * (step_s * np.arange(len(charge))[:, None]) ** 2
    loud = _loudness(flat[max(onset, 0) :], noise, step_s)
    gain, alive = _gains(charge, loud, is_inside, table, places)
    speed = _speed(charge * np.sign(gain), step_s, alive, table)
    slope = 1e-12 * float(np.sqrt(np.mean((bend * resistance) ** 2)))
    return Channels(resting, noise, slope, gain, alive, onset, is_inside, speed)


def _bend_pC_per_s2(charge_pC: Floats, step_s: float) -> Floats:
    """Curvature (n,) of charges (t, n) that begin at 0, by which a resting voltage drifts; 0 where none is plain.

    A parabola that is least far from them (sum of magnitudes): most of the time a segment touches no dot.
    """
    parabola = 0.5 * (step_s * np.arange(1, len(charge_pC) + 1)[:, None]) ** 2
    bend = np.zeros(charge_pC.shape[1])
    width = 0.02 * np.abs(charge_pC).mean(axis=0) + 1e-12
    for _ in range(ROUNDS):
        share = 1.0 / np.maximum(np.abs(charge_pC - bend * parabola), width)
        bend = (share * parabola * charge_pC).sum(axis=0) / (share * parabola**2).sum(axis=0)
    left = np.abs(charge_pC - bend * parabola).mean(axis=0) / np.abs(charge_pC).mean(axis=0)
    return np.asarray(np.where(left < DRIFTING, bend, 0.0))


def _loudness(voltage_V: Floats, noise_V: Floats, step_s: float) -> Floats:
    """Root mean square (n,) of means of the voltages over that of their noise; large where there is none."""
    many = max(1, round(ONSET_S / step_s))
    count = len(voltage_V) // many
    mean = voltage_V[: count * many].reshape(count, many, -1).mean(axis=1)
    size = np.sqrt(np.mean(mean**2, axis=0))
    return np.asarray(size / np.maximum(noise_V / np.sqrt(many), 1e-3 * size.max() + 1e-15))


def _gains(charge_pC: Floats, loud: Floats, is_inside: bool, table: LineTable, places: Floats) -> tuple[Floats, Bools]:
    """Gain (n,) with the sign of each channel, and which are alive.

    Its size is the same for all: what a channel hears in the first seconds depends on how far the array is beside the
    line, and the filter finds both together.
    """
    if is_inside:
        charge_pC = charge_pC - np.median(charge_pC, axis=0)
    high, low = np.quantile(charge_pC, [HIGH, 1.0 - HIGH], axis=0)
    extreme = np.where(high + low >= 0.0, high, low)
    sign = np.where(extreme * table.high_pC >= 0.0, 1.0, -1.0)
    size = np.abs(extreme) / np.maximum(np.abs(table.high_pC), 1e-300)
    if is_inside:
        size = (high - low) / np.maximum(np.abs(table.high_pC), 1e-300)
    common = float(np.median(size[size >= np.median(size)]))
    alike = np.abs(places[:, 1] - places[:, 1, None]) < 0.1 * table.dot_pitch_mm
    size = np.where(loud < DEAD_LOUDNESS, 0.0, size)
    row = np.where(alike, size, 0.0).max(axis=1)
    alive = size >= DEAD_SHARE * np.maximum(row, SILENT_SHARE * common * (row >= SILENT_SHARE * common))
    silent = row < SILENT_SHARE * common
    together = 1.0 if np.sum(sign * size * ~silent) >= 0.0 else -1.0
    clear = np.maximum(np.abs(high), np.abs(low)) > CLEAR_POLARITY * np.minimum(np.abs(high), np.abs(low))
    sign = np.where(clear & ~silent & alive, sign, together)
    return sign * max(common, 1e-12), alive | silent


def _speed(charge_pC: Floats, step_s: float, alive: Bools, table: LineTable) -> float:
    """The speed by how fast the charge changes beside how much it does so."""
    many = max(1, round(SMOOTHED_S / step_s))
    count = len(charge_pC) // many
    mean = charge_pC[: count * many, alive].reshape(count, many, -1).mean(axis=1)
    change = np.diff(mean, axis=0) / (many * step_s)
    moving = np.abs(change).max(axis=1)
    moving = moving > 0.1 * np.quantile(moving, 0.9) if len(moving) else moving > 0.0
    if not moving.any():
        return 1.0
    rate = float(np.sqrt(np.mean(change[moving] ** 2)))
    spread = float(np.sqrt(np.mean((mean - mean.mean(axis=0)) ** 2)))
    return rate / max(spread, 1e-300) * table.spread_pC / table.slope_pC_per_mm

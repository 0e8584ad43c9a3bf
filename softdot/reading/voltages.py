"""The recorded voltages of a path over a line: the kernel's charges, the read-out, noise and hum."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from scipy.interpolate import CubicSpline

from foundation.arrays import Floats
from geometry.braille_standards import BrailleStandard
from softdot.arrays.kernel import ArrayKernel
from softdot.reading.conditions import ReadingConditions
from softdot.reading.disturbances import disturbed
from softdot.reading.line import DotLine
from softdot.reading.motion import CHUNK_TIMES, ArrayPath, PressTimes, dots_near
from solve.model import Readout
from solve.physics import Physics
from solve.readout.amplifier import amplify, input_of

MAINS_HZ, LEAST_MAINS_PERIODS = 50.0, 50
"""Frequency of the mains, and least number of periods from which its sine is subtracted."""
READOUT_STEP_MM = 0.02
"""Longest way in a step of the integration of the read-out: within one the charge is linear."""
Step = Callable[[int, int], None]


@dataclass(frozen=True)
class Voltages:
    """Voltages of the segments, voltage_V (t, n), at evenly spaced times time_s (t,)."""

    time_s: Floats
    voltage_V: Floats

    @property
    def step_s(self) -> float:
        """Time from one sample to the next, s."""
        return float(self.time_s[-1] - self.time_s[0]) / (len(self.time_s) - 1)


@dataclass(frozen=True)
class Reader:
    """Everything that a decoder may know: the kernel, the nominal standard, the read-out, and the times of presses.

    physics : effects behind the film besides the read-out. presses : times at which the array is set down, as its
    machine tells them; None where it slides. passing : charges of passed dots by offset and yaw, which decoders keep
    here.
    """

    kernel: ArrayKernel
    standard: BrailleStandard
    readout: Readout
    presses: PressTimes | None = None
    physics: Physics = field(default_factory=Physics)
    passing: dict[tuple[float, float], tuple[Floats, Floats]] = field(default_factory=dict, compare=False, repr=False)


def charges_pC(kernel: ArrayKernel, line: DotLine, path: ArrayPath, told: Step | None = None) -> Floats:
    """Charges (t, n) at the times of the path, from all dots that are near."""
    charge = np.empty((len(path.time_s), kernel.charge_pC.shape[-1]))
    for begin in range(0, len(charge), CHUNK_TIMES):
        span = slice(begin, begin + CHUNK_TIMES)
        charge[span] = kernel.of_many(*dots_near(kernel, line, path, span))[0]
        if told is not None:
            told(min(begin + CHUNK_TIMES, len(charge)), len(charge))
    return charge


def charges_of_lone_dots_pC(kernel: ArrayKernel, line: DotLine, path: ArrayPath) -> Floats:
    """Charges (t, n) if no dot felt another one: the sum of those that each would give alone."""
    charge = np.empty((len(path.time_s), kernel.charge_pC.shape[-1]))
    for begin in range(0, len(charge), CHUNK_TIMES):
        span = slice(begin, begin + CHUNK_TIMES)
        x, y, depth = dots_near(kernel, line, path, span)
        charge[span] = kernel.of_one(x, y, depth)[0].sum(axis=1)
    return charge


def readout_voltages(
    reader: Reader, time_s: Floats, charge_pC: Floats, at_s: Floats, finest_s: float = np.inf
) -> Floats:
    """Voltages (m, n) at evenly spaced at_s (m,), each electrode with its own capacitance (solve.readout.amplifier).

    Between the times of the charges (t, n) these follow a cubic spline, which the read-out sees in steps of at most
    finest_s.
    """
    step = (at_s[-1] - at_s[0]) / (len(at_s) - 1)
    parts = max(1, int(np.ceil(step / finest_s)))
    time = at_s[0] + step / parts * np.arange(parts * (len(at_s) - 1) + 1)
    spline = CubicSpline(time_s, 1e-12 * charge_pC)
    charge = spline(np.clip(time, time_s[0], time_s[-1]))
    voltages = [
        amplify(time, np.ascontiguousarray(charge[:, j]), float(1e-12 * farads), reader.readout, reader.physics)[
            ::parts
        ]
        for j, farads in enumerate(reader.kernel.capacitance_pF)
    ]
    return np.stack(voltages, axis=1)


def record_voltages(
    reader: Reader,
    line: DotLine,
    path: ArrayPath,
    conditions: ReadingConditions,
    random: np.random.Generator,
    told: Step | None = None,
) -> Voltages:
    """The sampled voltages of a path over a line, with what acts on them behind the film."""
    charge = charges_pC(reader.kernel, line, path, told)
    count = int((path.time_s[-1] - path.time_s[0]) * conditions.sampling_Hz)
    time = path.time_s[0] + np.arange(count) / conditions.sampling_Hz
    clean = readout_voltages(reader, path.time_s, charge, time, READOUT_STEP_MM / conditions.speed_mm_per_s)
    return Voltages(time, disturbed(clean, time, conditions, random))


def without_mains(heard: Voltages) -> Voltages:
    """Voltages less the sine of the mains that fits each channel best; unchanged where they last less than a second.

    Of a signal of duration T this removes the frequencies within about 1 / T of the mains.
    """
    if heard.time_s[-1] - heard.time_s[0] < LEAST_MAINS_PERIODS / MAINS_HZ or heard.step_s > 0.4 / MAINS_HZ:
        return heard
    phase = 2.0 * np.pi * MAINS_HZ * heard.time_s
    waves = np.stack([np.sin(phase), np.cos(phase)], axis=1)
    found = np.linalg.lstsq(waves, heard.voltage_V, rcond=None)[0]
    return Voltages(heard.time_s, heard.voltage_V - waves @ found)


def averaged_voltages(reader: Reader, time_s: Floats, charge_pC: Floats, like: Voltages, many: int) -> Voltages:
    """Voltages of charges (t, n) at the samples of others, each the mean of `many` finer samples."""
    fine = like.step_s / many
    at = like.time_s[0] - 0.5 * (many - 1) * fine + fine * np.arange(many * len(like.time_s))
    voltage = readout_voltages(reader, time_s, charge_pC, at)
    return Voltages(like.time_s, voltage.reshape(len(like.time_s), many, -1).mean(axis=1))


def restored_charge_pC(reader: Reader, heard: Voltages) -> Floats:
    """Charges (t, n) behind the voltages, from their first sample on: Q = C V + integral of V / R.

    The inverse of the input of the read-out; what its filters removed stays removed, and noise adds up.
    """
    restored = np.empty_like(heard.voltage_V)
    for j, film in enumerate(reader.kernel.capacitance_pF):
        capacitance, resistance = input_of(reader.readout, 1e-12 * float(film))
        voltage = heard.voltage_V[:, j] / reader.readout.gain
        leaked = np.concatenate([[0.0], np.cumsum(0.5 * (voltage[1:] + voltage[:-1]))]) * heard.step_s
        restored[:, j] = 1e12 * (capacitance * voltage + leaked / resistance)
    return restored

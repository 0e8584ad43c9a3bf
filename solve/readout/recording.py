"""The recording of a press: its charge over the waveform, behind the amplifier.

The mechanics of the baseline does not depend on time, so its waveform only says when each depth is reached.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.interpolate import PchipInterpolator

from geometry.arrays import Floats
from solve.model import Physics, Press, Readout, Waveform
from solve.readout.amplifier import amplify
from solve.readout.channels import amplify_channels
from solve.readout.filters import SAMPLES
from solve.result import PressResult
from solve.solution.schedule import corners_s, duration_s, fraction

ROUND_OFF_S = 1e-12


@dataclass(frozen=True)
class ReadoutRecording:
    """What one amplifier gives over time: time_s (t,), voltage_V (t,); progress (t,) load steps done."""

    time_s: Floats
    voltage_V: Floats
    progress: Floats


def readout_voltage(result: PressResult, press: Press, readout: Readout, physics: Physics | None = None) -> Floats:
    """Voltage (s,) of all electrodes in parallel at the moment each step is first reached."""
    everything = np.ones(len(result.capacitance_F))
    return _at_steps(result, record(result, press, readout, everything, physics))


def channel_voltages(result: PressResult, press: Press, readout: Readout, physics: Physics | None = None) -> Floats:
    """Voltage (e, s) of every electrode behind an amplifier of its own, crosstalk between the channels included."""
    return np.array([_at_steps(result, one) for one in record_channels(result, press, readout, physics)])


def record_channels(
    result: PressResult, press: Press, readout: Readout, physics: Physics | None = None
) -> list[ReadoutRecording]:
    """The whole recording of a press by an amplifier for each electrode."""
    each = [_charge(result, press, alone) for alone in np.eye(len(result.capacitance_F))]
    time, _, progress = each[0]
    charges = np.column_stack([charge for _, charge, _ in each])
    voltages = amplify_channels(time, charges, result.capacitance_F, readout, physics or Physics())
    return [ReadoutRecording(time, voltage, progress) for voltage in voltages]


def record(
    result: PressResult, press: Press, readout: Readout, wired: Floats, physics: Physics | None = None
) -> ReadoutRecording:
    """The whole recording of a press; wired : (e,) 1 for the electrodes on this amplifier, else 0."""
    time, charge, progress = _charge(result, press, wired)
    capacitance = float(result.capacitance_F @ wired)
    return ReadoutRecording(time, amplify(time, charge, capacitance, readout, physics or Physics()), progress)


def _charge(result: PressResult, press: Press, wired: Floats) -> tuple[Floats, Floats, Floats]:
    """Times (n,), the charge of these electrodes and the load steps done by then, each (n,)."""
    time, progress = _timetable(press)
    if result.follows_time:
        trace = result.trace
        time = np.union1d(np.linspace(trace.time_s[0], trace.time_s[-1], SAMPLES), trace.time_s)
        progress = np.interp(time, [step.time_s for step in result.steps], np.arange(len(result.steps)))
        corners = corners_s(press.waveform or Waveform())
        charge = _between_corners(trace.time_s, trace.film_charge_C @ wired, time, corners)
    else:
        steps = np.array([step.film_charge_C @ wired for step in result.steps])
        charge = _interpolated(np.arange(len(steps), dtype=float), steps, progress)
    return time, charge, progress


def _at_steps(result: PressResult, recording: ReadoutRecording) -> Floats:
    progress = recording.progress
    first = [int(np.argmax(progress >= number - 1e-9)) for number in range(len(result.steps))]
    return np.array([_at(progress, recording.voltage_V, index, number) for number, index in enumerate(first)])


def _at(progress: Floats, voltage: Floats, index: int, number: int) -> float:
    """Voltage where the progress passes a number between the samples index - 1 and index."""
    before = max(index - 1, 0)
    rise = progress[index] - progress[before]
    share = min(1.0, (number - progress[before]) / rise) if rise > 0.0 else 1.0
    return float(voltage[before] + share * (voltage[index] - voltage[before]))


def _timetable(press: Press) -> tuple[Floats, Floats]:
    """Times (n,) and the number of load steps done by then (n,); each leg of a slide takes as long as the press."""
    waveform = press.waveform or Waveform()
    time = np.linspace(0.0, duration_s(waveform), SAMPLES)
    progress = press.load_steps * fraction(waveform, time)
    if press.path_xy_mm:
        legs = np.linspace(0.0, float(len(press.path_xy_mm)), SAMPLES)[1:]
        progress = np.append(progress, press.load_steps * (1.0 + legs))
        time = np.append(time, time[-1] + waveform.rise_s * legs)
    return time, progress


def _interpolated(at: Floats, values: Floats, where: Floats) -> Floats:
    """Values between known ones, without overshoot; the last one holds beyond the end."""
    if len(at) == 1:
        return np.zeros_like(where)
    return np.asarray(PchipInterpolator(at, values)(np.clip(where, at[0], at[-1])))


def _between_corners(at: Floats, values: Floats, where: Floats, corners: Floats) -> Floats:
    """Interpolated piece by piece: across a corner of the waveform the slope may jump."""
    result = np.zeros_like(where)
    edges = np.unique(np.clip(np.concatenate([at[:1], corners, at[-1:]]), at[0], at[-1]))
    for low, high in pairwise(edges):
        known, asked = (at >= low - ROUND_OFF_S) & (at <= high + ROUND_OFF_S), (where >= low) & (where <= high)
        result[asked] = _interpolated(at[known], values[known], where[asked])
    return result

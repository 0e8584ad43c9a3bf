"""The course of a press in time: drive, force, charge and voltage of each electrode, and what each amplifier gives.

Solved states are places on it. Between them force and charge follow smooth curves (solve.readout.legs), through which
the amplifier is integrated on a grid of its own. An interval of the grid is halved until straight lines between its
times follow every curve, also those at the inputs of the amplifiers, so that it is finest behind corners where a
circuit is fast. What comes later changes nothing that came earlier.

How far the read-out may be off: what changes when the states are joined by straight lines, and when force and charge
begin without slope, as they do where a round dot touches; and what changes when the grid is halved once more.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from foundation.arrays import Floats, Ints
from solve.model import Press, Readout
from solve.physics import Physics
from solve.readout.amplifier import curved_integral, input_of, output_voltage, stages
from solve.readout.channels import input_voltages, output_voltages
from solve.readout.legs import PressLeg, press_legs, timed_legs
from solve.readout.stages import Hum
from solve.result import PressResult, Trace
from solve.solution.schedule import corners_s, first_reached_s, slide_s, stretches_s
from solve.waveform import Waveform

STRAIGHT_TOLERANCE = 1e-4
"""Of the largest value of a curve: how far the course may be from the straight lines between its times."""
SMALL_CURVE_SHARE = 1e-2
"""Of the largest of its kind: below it a curve is compared with this instead of its own largest value."""
FIRST_PARTS, HUM_PARTS, MOST_REFINEMENTS, MOST_TIMES, SAME_TIME = 4, 16, 45, 20_000, 1e-13
SMALLEST_DIVISOR = 1e-300
INTERPOLATION_SAFETY = 2.0
"""Of what straight lines and a soft touch change: with 1.5, 54 of 58 were covered, the others by 0.75 to 0.97."""


@dataclass(frozen=True)
class PressCourse:
    """Course of a press in time. time_s (n,); indentation_m (n,) of the displacement sensor; reaction_force_N (n,) of
    the force sensor; charge_C (n, e) at short circuit and voltage_V (n, e) at open circuit, one column for each
    electrode.

    together_V : (n,) behind one amplifier for all electrodes; channels_V : (n, e) each behind its own; both None
    without an amplifier. solved : (s,) places of the reported steps. readout_error_percent : how far what is read, at
    open circuit without an amplifier, may be off for want of solved states and times, of its largest value.
    """

    time_s: Floats
    indentation_m: Floats
    reaction_force_N: Floats
    charge_C: Floats
    voltage_V: Floats
    together_V: Floats | None
    channels_V: Floats | None
    solved: Ints
    readout_error_percent: float


@dataclass(frozen=True)
class AmplifierChain:
    """The amplifiers behind electrodes with capacitances (e,) in F; readout : None for no amplifier."""

    readout: Readout | None
    physics: Physics
    capacitance_F: Floats

    def inputs(self, time_s: Floats, charge_C: Floats) -> Floats:
        """Voltages (e + 1, n) at the inputs of each electrode's own amplifier and of the one of all.

        time_s : (n,) with every second one midway between its neighbours, charge_C : (n, e).
        """
        if self.readout is None:
            return np.zeros((0, len(time_s)))
        told = (time_s, charge_C, self.capacitance_F, self.readout, self.physics, curved_integral)
        own, together = input_voltages(*told), input_of(self.readout, float(self.capacitance_F.sum()))
        return np.vstack([own, curved_integral(time_s, charge_C.sum(axis=1), *together)])

    def outputs(self, time_s: Floats, inputs_V: Floats, charge_C: Floats) -> Floats:
        """Voltages (e + 1, n) that are read, in the order of the inputs; at open circuit without an amplifier."""
        if self.readout is None:
            together = charge_C.sum(axis=1) / self.capacitance_F.sum()
            return np.vstack([(charge_C / self.capacitance_F).T, together])
        each = output_voltages(time_s, inputs_V[:-1], self.readout, self.physics)
        if len(each) == 1:  # the amplifier of one electrode is that of all
            return np.vstack([each, each])
        return np.vstack([each, output_voltage(time_s, inputs_V[-1], self.readout, self.physics)])

    def readout_V(self, legs: Sequence[PressLeg], time_s: Floats) -> Floats:
        """Voltages (e + 1, n) that are read at times (n,), integrated over the halves between them."""
        fine = with_midpoints(time_s)
        charge = leg_values(legs, fine)[:, 2:]
        return self.outputs(fine, self.inputs(fine, charge), charge)[:, ::2]


def course(
    result: PressResult, press: Press, readout: Readout | None, physics: Physics, time_s: Floats | None = None
) -> PressCourse:
    """The course of a press behind an amplifier (Model.amplifier), as far as it converged.

    time_s (n,) : on these times only.
    """
    circuit = AmplifierChain(readout, physics, result.capacitance_F)
    trace, legs = result.trace, press_legs(result, press)
    states_s = trace.time_s if result.follows_time else first_reached_s(result.progress, press)
    solved_s = states_s[np.searchsorted(trace.time_s, [step.time_s for step in result.steps])]
    if time_s is None:
        time_s = _refine_times(legs, circuit, _first_times(legs, press, circuit, states_s))
    found, read = leg_values(legs, time_s), circuit.readout_V(legs, time_s)
    finer = circuit.readout_V(legs, with_midpoints(time_s))[:, ::2]
    off = _interpolation_errors(circuit, legs, time_s, read) + _relative_deviations(read - finer, read, axis=1)
    amplified = circuit.readout is not None
    return PressCourse(
        time_s=time_s,
        indentation_m=found[:, 0],
        reaction_force_N=found[:, 1] + 0.0,
        charge_C=found[:, 2:],
        voltage_V=found[:, 2:] / result.capacitance_F,
        together_V=read[-1] if amplified else None,
        channels_V=read[:-1].T if amplified else None,
        solved=np.abs(time_s - solved_s[:, None]).argmin(axis=1),
        readout_error_percent=100.0 * float(off.max()),
    )


def _interpolation_errors(circuit: AmplifierChain, legs: Sequence[PressLeg], time_s: Floats, read: Floats) -> Floats:
    """Error (k,) of what is read (k, n) for want of states: what straight lines and a soft touch change."""
    others = [leg.with_straight_lines() for leg in legs], [leg.with_soft_touch() for leg in legs]
    changes = [_relative_deviations(read - circuit.readout_V(other, time_s), read, axis=1) for other in others]
    return np.asarray(INTERPOLATION_SAFETY * np.sum(changes, axis=0))


def common_readout_V(
    trace: Trace, capacitance_F: Floats, press: Press, readout: Readout | None, physics: Physics, time_s: Floats
) -> Floats | None:
    """Voltage (n,) of one amplifier of all electrodes at times (n,), for a trace that followed time; None without one.

    On one grid it depends smoothly on the states, so that differences of it are derivatives.
    """
    circuit = AmplifierChain(readout, physics, capacitance_F)
    if circuit.readout is None:
        return None
    return np.asarray(circuit.readout_V(timed_legs(trace, press), time_s)[-1])


def with_midpoints(time_s: Floats) -> Floats:
    """Times (n,) with those midway between them, (2 n - 1,)."""
    fine = np.empty(max(2 * len(time_s) - 1, 0))
    fine[::2], fine[1::2] = time_s, 0.5 * (time_s[1:] + time_s[:-1])
    return fine


def leg_values(legs: Sequence[PressLeg], time_s: Floats) -> Floats:
    """Depth, force and charges (n, 2 + e) at times (n,) from the begin of the first leg to the end of the last."""
    ends = np.array([leg.end_s for leg in legs])
    on = np.minimum(np.searchsorted(ends, time_s), len(legs) - 1)
    found = np.empty((len(time_s), legs[0].known.shape[1]))
    for number, leg in enumerate(legs):
        found[on == number] = leg.values_at(time_s[on == number])
    return found


def _first_times(legs: Sequence[PressLeg], press: Press, circuit: AmplifierChain, states_s: Floats) -> Floats:
    """Times (n,) to begin with: all corners and states, some between, and enough for the hum of the mains."""
    begin, end = legs[0].begin_s, legs[-1].end_s
    waveform = press.waveform or Waveform()
    smooth = np.union1d(stretches_s(waveform), slide_s(press))
    parts = [np.linspace(one, other, FIRST_PARTS + 1) for one, other in pairwise(smooth)]
    parts += [corners_s(waveform), states_s, np.array([begin, end])]
    for stage in stages(circuit.readout, circuit.physics) if circuit.readout is not None else []:
        if isinstance(stage, Hum):
            count = HUM_PARTS * stage.frequency_Hz * (end - begin)
            parts.append(np.linspace(begin, end, int(min(count, 0.5 * MOST_TIMES)) + 2))
    times = np.unique(np.clip(np.concatenate(parts), begin, end))
    apart = np.append(np.diff(times) > SAME_TIME * (end - begin), True)
    apart[:1] |= len(times) == 1
    return np.asarray(times[apart])


def _refine_times(legs: Sequence[PressLeg], circuit: AmplifierChain, time_s: Floats) -> Floats:
    """Halve intervals of times (n,) until straight lines between them follow every curve."""
    least = SAME_TIME * (time_s[-1] - time_s[0])
    for _ in range(MOST_REFINEMENTS):
        fine = with_midpoints(time_s)
        found = leg_values(legs, fine)
        inputs = circuit.inputs(fine, found[:, 2:])
        kinds = found[:, :1], found[:, 1:2], found[:, 2:], inputs.T, circuit.outputs(fine, inputs, found[:, 2:]).T
        off = np.max([_midpoint_deviations(curves) for curves in kinds if curves.shape[1]], axis=0)
        chosen = (off > STRAIGHT_TOLERANCE) & (np.diff(time_s) > 4.0 * least)
        if not chosen.any() or len(time_s) + chosen.sum() > MOST_TIMES:
            break
        time_s = np.sort(np.append(time_s, fine[1::2][chosen]))
    return time_s


def _midpoint_deviations(curves: Floats) -> Floats:
    """Distance (n - 1,) of curves (2 n - 1, k) from the line between each second value, over their largest values."""
    off = curves[1::2] - 0.5 * (curves[:-1:2] + curves[2::2])
    return np.asarray((np.abs(off) / _reference_sizes(curves, axis=0)).max(axis=1, initial=0.0))


def _relative_deviations(off: Floats, of: Floats, axis: int) -> Floats:
    """Largest deviation of each row over the row's largest value."""
    return np.asarray(np.abs(off).max(axis=axis) / _reference_sizes(of, axis))


def _reference_sizes(curves: Floats, axis: int) -> Floats:
    """Largest value of each curve, or a share of that of all where it is smaller."""
    each = np.abs(curves).max(axis=axis)
    return np.asarray(np.maximum(np.maximum(each, SMALL_CURVE_SHARE * each.max(initial=0.0)), SMALLEST_DIVISOR))

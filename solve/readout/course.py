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
from solve.readout.amplifier import behind_input, curved_integral, input_of, stages
from solve.readout.channels import behind_inputs, input_voltages
from solve.readout.legs import PressLeg, legs_of, legs_through
from solve.readout.stages import Hum
from solve.result import PressResult, Trace
from solve.solution.schedule import corners_s, first_reached_s, slide_s, stretches_s
from solve.waveform import Waveform

STRAIGHT = 1e-4
"""Of the largest value of a curve: how far the course may be from the straight lines between its times."""
SMALL = 1e-2
"""Of the largest of its kind: below it a curve is compared with this instead of its own largest value."""
FIRST_PARTS, HUM_PARTS, MOST_ROUNDS, MOST_TIMES, SAME_TIME = 4, 16, 45, 20_000, 1e-13
TINY = 1e-300
SAFETY = 2.0
"""Of what straight lines and a soft touch change: with 1.5, 54 of 58 were covered, the others by 0.75 to 0.97."""


@dataclass(frozen=True)
class PressCourse:
    """time_s (n,); indentation_m (n,) of the displacement sensor; reaction_force_N (n,) of the force sensor; charge_C
    (n, e) at short circuit and voltage_V (n, e) at open circuit, one column for each electrode.

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
    """What stands behind electrodes with capacitances (e,); readout : None for nothing."""

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
        """What is read (e + 1, n), in the same order; the open circuit without an amplifier."""
        if self.readout is None:
            together = charge_C.sum(axis=1) / self.capacitance_F.sum()
            return np.vstack([(charge_C / self.capacitance_F).T, together])
        each = behind_inputs(time_s, inputs_V[:-1], self.readout, self.physics)
        if len(each) == 1:  # the amplifier of one electrode is that of all
            return np.vstack([each, each])
        return np.vstack([each, behind_input(time_s, inputs_V[-1], self.readout, self.physics)])

    def read(self, legs: Sequence[PressLeg], time_s: Floats) -> Floats:
        """What is read (e + 1, n) at times (n,), integrated over the halves between them."""
        fine = halved(time_s)
        charge = values(legs, fine)[:, 2:]
        return self.outputs(fine, self.inputs(fine, charge), charge)[:, ::2]


def course(
    result: PressResult, press: Press, readout: Readout | None, physics: Physics, time_s: Floats | None = None
) -> PressCourse:
    """The course of a press behind an amplifier (Model.amplifier), as far as it converged.

    time_s (n,) : on these times only.
    """
    circuit = AmplifierChain(readout, physics, result.capacitance_F)
    trace, legs = result.trace, legs_of(result, press)
    states_s = trace.time_s if result.follows_time else first_reached_s(result.progress, press)
    solved_s = states_s[np.searchsorted(trace.time_s, [step.time_s for step in result.steps])]
    if time_s is None:
        time_s = _refined(legs, circuit, _first_times(legs, press, circuit, states_s))
    found, read = values(legs, time_s), circuit.read(legs, time_s)
    finer = circuit.read(legs, halved(time_s))[:, ::2]
    off = _for_want_of_states(circuit, legs, time_s, read) + _share(read - finer, read, axis=1)
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


def _for_want_of_states(circuit: AmplifierChain, legs: Sequence[PressLeg], time_s: Floats, read: Floats) -> Floats:
    """How far what is read (k, n) may be off between states (k,): what straight lines and a soft touch change."""
    others = [leg.straight() for leg in legs], [leg.touched_softly() for leg in legs]
    changes = [_share(read - circuit.read(other, time_s), read, axis=1) for other in others]
    return np.asarray(SAFETY * np.sum(changes, axis=0))


def read_together(
    trace: Trace, capacitance_F: Floats, press: Press, readout: Readout | None, physics: Physics, time_s: Floats
) -> Floats | None:
    """What one amplifier of all electrodes gives (n,) at times (n,), for a trace that followed time; None without one.

    On one grid it depends smoothly on the states, so that differences of it are derivatives.
    """
    circuit = AmplifierChain(readout, physics, capacitance_F)
    if circuit.readout is None:
        return None
    return np.asarray(circuit.read(legs_through(trace, press), time_s)[-1])


def halved(time_s: Floats) -> Floats:
    """The times (n,) and those midway between them, (2 n - 1,)."""
    fine = np.empty(max(2 * len(time_s) - 1, 0))
    fine[::2], fine[1::2] = time_s, 0.5 * (time_s[1:] + time_s[:-1])
    return fine


def values(legs: Sequence[PressLeg], time_s: Floats) -> Floats:
    """Depth, force and charges (n, 2 + e) at times (n,) from the begin of the first leg to the end of the last."""
    ends = np.array([leg.end_s for leg in legs])
    on = np.minimum(np.searchsorted(ends, time_s), len(legs) - 1)
    found = np.empty((len(time_s), legs[0].known.shape[1]))
    for number, leg in enumerate(legs):
        found[on == number] = leg.of(time_s[on == number])
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


def _refined(legs: Sequence[PressLeg], circuit: AmplifierChain, time_s: Floats) -> Floats:
    """Times (n,) halved where straight lines between them do not follow every curve."""
    least = SAME_TIME * (time_s[-1] - time_s[0])
    for _ in range(MOST_ROUNDS):
        fine = halved(time_s)
        found = values(legs, fine)
        inputs = circuit.inputs(fine, found[:, 2:])
        kinds = found[:, :1], found[:, 1:2], found[:, 2:], inputs.T, circuit.outputs(fine, inputs, found[:, 2:]).T
        off = np.max([_off_line(curves) for curves in kinds if curves.shape[1]], axis=0)
        chosen = (off > STRAIGHT) & (np.diff(time_s) > 4.0 * least)
        if not chosen.any() or len(time_s) + chosen.sum() > MOST_TIMES:
            break
        time_s = np.sort(np.append(time_s, fine[1::2][chosen]))
    return time_s


def _off_line(curves: Floats) -> Floats:
    """How far curves (2 n - 1, k) are from the line between each second value (n - 1,), of their largest values."""
    off = curves[1::2] - 0.5 * (curves[:-1:2] + curves[2::2])
    return np.asarray((np.abs(off) / _sizes(curves, axis=0)).max(axis=1, initial=0.0))


def _share(off: Floats, of: Floats, axis: int) -> Floats:
    """The largest of each row's deviations, of the row's largest value."""
    return np.asarray(np.abs(off).max(axis=axis) / _sizes(of, axis))


def _sizes(curves: Floats, axis: int) -> Floats:
    """The largest value of each curve, or a share of that of all where it is smaller."""
    each = np.abs(curves).max(axis=axis)
    return np.asarray(np.maximum(np.maximum(each, SMALL * each.max(initial=0.0)), TINY))
